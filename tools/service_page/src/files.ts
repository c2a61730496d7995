import { make } from "./dom";

const TYPES = [{ description: "RKM04", accept: { "text/plain": [".rks" as const] } }];

interface WritableHandle {
    name: string;
    createWritable(): Promise<{ write(text: string): Promise<void>; close(): Promise<void> }>;
}

type Picker = (options: object) => Promise<WritableHandle>;

/** Programs of old tools are in Windows-1250; whatever is not UTF-8 is taken for that. */
export async function readProgram(file: File): Promise<string> {
    const bytes = await file.arrayBuffer();
    try {
        return new TextDecoder("utf-8", { fatal: true }).decode(bytes);
    } catch {
        return new TextDecoder("windows-1250").decode(bytes);
    }
}

function download(name: string, text: string): void {
    const url = URL.createObjectURL(new Blob([text], { type: "text/plain" }));
    make("a", { href: url, download: name }).click();
    window.setTimeout(() => URL.revokeObjectURL(url), 1000);
}

/**
 * Saves a program where the user says, in browsers that can, else as a download. Returns the name it got, or
 * null if the user changed their mind.
 */
export async function saveProgram(name: string, text: string): Promise<string | null> {
    const picker = (window as { showSaveFilePicker?: Picker }).showSaveFilePicker;
    if (picker === undefined) {
        download(name, text);
        return name;
    }
    try {
        const handle = await picker.call(window, { suggestedName: name, types: TYPES });
        const writable = await handle.createWritable();
        await writable.write(text);
        await writable.close();
        return handle.name;
    } catch (error) {
        if (error instanceof DOMException && error.name === "AbortError") {
            return null;
        }
        throw error;
    }
}

import { decodeProgram, encodeProgram, type FileForm, type Unreadable } from "./file_form";
import { make } from "./dom";

/** Far more than 700 commands with comments need; what is larger is not read at all. */
export const FILE_BYTES_MAX = 200_000;
const TYPES = [{ description: "RKM04", accept: { "text/plain": [".rks"] } }];

interface WritableHandle {
    name: string;
    createWritable(): Promise<{ write(bytes: Uint8Array<ArrayBuffer>): Promise<void>; close(): Promise<void> }>;
}

type Picker = (options: object) => Promise<WritableHandle>;
type FileTypes = { description: string; accept: Record<string, string[]> }[];

/** The text of a file and all that it takes to write the same bytes again, or why it is no program. */
export async function readProgram(file: File): Promise<{ text: string; form: FileForm } | Unreadable | "tooLarge"> {
    if (file.size > FILE_BYTES_MAX) {
        return "tooLarge";
    }
    return decodeProgram(file.name, new Uint8Array(await file.arrayBuffer()));
}

function download(name: string, bytes: Uint8Array<ArrayBuffer>): void {
    const url = URL.createObjectURL(new Blob([bytes], { type: "text/plain" }));
    make("a", { href: url, download: name }).click();
    window.setTimeout(() => URL.revokeObjectURL(url), 1000);
}

/**
 * Saves a program where the user says, in browsers that can, else as a download. Returns what the file is like
 * then, or null if the user changed their mind.
 */
export async function saveProgram(form: FileForm, text: string): Promise<FileForm | null> {
    const { bytes, form: written } = encodeProgram(form, text);
    const name = await saveBytes(form.name, bytes, TYPES);
    return name === null ? null : { ...written, name };
}

/** Saves a file in the same way. Returns its name, or null if the user changed their mind. */
export async function saveBytes(
    name: string, bytes: Uint8Array<ArrayBuffer>, types: FileTypes,
): Promise<string | null> {
    const picker = (window as { showSaveFilePicker?: Picker }).showSaveFilePicker;
    if (picker === undefined) {
        download(name, bytes);
        return name;
    }
    try {
        const handle = await picker.call(window, { suggestedName: name, types });
        const writable = await handle.createWritable();
        await writable.write(bytes);
        await writable.close();
        return handle.name;
    } catch (error) {
        if (error instanceof DOMException && error.name === "AbortError") {
            return null;
        }
        throw error;
    }
}

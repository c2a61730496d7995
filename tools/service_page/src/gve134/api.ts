import { alone } from "./alone/page";
import { fileWords } from "./files";
import { troubleText } from "./i18n";
import { Refused } from "./refused";
import type { FileText, MachineText, Trouble } from "./protocol";

export { Refused };

async function fetched(path: string, init: RequestInit = {}): Promise<Response> {
    const response = await fetch(path, init);
    if (response.ok) {
        return response;
    }
    const { error } = (await response.json().catch(() => ({}))) as { error?: Trouble };
    throw new Refused(error ? (await fileWords())(troubleText(error)) : `${path}: ${response.status}`);
}

/** Has a file or a machine file opened; all pages are told of it. */
export async function openFile(kind: "file" | "machine", file: File): Promise<void> {
    if (alone !== null) {
        return alone.open(kind, file);
    }
    await fetched(`/api/${kind}?name=${encodeURIComponent(file.name)}`, { method: "POST", body: file });
}

/** The machine file that is open, as it is written. */
export async function fetchMachine(): Promise<MachineText> {
    return alone?.machine ?? (await (await fetched("/api/machine")).json()) as MachineText;
}

export async function openExample(name: string): Promise<void> {
    if (alone !== null) {
        return alone.openExample(name);
    }
    await fetched("/api/example", { method: "POST", body: JSON.stringify({ name }) });
}

export async function fetchExamples(): Promise<string[]> {
    return alone?.examples ?? ((await (await fetched("/api/examples")).json()) as string[]);
}

export async function fetchText(number: number): Promise<FileText> {
    return alone?.file(number) ?? ((await (await fetched(`/api/file?number=${number}`)).json()) as FileText);
}

/** Rows of x, y, z in pulses, seconds, line. */
export async function fetchCourse(number: number): Promise<Float32Array> {
    return alone?.file(number).rows ?? new Float32Array(await (await fetched(`/api/course?number=${number}`)).arrayBuffer());
}

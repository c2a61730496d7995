import { troubleText } from "./i18n";
import type { FileText, Trouble } from "./protocol";

/** The service has answered that it does not do this; the message is why. */
export class Refused extends Error {}

async function fetched(path: string, init: RequestInit = {}): Promise<Response> {
    const response = await fetch(path, init);
    if (response.ok) {
        return response;
    }
    const { error } = (await response.json().catch(() => ({}))) as { error?: Trouble };
    throw new Refused(error ? troubleText(error) : `${path}: ${response.status}`);
}

/** Has a file or a machine file opened; all pages are told of it. */
export async function openFile(kind: "file" | "machine", file: File): Promise<void> {
    await fetched(`/api/${kind}?name=${encodeURIComponent(file.name)}`, { method: "POST", body: file });
}

export async function openExample(name: string): Promise<void> {
    await fetched("/api/example", { method: "POST", body: JSON.stringify({ name }) });
}

export async function fetchExamples(): Promise<string[]> {
    return (await (await fetched("/api/examples")).json()) as string[];
}

export async function fetchText(number: number): Promise<FileText> {
    return (await (await fetched(`/api/file?number=${number}`)).json()) as FileText;
}

/** Rows of x, y, z in pulses, seconds, line. */
export async function fetchCourse(number: number): Promise<Float32Array> {
    return new Float32Array(await (await fetched(`/api/course?number=${number}`)).arrayBuffer());
}

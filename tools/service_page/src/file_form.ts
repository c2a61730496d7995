/*
 * What a program file is like besides its text, so that it is written as it was read: what was not edited keeps its
 * bytes. Pure.
 */

export type Encoding = "utf-8" | "utf-8-bom" | "windows-1250";
export type LineEnd = "\n" | "\r\n" | "\r";
export type Unreadable = "utf16" | "notText";

export interface FileForm {
    /** Of the file it came from or went to. */
    name: string;
    encoding: Encoding;
    /** Of new lines, and of all if there is no other in the file. */
    end: LineEnd;
    /** The text as it was read, if its lines end in different ways. */
    mixed: string | null;
    /** What old programs put after the text: the DOS end of file, and what fills the rest. */
    tail: string;
}

export const newForm = (name: string): FileForm => ({ name, encoding: "utf-8", end: "\n", mixed: null, tail: "" });

const BOM = "\ufeff";
const TAIL = /\x1a[\x1a\0\s]*$/;
const LINE_END = /\r\n|\n|\r/;

/** The characters of the 256 bytes of Windows-1250. */
const CHARACTERS = new TextDecoder("windows-1250").decode(Uint8Array.from({ length: 256 }, (_, byte) => byte));
const BYTES = new Map([...CHARACTERS].map((character, byte) => [character, byte]));

/** Programs of old tools are in Windows-1250; whatever is not UTF-8 is taken for that. */
function decode(bytes: Uint8Array): { text: string; encoding: Encoding } {
    try {
        const text = new TextDecoder("utf-8", { fatal: true, ignoreBOM: true }).decode(bytes);
        return text.startsWith(BOM) ? { text: text.slice(1), encoding: "utf-8-bom" } : { text, encoding: "utf-8" };
    } catch {
        return { text: new TextDecoder("windows-1250").decode(bytes), encoding: "windows-1250" };
    }
}

/** The end of line that most lines have. */
function usualEnd(ends: string[]): LineEnd {
    const count = (end: LineEnd): number => ends.filter((each) => each === end).length;
    const all: LineEnd[] = ["\n", "\r\n", "\r"];
    return all.reduce((best, end) => (count(end) > count(best) ? end : best));
}

const endsOf = (text: string): string[] => text.match(new RegExp(LINE_END, "g")) ?? [];

/** Reads a file. The text has the line ends of the editor. */
export function decodeProgram(name: string, bytes: Uint8Array): { text: string; form: FileForm } | Unreadable {
    const start = bytes[0] === undefined ? "" : `${bytes[0]} ${bytes[1] ?? ""}`;
    if (start === "255 254" || start === "254 255") {
        return "utf16";
    }
    const { text: whole, encoding } = decode(bytes);
    const tail = TAIL.exec(whole)?.[0] ?? "";
    const text = whole.slice(0, whole.length - tail.length);
    if (text.includes("\0")) {
        return "notText";
    }
    const ends = endsOf(text);
    const isMixed = new Set(ends).size > 1;
    const form: FileForm = { name, encoding, end: usualEnd(ends), mixed: isMixed ? text : null, tail };
    return { text: text.split(LINE_END).join("\n"), form };
}

/** Lines before and after those that were edited keep the ends that they had. */
function withMixedEnds(lines: string[], before: string, end: LineEnd): string {
    const [old, ends] = [before.split(LINE_END), endsOf(before)];
    const common = Math.min(lines.length, old.length);
    let [first, last] = [0, 0];
    while (first < common && lines[first] === old[first]) {
        first += 1;
    }
    while (last < common - first && lines.at(-1 - last) === old.at(-1 - last)) {
        last += 1;
    }
    const endOf = (index: number): string => {
        const fromEnd = lines.length - index;
        const at = index < first ? index : fromEnd <= last ? old.length - fromEnd : -1;
        return ends[at] ?? end;
    };
    return lines.map((line, index) => (index < lines.length - 1 ? line + endOf(index) : line)).join("");
}

/** The bytes of a file, and what it is like; what Windows-1250 cannot write becomes UTF-8. */
export function encodeProgram(form: FileForm, text: string): { bytes: Uint8Array<ArrayBuffer>; form: FileForm } {
    const lines = text.split("\n");
    const body = form.mixed === null ? lines.join(form.end) : withMixedEnds(lines, form.mixed, form.end);
    const whole = body + form.tail;
    const mixed = form.mixed === null ? null : body;
    if (form.encoding === "windows-1250") {
        const bytes = [...whole].map((character) => BYTES.get(character));
        if (bytes.every((byte) => byte !== undefined)) {
            return { bytes: Uint8Array.from(bytes), form: { ...form, mixed } };
        }
    }
    const encoding = form.encoding === "windows-1250" ? "utf-8" : form.encoding;
    const bytes = new TextEncoder().encode((encoding === "utf-8-bom" ? BOM : "") + whole);
    return { bytes, form: { ...form, encoding, mixed } };
}

/** The file of all settings of a unit, as the command `settings backup` writes it. */
import type { Part, Row } from "./protocol";

const FORMAT = "positioning settings";
const FORMAT_VERSION = 1;
const LAYOUT = 1;
const FILE_BYTES_MAX = 100_000;
const PARTS: readonly Part[] = ["unit", "axis1", "axis2", "axis3", "axis4"];

export type AllSettings = Record<Part, Record<string, number>>;

/** What is wrong with a file; the page has the words. */
export type FileTrouble = "file.large" | "file.json" | "file.kind" | "file.version" | "file.parts" | "file.value";

interface BadFile {
    trouble: FileTrouble;
    which: string;
}

export function textOf(settings: AllSettings): string {
    return `${JSON.stringify({ format: FORMAT, version: FORMAT_VERSION, layout: LAYOUT, settings }, null, 2)}\n`;
}

/** The settings of a file, each of them a value of its range; `which` is the one that is not. */
export function readText(text: string, rows: readonly Row[]): AllSettings | BadFile {
    const fail = (trouble: FileTrouble, which = ""): BadFile => ({ trouble, which });
    if (text.length > FILE_BYTES_MAX) {
        return fail("file.large");
    }
    let content: { format?: unknown; version?: unknown; layout?: unknown; settings?: unknown } | null;
    try {
        content = JSON.parse(text) as typeof content;
    } catch {
        return fail("file.json");
    }
    if (typeof content !== "object" || content?.format !== FORMAT) {
        return fail("file.kind");
    }
    if (content.version !== FORMAT_VERSION || content.layout !== LAYOUT) {
        return fail("file.version");
    }
    const settings = content.settings as AllSettings;
    if (!hasJust(settings, PARTS)) {
        return fail("file.parts");
    }
    for (const part of PARTS) {
        const own = rows.filter((row) => row.part === (part === "unit" ? "unit" : "axis"));
        if (!hasJust(settings[part], own.map(({ name }) => name))) {
            return fail("file.parts", part);
        }
        const bad = own.find((row) => !takes(row, settings[part][row.name]));
        if (bad !== undefined) {
            return fail("file.value", `${part} ${bad.name}`);
        }
    }
    return settings;
}

function hasJust(found: unknown, names: readonly string[]): boolean {
    const keys = typeof found === "object" && found !== null ? Object.keys(found) : [];
    return keys.length === names.length && names.every((name) => keys.includes(name));
}

/** In 100 Bd. */
const RATES = [96, 192, 384, 576, 1152];

/** Whether the unit takes a value, as far as its row alone tells. */
function takes({ form, least, most }: Row, value: unknown): boolean {
    if (!Number.isInteger(value)) {
        return false;
    }
    const whole = value as number;
    if (form === "RATE") {
        return RATES.includes(whole);
    }
    return (form === "ZERO_OR" && whole === 0) || (whole >= least && whole <= most);
}

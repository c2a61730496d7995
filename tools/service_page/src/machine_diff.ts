import { make } from "./dom";
import { t } from "./i18n";
import { diffLines, linesOf, type DiffLine } from "./line_diff";
import { factLines } from "./machine_facts";
import type { MachineContent } from "./machine_file";

/** So many lines of a part are shown. */
const SHOWN_MAX = 400;

/** A part in which two machines differ. */
export interface Difference {
    title: string;
    groups: DiffLine[][];
    /** Whether its lines have numbers for people. */
    isNumbered: boolean;
}

/** The parts in which two machines differ, in the words of the page. */
export function differences(here: MachineContent, there: MachineContent): Difference[] {
    const theirs = partsOf(there);
    const all = partsOf(here).map(({ title, lines, isNumbered }, at) => {
        return { title, isNumbered, groups: diffLines(lines, theirs[at]?.lines ?? []) };
    });
    return all.filter(({ groups }) => groups.length > 0);
}

function partsOf(machine: MachineContent): { title: string; lines: string[]; isNumbered: boolean }[] {
    const { notes = "", inputs = "", gve134 } = machine;
    const part = (title: string, text: string) => ({ title, lines: linesOf(text), isNumbered: true });
    return [
        { title: t("compare.settings"), lines: factLines(machine), isNumbered: false },
        part(t("machine.notes"), notes),
        part(t("print.inputs"), inputs),
        ...machine.motors.map(({ program }, index) => {
            return part(`${t("motor.one", { motor: index + 1 })} · ${t("editor.title")}`, program);
        }),
        { ...part("GVE134", gve134 === undefined ? "" : JSON.stringify(gve134, sorted, 2)), isNumbered: false },
    ];
}

/** The order of names says nothing. */
function sorted(_: string, value: unknown): unknown {
    const isObject = typeof value === "object" && value !== null && !Array.isArray(value);
    return isObject ? Object.fromEntries(Object.entries(value).sort(([a], [b]) => (a < b ? -1 : 1))) : value;
}

/** A heading and the lines: `-` is here, `+` is there. */
export function shownDifference({ title, groups, isNumbered }: Difference): HTMLElement[] {
    const lines = groups.flatMap((group, at) => (at === 0 ? group : [null, ...group]));
    const rows = lines.slice(0, SHOWN_MAX).map((line) => row(line, isNumbered));
    const rest = lines.length - rows.length;
    const more = rest > 0 ? [make("span", {}, t("compare.more", { lines: rest }))] : [];
    return [make("h3", {}, title), make("pre", { class: "diff" }, ...rows, ...more)];
}

/** null: lines that are the same are left out. */
function row(line: DiffLine | null, isNumbered: boolean): HTMLElement {
    if (line === null) {
        return make("span", {}, "…\n");
    }
    const { text, here, there } = line;
    const sign = here === null ? "+" : there === null ? "-" : " ";
    const number = isNumbered ? `${here ?? there ?? ""}`.padStart(4) : "";
    return make("span", { "data-sign": sign }, `${sign}${number} ${text}\n`);
}

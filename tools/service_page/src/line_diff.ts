/** The lines in which two texts differ. Pure. */
import { structuredPatch } from "diff";

/** A line of both texts, or of one of them: its numbers in each. */
export interface DiffLine {
    text: string;
    here: number | null;
    there: number | null;
}

/** More differences than these are not looked for: all lines are told as others then. */
const EDITS_MAX = 1500;
const CONTEXT = 3;

export const linesOf = (text: string): string[] =>
    text === "" ? [] : text.replace(/(\r\n|\r|\n)$/, "").split(/\r\n|\r|\n/);

/** The differences with the lines around them, in groups of neighbours; none: the texts are the same. */
export function diffLines(ours: string[], theirs: string[]): DiffLine[][] {
    const options = { context: CONTEXT, maxEditLength: EDITS_MAX };
    const patch = structuredPatch("", "", textOf(ours), textOf(theirs), "", "", options);
    if (patch === undefined) {
        return [[...ours.map((text, at) => left(text, at + 1)), ...theirs.map((text, at) => added(text, at + 1))]];
    }
    return patch.hunks.map(({ oldStart, newStart, lines }) => numbered(lines, oldStart, newStart));
}

const textOf = (lines: string[]): string => lines.map((line) => `${line}\n`).join("");
const left = (text: string, here: number): DiffLine => ({ text, here, there: null });
const added = (text: string, there: number): DiffLine => ({ text, here: null, there });

/** Lines of a patch, which begin with their sign. */
function numbered(lines: string[], here: number, there: number): DiffLine[] {
    return lines.map((line) => {
        const [sign, text] = [line[0], line.slice(1)];
        if (sign === "-") {
            return left(text, here++);
        }
        return sign === "+" ? added(text, there++) : { text, here: here++, there: there++ };
    });
}

export type InputChange = [ms: number, input: number, level: number];

const CHANGE = /^(\d+(?:\.\d+)?)[\s,]+([1-8])[\s,]+([01])$/;

/**
 * Reads changes of inputs, one a line or separated by semicolons: milliseconds, input, level, as in the files of
 * `rkm04 sim --inputs`. Returns null if any of them is not understood.
 */
export function parseInputs(text: string): InputChange[] | null {
    const parts = text
        .split(/[\n;]/)
        .map((part) => part.replace(/#.*/, "").trim())
        .filter((part) => part !== "");
    const changes: InputChange[] = [];
    for (const part of parts) {
        const match = CHANGE.exec(part);
        if (match === null) {
            return null;
        }
        changes.push([Number(match[1]), Number(match[2]), Number(match[3])]);
    }
    return changes.sort((a, b) => a[0] - b[0]);
}

export const formatInputs = (changes: InputChange[]): string =>
    changes.map((change) => change.join(",")).join("; ");

import { rows, type RegisterRow } from "pos-registers";

/** Axis n has the registers 100 n + ... */
export const AXIS_STEP = 100;
export const WORD_MAX = 0xffff;
const WORD = 0x10000;

export { bits, images, instructions, type RegisterRow } from "pos-registers";

export const settingRows: readonly RegisterRow[] = rows.filter(({ use }) => use === "SETTING");

/** A register by its name. */
export function register(name: string): RegisterRow {
    const found = rows.find((row) => row.name === name);
    if (found === undefined) {
        throw new Error(`there is no register ${name}`);
    }
    return found;
}

/** How many registers of the line it is. */
export const wordsOf = ({ type }: RegisterRow): number => (type.endsWith("32") ? 2 : 1);

const isSigned = ({ type }: RegisterRow): boolean => type.startsWith("I");

/** The least and the greatest value that its type can have. */
export function typeRange(row: RegisterRow): [number, number] {
    const count = WORD ** wordsOf(row);
    return isSigned(row) ? [-count / 2, count / 2 - 1] : [0, count - 1];
}

/** The value of its registers, as they come from the line: of `words` those from `at` on. */
export function valueOf(row: RegisterRow, words: readonly number[], at = 0): number {
    const value = words.slice(at, at + wordsOf(row)).reduce((sum, word) => sum * WORD + word, 0);
    const count = WORD ** wordsOf(row);
    return isSigned(row) && value >= count / 2 ? value - count : value;
}

/** The registers of a number, which may be negative. */
export function wordsOfValue(value: number, count: number): number[] {
    const whole = value < 0 ? value + WORD ** count : value;
    return count === 1 ? [whole] : [Math.floor(whole / WORD), whole % WORD];
}

/** Registers of the unit, or of each axis, that are only read and stand side by side, the first of them, and their number. */
export function readBlock(scope: "U" | "A"): { rows: RegisterRow[]; first: number; words: number } {
    const own = rows.filter((row) => row.scope === scope && row.use === "READ");
    const first = own[0]?.number ?? 0;
    return { rows: own, first, words: own.reduce((sum, row) => sum + wordsOf(row), 0) };
}

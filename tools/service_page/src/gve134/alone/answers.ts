/** Commands and answers of the unit as people and files have them. */

export const DONE = 0;
export const NO_ROOM = 1;
export const BOUNDS = 5;
export const NOTHING_TO_GO_ON = 6;
export const NOT_WHILE_MOVING = 7;
const INTA_BIT = 8;
/** GVE_WIRE_TEXT_BYTES */
const TEXT_BYTES_MAX = 6400;
const WORDS = [
    "done",
    "no room for the vector",
    "the command was damaged",
    "unknown command",
    "wrong syntax",
    "a parameter is out of bounds",
    "nothing to go on with",
    "not while a vector runs",
];
/** What the code NOT_WHILE_MOVING says with INTA. */
const NOT_AFTER_STOP = "not after a stop or a fault: D comes first";

/** An answer: its code, 0 to 7, whether INTA is set, and its values without the first comma. */
export interface Answer {
    code: number;
    inta: boolean;
    values: string;
}

const PARTS = /^([LC])(-?\d+)((?:,-?\d+){0,3})$/;
export const isReset = (command: string): boolean => command === "J" || command === "!7J";

/** An answer by its digit. */
export const answerOf = (digit: number, values: string): Answer =>
    ({ code: digit % INTA_BIT, inta: digit >= INTA_BIT, values });

export const answerText = ({ code, inta, values }: Answer): string => {
    const digit = (code + (inta ? INTA_BIT : 0)).toString(16).toUpperCase();
    return values === "" ? digit : `${digit},${values}`;
};

export const answerWords = ({ code, inta }: Answer): string => {
    const words = inta && code === NOT_WHILE_MOVING ? NOT_AFTER_STOP : (WORDS[code] ?? "");
    return `${words}${inta ? ", INTA is set" : ""}`;
};

/** A command in capital letters, vectors with all their four numbers. */
export function canonical(command: string): string {
    const text = command.toUpperCase();
    const match = PARTS.exec(text);
    if (match === null) {
        return text;
    }
    const parts = [match[2] ?? "0", ...(match[3] ?? "").split(",").slice(1)];
    return (match[1] ?? "") + [0, 1, 2, 3].map((axis) => parts[axis] ?? "0").join(",");
}

/** Commands as the module gve134-unit has them; null: it has no room for so many. */
export function bytesOf(commands: string[]): Uint8Array | null {
    const text = Uint8Array.from(commands.join("\n"), (letter) => letter.charCodeAt(0));
    return text.length > TEXT_BYTES_MAX ? null : text;
}

/** Commands and answers of the unit as they stand on the line, with a checksum or without. */

export const DONE = 0;
export const NO_ROOM = 1;
export const DAMAGED = 2;
export const BOUNDS = 5;
export const NOTHING_TO_GO_ON = 6;
export const NOT_WHILE_MOVING = 7;
const INTA_BIT = 8;
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

export const NO_VALUES = /^$/;
const ANY_VALUES = /^.*$/;
const ONE_NUMBER = /^\d{1,3}$/;
const BYTE = /^[0-9A-F]{2}$/;
const FOUR = /^-?\d+(,-?\d+){3}$/;
/** What the values of an answer look like: what looks otherwise is the answer to something else. */
const FORMS: Record<string, RegExp> = {
    "?": /^.+$/,
    Q: /^[0-9A-F]{8}$/,
    P: /^-?\d+,-?\d+$/,
    PF: /^-?\d+(,-?\d+){2}$/,
    P4: FOUR,
    PL: FOUR,
    SR: BYTE,
    F: BYTE,
    I1: BYTE,
    I2: BYTE,
    ER: BYTE,
    EUR: /^[0-9A-F]{8}$/,
    EFR: /^(-?(\d+(\.\d+)?(E[-+]\d+)?|INF)|NAN)$/,
    "@": ONE_NUMBER,
    ">": ANY_VALUES,
    "*E": ONE_NUMBER,
};
const PARTS = /^([LC])(-?\d+)((?:,-?\d+){0,3})$/;
const WITH_SUM = /^(([0-9A-F])(?:,(.+))?,)([0-9A-F]{2})$/;
const WITHOUT_SUM = /^([0-9A-F])(?:,(.+))?$/;
const MEMORY_WRITE = /^E[UF]?W/;

export const isMemoryWrite = (command: string): boolean => MEMORY_WRITE.test(command);
export const isReset = (command: string): boolean => command === "J" || command === "!7J";

export const answerText = ({ code, inta, values }: Answer): string => {
    const digit = (code + (inta ? INTA_BIT : 0)).toString(16).toUpperCase();
    return values === "" ? digit : `${digit},${values}`;
};

export const answerWords = ({ code, inta }: Answer): string => {
    const words = inta && code === NOT_WHILE_MOVING ? NOT_AFTER_STOP : (WORDS[code] ?? "");
    return `${words}${inta ? ", INTA is set" : ""}`;
};

const sumOf = (text: string): string => {
    let sum = 0;
    for (let at = 0; at < text.length; at += 1) {
        sum += text.charCodeAt(at);
    }
    return (sum % 256).toString(16).toUpperCase().padStart(2, "0");
};

/** A command as files have it, with its address before it: H becomes 0H, !7V300 7V300. */
export const addressed = (command: string): string => (command.startsWith("!") ? command.slice(1) : `0${command}`);

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

/** A command as files have it, as the line has it. */
export function encoded(command: string, sums: boolean): string {
    const text = `!${addressed(canonical(command))}`;
    return sums ? `${text},${sumOf(`${text},`)}\r` : `${text}\r`;
}

/** What the values of the answer to a command look like where its code is 0. */
export function formOf(command: string): RegExp {
    const text = addressed(command).slice(1).toUpperCase();
    const names = text.startsWith("V") ? [] : Object.keys(FORMS).filter((name) => text.startsWith(name));
    const name = names.sort((one, other) => other.length - one.length)[0];
    return (name === undefined ? undefined : FORMS[name]) ?? NO_VALUES;
}

/** Reads an answer without its CR; null: it is none, or its checksum is wrong. */
export function parsed(line: string, sums: boolean): Answer | null {
    const match = (sums ? WITH_SUM : WITHOUT_SUM).exec(line);
    if (match === null || (sums && sumOf(match[1] ?? "") !== match[4])) {
        return null;
    }
    const digit = parseInt(match[sums ? 2 : 1] ?? "0", 16);
    return { code: digit % INTA_BIT, inta: digit >= INTA_BIT, values: match[sums ? 3 : 2] ?? "" };
}

/** Whether an answer can be one to a command; what was refused has no values, but packets. */
export const fits = ({ code, values }: Answer, form: RegExp): boolean =>
    (code !== DONE && values === "") || form.test(values);

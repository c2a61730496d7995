import type { CommandRow } from "help-pages";
import { language } from "./i18n";

type Words = readonly [en: string, cs: string];

/** What each command means; where a letter has several meanings, by the first number of the range. */
const MEANINGS: Record<string, Words> = {
    "\\": ["initial state: program, loops and settings are forgotten", "RESET – uvedení motoru do výchozího stavu"],
    "@": ["label, 1–80", "návěští, 1–80"],
    A: ["acceleration and braking, 1–60 000 steps/s²", "zrychlení a brzdění, 1–60 000 kroků/s²"],
    B: ["next move: steps backward, 1–16 000 000", "pohyb vzad, 1–16 000 000 kroků"],
    C1: ["clear output 1–8", "zruš výstup 1–8"],
    C40: ["switch function 40–58 off", "zruš funkci 40–58"],
    C75: ["resume after a stop; only when sent alone", "obnovení pohybu po K; jen samostatně"],
    C80: ["clear internal variable 80–95", "zruš vnitřní proměnnou 80–95"],
    C100: ["here is position 0", "smaž čítač absolutní polohy"],
    D: ["reverse the direction of the next moves", "změna směru pohybu"],
    E: ["end of loop", "konec smyčky"],
    F: ["next move: steps forward, 1–16 000 000", "pohyb vpřed, 1–16 000 000 kroků"],
    G: ["go to an absolute position", "absolutní poloha – jede na zadanou polohu"],
    "G+": ["run forward without end", "trvale vpřed"],
    "G-": ["run backward without end", "trvale vzad"],
    H: ["go to position 0", "výchozí poloha – návrat na polohu 0"],
    I: [
        "jump to a label if an input or variable is 1 (H) or 0 (L)",
        "podmíněný skok: vstup nebo proměnná je 1 (H), 0 (L)",
    ],
    J: ["jump to label 1–80", "skok na návěští 1–80"],
    K: ["stop the motor and its program; only when sent alone", "konec pohybu a stop programu; jen samostatně"],
    L: ["start of a loop, 1–255 times", "začátek smyčky, 1–255 opakování"],
    M: [
        "guard: stop the move when input 1–8 is 1; the program goes on",
        "stop pohybu od vstupu 1–8 ve stavu 1, program pokračuje",
    ],
    N: [
        "guard: stop the move when input 1–8 is 0; the program goes on",
        "stop pohybu od vstupu 1–8 ve stavu 0, program pokračuje",
    ],
    O: [
        "wait until an input (1–8) or variable (80–95) is 1",
        "čekání na vstup (1–8) nebo proměnnou (80–95) ve stavu 1",
    ],
    R: ["do the move that was set up", "proveď pohyb"],
    S: ["start/stop speed, 1–2 000 steps/s", "Start/Stop rychlost, 1–2 000 kroků/s"],
    T1: ["set output 1–8", "nastav výstup 1–8"],
    T40: ["switch function 40–58 on", "nastav funkci 40–58"],
    T80: ["set internal variable 80–95", "nastav vnitřní proměnnou 80–95"],
    U: ["cancel the guards M and N", "zruší povely M a N"],
    V: ["maximum speed, 1–16 000 steps/s", "maximální rychlost, 1–16 000 kroků/s"],
    W: ["wait, 1–16 000 000 ms", "čekání, 1–16 000 000 ms"],
    X: ["total stop: input 1–8 being 1 ends the program", "total stop od vstupu 1–8 ve stavu 1, program se ukončí"],
    Y: ["append a section to the compound move", "složený pohyb – zapíše úsek do tabulky"],
    Z: [
        "wait until an input (1–8) or variable (80–95) is 0",
        "čekání na vstup (1–8) nebo proměnnou (80–95) ve stavu 0",
    ],
    ")": ["forward at start/stop speed until input 1–8 is 1", "limit vpřed: start/stop rychlostí na vstup 1–8"],
    "(": ["backward at start/stop speed until input 1–8 is 1", "limit vzad: start/stop rychlostí na vstup 1–8"],
    "=": ["write the position counter", "zapiš absolutní polohu"],
    "'": ["call the subroutine at label 1–80", "volání podprogramu na návěští 1–80"],
    ".": ["end of subroutine", "konec podprogramu"],
    "[": ["what follows waits for ]", "program – čeká na ]"],
    "]": ["release what waits since [", "konec programu – povolí vykonání od ["],
};

const COMMAND = /I\d*[HL]?\d*|G[+-]|=-?\d+|\S\d*/g;
const COMMENT = /\{[^}]*(\}|$)/g;
const CALLS = /["`´’„]/;

/** Letter, or letter and first number of its range, under which a command is explained. */
function keyOf(command: string): string {
    const letter = command.charAt(0).replace(CALLS, "'");
    if (letter !== "C" && letter !== "T") {
        return command in MEANINGS ? command : letter;
    }
    const number = Number(command.slice(1));
    const starts = [100, 80, 75, 40, 1].filter((start) => `${letter}${start}` in MEANINGS);
    return `${letter}${starts.find((start) => number >= start) ?? ""}`;
}

/** How a command of the table is written, with `n` for its number. */
export function syntaxOf({ letter, form }: CommandRow): string {
    const ends = { NONE: "", NUMBER: "n", IO: "n", SIGNED: "n", PLUS: "+", MINUS: "-", HIGH: "nHn", LOW: "nLn" };
    return letter + ends[form];
}

/** What a command of the table means; empty where nobody has said it. */
export function meaningOf(row: CommandRow): string {
    const sign = { PLUS: "+", MINUS: "-" }[row.form as string] ?? "";
    const words = MEANINGS[keyOf(`${row.letter}${sign || (row.form === "NUMBER" || row.form === "IO" ? row.min : "")}`)];
    return words?.[language.value === "cs" ? 1 : 0] ?? "";
}

/** The command at a place of a text, and what it means; empty where there is none. */
export function explain(text: string, offset: number): string {
    const code = text.replace(COMMENT, (comment) => " ".repeat(comment.length));
    const start = code.lastIndexOf("\n", offset - 1) + 1;
    for (const match of code.slice(start).split("\n", 1)[0]?.matchAll(COMMAND) ?? []) {
        const from = start + match.index;
        if (from <= offset && offset <= from + match[0].length) {
            const words = MEANINGS[keyOf(match[0])];
            return words ? `${match[0]}: ${words[language.value === "cs" ? 1 : 0]}` : "";
        }
    }
    return "";
}

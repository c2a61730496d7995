import { Refusal } from "../../unit_place";
import { canonical } from "./answers";

/** What a line asks of the host (firmware/gve134/docs/line.md says nothing of these; tools/gve134 gcode writes them). */
export type Asked = { kind: "wait"; seconds: number } | { kind: "pause"; text: string } | { kind: "probe" };

/** What stands in a line of a vector file, from 1: a command, or something asked of the host. */
export interface Command {
    line: number;
    text: string;
    /** Its first letter, of the interpolator's; others have none. */
    letter: string;
    asked: Asked | null;
}

const MARK = ";@";
const LINE_END = /\r\n|\n|\r/g;
const BLANKS = /^[ \t]+|[ \t]+$/g;
/** What the line does by itself. */
const LINE_OWN = ["%+", "%-", "@", ">"];
const TIMED = /^@\d/;

export const isVector = ({ letter }: Command): boolean => letter === "L" || letter === "C";
export const goesInPackets = ({ letter }: Command): boolean => letter === "C" || letter === "B";
export const stepsOf = ({ text }: Command): number[] => text.slice(1).split(",").map(Number);

/** The commands of a file that the unit's parser has passed, as they are sent. */
export function* commandsOf(text: string): Generator<Command> {
    let number = 0;
    for (const line of linesOf(text)) {
        number += 1;
        const words = line.replace(BLANKS, "");
        if (words.startsWith(MARK)) {
            yield { line: number, text: words, letter: "", asked: askedOf(words, number) };
            continue;
        }
        const command = (words.split(";")[0] ?? "").replace(BLANKS, "");
        const plain = canonical(command.replace(/^!0/, ""));
        if (TIMED.test(plain)) {
            throw new Refusal(`line ${number}: a command at a time (@) is for tools/gve134 sim`, "nothing was sent");
        }
        if (plain !== "" && !LINE_OWN.includes(plain)) {
            yield { line: number, text: plain, letter: plain.startsWith("!7") ? "" : (plain[0] ?? ""), asked: null };
        }
    }
}

/** One after the other: a file may have millions of them. */
function* linesOf(text: string): Generator<string> {
    let start = 0;
    for (const end of text.matchAll(LINE_END)) {
        yield text.slice(start, end.index);
        start = end.index + end[0].length;
    }
    yield text.slice(start);
}

function askedOf(words: string, line: number): Asked {
    const text = words.slice(MARK.length);
    const wait = /^wait (\d+(?:\.\d+)?)$/.exec(text);
    const pause = /^pause\b ?(.*)$/.exec(text);
    if (wait) {
        return { kind: "wait", seconds: Number(wait[1]) };
    }
    if (pause) {
        return { kind: "pause", text: pause[1] ?? "" };
    }
    if (text === "probe") {
        return { kind: "probe" };
    }
    throw new Refusal(`line ${line}: nothing is known of ${words}`, "it was written by later tools");
}

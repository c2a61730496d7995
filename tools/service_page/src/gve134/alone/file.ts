import { ProgramHost, type Bytes } from "../../program_host";
import type { FileState, FileText } from "../protocol";
import { commandsOf, isVector, stepsOf, type Command } from "./job_text";

/** Characters. */
export const TEXT_MAX = 10_000_000;
const PROBLEMS_MAX = 100;
/** The number of files of the page itself; those of a user have others. */
const OWN = 0;
const COURSE = "course";
const SET_POSITION = /^N(?:([XYZA]),?(-?\d+))?$/;

/**
 * All vectors of a file, those without a way left out; `counts` says how many of them there are before each vector of
 * the file.
 */
export interface Course {
    /** Of each vector the pulses of X, Y, Z and A. */
    parts: Int32Array;
    lines: Uint32Array;
    seconds: Float64Array;
    counts: Uint32Array;
}

/** A vector file as the firmware's own parser and planner see it; `course` is null if it has errors. */
export interface Opened extends FileText {
    state: FileState;
    /** Of each vector the place of X, Y and Z at its end, seconds, line; see api.ts. */
    rows: Float32Array;
    course: Course | null;
}

interface Parsed {
    errors: { line: number; column: number; message: string }[];
    more: number;
}

interface Plan {
    seconds: number;
    peaks: number[];
}

/** Reads vector files with the program gve134-host. */
export class FileReader {
    readonly #host: ProgramHost;
    #last = 0;

    constructor(bytes: Bytes) {
        this.#host = new ProgramHost(bytes, "gve134-host");
    }

    open(name: string, text: string): Opened {
        this.#last += 1;
        const checked = JSON.parse(this.#host.run(["check", "-"], new Map(), encode(text))) as Parsed;
        const problems = checked.errors.map(({ line, column, message }) => ({ severity: "error" as const, line, column, message }));
        const more = Math.max(0, problems.length - PROBLEMS_MAX) + checked.more;
        const told = { text, problems: problems.slice(0, PROBLEMS_MAX), more };
        const facts = { number: this.#last, name, ok: false, errors: problems.length + checked.more };
        const none = { vectors: 0, seconds: null, peaks: null, absolute_from: null };
        if (problems.length > 0) {
            return { ...told, state: { ...facts, ...none }, rows: new Float32Array(), course: null };
        }
        return { ...told, ...this.#planned(text, { ...facts, ok: true }) };
    }

    #planned(text: string, facts: Pick<FileState, "number" | "name" | "ok" | "errors">): Pick<Opened, "state" | "rows" | "course"> {
        const files = new Map<string, Bytes>();
        const lines = `${text.replace(/\r\n?/g, "\n")}\n`;
        const plan = JSON.parse(this.#host.run(["plan", "1", "1", "1", `/${COURSE}`], files, encode(lines))) as Plan;
        const planned = new Float64Array((files.get(COURSE) ?? new Uint8Array()).slice().buffer);
        const seconds = planned.filter((value, at) => at % 3 === 2 && !Number.isNaN(value));
        const way = new Way();
        let waited_s = 0;
        for (const command of commandsOf(text)) {
            way.take(command);
            waited_s += command.asked?.kind === "wait" ? command.asked.seconds : 0;
        }
        if (way.lines.length !== seconds.length) {
            throw new Error(`the plan has ${seconds.length} vectors of ${way.lines.length}`);
        }
        const course = { parts: Int32Array.from(way.parts), lines: Uint32Array.from(way.lines), seconds, counts: Uint32Array.from(way.counts) };
        const { peaks } = plan;
        const told = { vectors: seconds.length, seconds: plan.seconds + waited_s, peaks, absolute_from: seconds.length > 0 ? way.absolute.slice(0, 3) : null };
        return { state: { ...facts, ...told }, rows: way.rows(seconds), course };
    }
}

/** A file of the page itself, without vectors. */
export function ownFile(name: string, text: string): Opened {
    const way = new Way();
    for (const command of commandsOf(text)) {
        way.take(command);
    }
    const facts = { number: OWN, name, ok: true, errors: 0, vectors: 0, seconds: null, peaks: null, absolute_from: null };
    const course = {
        parts: new Int32Array(), lines: new Uint32Array(), seconds: new Float64Array(), counts: Uint32Array.from(way.counts),
    };
    return { text, problems: [], more: 0, state: facts, rows: new Float32Array(), course };
}

/** The way that a file leads: from where the axes stand, and of each axis absolute from its command N on. */
class Way {
    readonly parts: number[] = [];
    readonly lines: number[] = [];
    readonly counts = [0];
    readonly absolute: (number | null)[] = [null, null, null, null];
    readonly #begins: number[] = [];
    #at = [0, 0, 0, 0];

    take(command: Command): void {
        if (isVector(command)) {
            const steps = stepsOf(command);
            if (steps.some((each) => each !== 0)) {
                this.parts.push(...steps);
                this.#begins.push(...this.#at);
                this.lines.push(command.line);
                this.#at = this.#at.map((at, axis) => at + (steps[axis] ?? 0));
            }
            this.counts.push(this.lines.length);
            return;
        }
        const match = SET_POSITION.exec(command.text);
        if (match) {
            for (const axis of match[1] === undefined ? [0, 1, 2, 3] : ["XYZA".indexOf(match[1])]) {
                this.#at[axis] = Number(match[2] ?? 0);
                this.absolute[axis] ??= this.lines.length;
            }
        }
    }

    /** A row for a vector; before one that begins elsewhere a row without seconds: its begin. */
    rows(seconds: Float64Array): Float32Array {
        const found: number[] = [];
        let before: number[] = [];
        for (const [vector, line] of this.lines.entries()) {
            const begin = this.#begins.slice(4 * vector, 4 * vector + 3);
            const end = begin.map((at, axis) => at + (this.parts[4 * vector + axis] ?? 0));
            if (begin.join() !== before.join()) {
                found.push(...begin, NaN, line);
            }
            found.push(...end, seconds[vector] ?? NaN, line);
            before = end;
        }
        return Float32Array.from(found, (value) => value);
    }
}

const encode = (text: string): Bytes => new TextEncoder().encode(text);

import type { Bytes } from "./program_host";
import { instantiated, ns } from "./unit_module";
import { BROADCAST, LineTrouble, ONCE, Refusal, USUAL, type Place, type Wait } from "./unit_place";

/** What the module rkm04-unit exports of a line; see tools/lines/lines_rkm04.h. */
interface Exports {
    memory: WebAssembly.Memory;
    lines_rkm04_begin: (chance: number, baud: number, usual_ms: number) => number;
    lines_rkm04_request: (line: number) => number;
    lines_rkm04_heard: (line: number) => number;
    lines_rkm04_ask: (
        line: number, node: number, session: number, length: number, patience_ms: number, attempts: number, now: bigint,
    ) => void;
    lines_rkm04_scan: (line: number, node: number, patience_ms: number, attempts: number, now: bigint) => void;
    lines_rkm04_twice: (line: number) => number;
    lines_rkm04_take: (line: number, length: number, now: bigint) => void;
    lines_rkm04_poll: (line: number, now: bigint) => number;
    lines_rkm04_hurry: (line: number, now: bigint) => void;
    lines_rkm04_sessions: (line: number, node: number) => number;
    lines_rkm04_out: (line: number) => number;
    lines_rkm04_take_out: (line: number) => number;
    lines_rkm04_answer: (line: number) => number;
    lines_rkm04_answer_length: (line: number) => number;
}

/** LINES_RKM04_HEARD_BYTES */
const HEARD_BYTES = 4096;
/** A frame of 1024 bytes, less its envelope: short ones are checked better, and lost less. */
const TEXT_BYTES_MAX = 1013;

/** What stands before a byte that would be a flag or this one: in a frame flag, address, number, message. */
const ESCAPE = 0x7d;

/** enum master_end of tools/master/master.h, from MASTER_WAITS on. */
const WAITS = 0;
const ANSWERED = 1;
const CHECK = "check power, wiring (A, B) and address (switch S1); Scan shows who is there";
const ENDS: Record<number, (where: string) => LineTrouble> = {
    2: (where) => new LineTrouble("NoAnswer", `${where} does not answer`, CHECK),
    3: (where) => new LineTrouble("NoAnswer", `${where} does not answer, only the adapter's echo comes back`, CHECK),
    4: (where) =>
        new LineTrouble(
            "GarbledAnswer",
            `what comes back from ${where} is damaged`,
            "do two units have this address (switch S1), are A and B swapped, is the line terminated?",
        ),
    5: (where) => restarted(where, "not executed"),
    6: (where) => restarted(where, "executed before that or not at all"),
    7: (where) => new LineTrouble("NoAnswer", `${where} was not asked`, "ask again"),
};

function restarted(where: string, what: string): LineTrouble {
    const next = "look at the unit before you send it again";
    return new LineTrouble("UnitRestarted", `${where} has restarted, the request was ${what}`, next);
}

interface Waiting {
    node: number;
    take: (answer: Bytes) => void;
    fail: (why: Refusal) => void;
}

/** A line with units: the master of tools/master, and the bytes of a serial port of the page. */
export class SerialLine implements Place {
    readonly port: string;
    readonly isVirtual = false;
    readonly text_bytes_max = TEXT_BYTES_MAX;
    readonly stood_s = null;
    written = 0;
    readonly #exports: Exports;
    readonly #line: number;
    readonly #write: (data: Bytes) => void;
    #waiting: Waiting | null = null;
    #lost: LineTrouble | null = null;

    constructor(bytes: Bytes, port: string, baud: number, write: (data: Bytes) => void) {
        this.port = port;
        this.#write = write;
        this.#exports = instantiated<Exports>(bytes);
        const chance = crypto.getRandomValues(new Uint32Array(1))[0] ?? 0;
        this.#line = this.#exports.lines_rkm04_begin(chance || 1, baud, USUAL.patience_ms);
        if (this.#line === 0) {
            throw new Error("there is not memory enough for the line");
        }
    }

    get now_s(): number {
        return performance.now() / 1000;
    }

    ask(node: number, request: Bytes, { session, patience_ms, attempts, scans }: Wait): Promise<Bytes> {
        if (this.#lost !== null) {
            return Promise.reject(this.#lost);
        }
        const { memory, lines_rkm04_request, lines_rkm04_ask, lines_rkm04_scan } = this.#exports;
        new Uint8Array(memory.buffer, lines_rkm04_request(this.#line), request.length).set(request);
        return new Promise((take, fail) => {
            this.#waiting = { node, take, fail };
            if (scans) {
                lines_rkm04_scan(this.#line, node, patience_ms, attempts, this.#now);
            } else {
                lines_rkm04_ask(this.#line, node, Number(session), request.length, patience_ms, attempts, this.#now);
            }
            this.#goOn();
        });
    }

    /** Takes what has come on the port. */
    hear(data: Bytes): void {
        for (let at = 0; at < data.length; at += HEARD_BYTES) {
            const part = data.subarray(at, at + HEARD_BYTES);
            const { memory, lines_rkm04_heard, lines_rkm04_take } = this.#exports;
            new Uint8Array(memory.buffer, lines_rkm04_heard(this.#line), part.length).set(part);
            lines_rkm04_take(this.#line, part.length, this.#now);
        }
        this.#goOn();
    }

    /** To be called again and again. */
    tick(): void {
        if (this.#waiting !== null) {
            this.#goOn();
        }
    }

    /** The port has gone: nothing is sent on it any more. */
    lose(why: LineTrouble): void {
        this.#lost = why;
        this.#settled()?.fail(why);
    }

    get isTwice(): boolean {
        return this.#exports.lines_rkm04_twice(this.#line) !== 0;
    }

    sessions(node: number): number {
        return this.#exports.lines_rkm04_sessions(this.#line, node);
    }

    hurry(): void {
        this.#exports.lines_rkm04_hurry(this.#line, this.#now);
    }

    setInput(): void {
        throw new Refusal("the inputs of a real unit are its own", "only the virtual unit's can be clicked");
    }

    get #now(): bigint {
        return ns(performance.now());
    }

    #settled(): Waiting | null {
        const waiting = this.#waiting;
        this.#waiting = null;
        return waiting;
    }

    #goOn(): void {
        const { lines_rkm04_poll, lines_rkm04_out, lines_rkm04_take_out } = this.#exports;
        const end = lines_rkm04_poll(this.#line, this.#now);
        const length = lines_rkm04_take_out(this.#line);
        if (length > 0) {
            const frame = this.#copied(lines_rkm04_out(this.#line), length);
            this.written = frame[frame[2] === ESCAPE ? 4 : 3] ?? 0;
            this.#write(frame);
        }
        if (end === ANSWERED) {
            const { lines_rkm04_answer, lines_rkm04_answer_length } = this.#exports;
            const answer = this.#copied(lines_rkm04_answer(this.#line), lines_rkm04_answer_length(this.#line));
            this.#settled()?.take(answer);
        } else if (end !== WAITS) {
            const waiting = this.#settled();
            waiting?.fail(ended(end, `unit ${waiting.node}`));
        }
    }

    #copied(place: number, length: number): Bytes {
        return new Uint8Array(this.#exports.memory.buffer, place, length).slice();
    }
}

/** The bytes of a request to all units, which have no number and are executed at any time. */
export function broadcastFrame(bytes: Bytes, baud: number, request: Bytes): Bytes {
    let frame: Bytes = new Uint8Array();
    const line = new SerialLine(bytes, "", baud, (data) => (frame = data));
    void line.ask(BROADCAST, request, ONCE);
    return frame;
}

function ended(end: number, where: string): LineTrouble {
    const made = ENDS[end];
    if (made === undefined) {
        throw new Error(`the line has ended a request by ${end}`);
    }
    return made(where);
}

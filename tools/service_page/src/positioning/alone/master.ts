import type { Bytes } from "../../program_host";
import { instantiated, ns } from "../../unit_module";

/** What the module positioning-unit exports of a line; see tools/lines/lines_positioning.h. */
interface Exports {
    memory: WebAssembly.Memory;
    lines_positioning_begin: (baud: number, tcp: number) => number;
    lines_positioning_request: (line: number) => number;
    lines_positioning_heard: (line: number) => number;
    lines_positioning_ask: (
        line: number, node: number, length: number, patience_ms: number, attempts: number, now: bigint,
    ) => void;
    lines_positioning_take: (line: number, length: number, now: bigint) => void;
    lines_positioning_poll: (line: number, now: bigint) => number;
    lines_positioning_until_ns: (line: number) => bigint;
    lines_positioning_out: (line: number) => number;
    lines_positioning_out_length: (line: number) => number;
    lines_positioning_note_written: (line: number) => void;
    lines_positioning_answer: (line: number) => number;
    lines_positioning_answer_length: (line: number) => number;
}

/** LINES_POSITIONING_HEARD_BYTES */
const HEARD_BYTES = 4096;
const NS_PER_MS = 1e6;

/** How a request has ended: enum pos_master_end of tools/positioning_master/pos_master.h. */
export const WAITS = 0;
export const ANSWERED = 1;
export const SILENT = 3;
export const ECHOED = 4;
export const DAMAGED = 5;

/** The master of a line, tools/positioning_master. It waits for nothing: see pos_master.h. */
export class Master {
    readonly #exports: Exports;
    readonly #line: number;

    /** `baud` 0: bytes take no time. */
    constructor(bytes: Bytes, baud: number) {
        this.#exports = instantiated<Exports>(bytes);
        this.#line = this.#exports.lines_positioning_begin(baud, 0);
        if (this.#line === 0) {
            throw new Error("there is not memory enough for the line");
        }
    }

    /** Begins a request; one that is under way is given up. */
    ask(node: number, request: Bytes, patience_ms: number, attempts: number): void {
        const { lines_positioning_request, lines_positioning_ask } = this.#exports;
        this.#put(lines_positioning_request(this.#line), request);
        lines_positioning_ask(this.#line, node, request.length, patience_ms, attempts, this.#now);
    }

    take(data: Bytes): void {
        const { lines_positioning_heard, lines_positioning_take } = this.#exports;
        for (let at = 0; at < data.length; at += HEARD_BYTES) {
            const part = data.subarray(at, at + HEARD_BYTES);
            this.#put(lines_positioning_heard(this.#line), part);
            lines_positioning_take(this.#line, part.length, this.#now);
        }
    }

    /** What has become of the request. */
    poll(): number {
        return this.#exports.lines_positioning_poll(this.#line, this.#now);
    }

    /** How long until it is to be polled at the latest. */
    get left_ms(): number {
        return Number(this.#exports.lines_positioning_until_ns(this.#line) - this.#now) / NS_PER_MS;
    }

    /** What is to be written now; `noteWritten` tells that it was. */
    get out(): Bytes {
        const { lines_positioning_out, lines_positioning_out_length } = this.#exports;
        return this.#copied(lines_positioning_out(this.#line), lines_positioning_out_length(this.#line));
    }

    noteWritten(): void {
        this.#exports.lines_positioning_note_written(this.#line);
    }

    /** The answer, from its function on. */
    get answer(): Bytes {
        const { lines_positioning_answer, lines_positioning_answer_length } = this.#exports;
        return this.#copied(lines_positioning_answer(this.#line), lines_positioning_answer_length(this.#line));
    }

    get #now(): bigint {
        return ns(performance.now());
    }

    #put(place: number, data: Bytes): void {
        new Uint8Array(this.#exports.memory.buffer, place, data.length).set(data);
    }

    #copied(place: number, length: number): Bytes {
        return new Uint8Array(this.#exports.memory.buffer, place, length).slice();
    }
}

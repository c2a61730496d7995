import type { Bytes } from "./program_host";
import { instantiated, ns } from "./unit_module";
import type { Place } from "./unit_place";
import { TEXT_BYTES_MAX } from "./unit_messages";

/** What the module rkm04-unit exports of a unit; see tools/simulator/wasm/paced.h. */
interface Exports {
    memory: WebAssembly.Memory;
    paced_begin: (real_ns: bigint) => number;
    paced_follow: (unit: number, real_ns: bigint) => number;
    paced_request: (unit: number) => number;
    paced_answer: (unit: number) => number;
    paced_message: (unit: number, length: number) => number;
    paced_set_input: (unit: number, input: number, level: number) => void;
    paced_now_ns: (unit: number) => bigint;
    paced_stood_ns: (unit: number) => bigint;
}

export const VIRTUAL = "virtual";

const seconds = (time_ns: bigint): number => Number(time_ns) / 1e9;

/** The firmware as a unit that runs: it follows the clock that its owner reads, and answers messages. */
export class UnitProgram implements Place {
    readonly port = VIRTUAL;
    readonly isVirtual = true;
    readonly isTwice = false;
    readonly written = 0;
    readonly text_bytes_max = TEXT_BYTES_MAX;
    readonly #exports: Exports;
    readonly #unit: number;

    constructor(bytes: Bytes, now_ms: number) {
        this.#exports = instantiated<Exports>(bytes);
        this.#unit = this.#exports.paced_begin(ns(now_ms));
        if (this.#unit === 0) {
            throw new Error("there is not memory enough for the virtual unit");
        }
    }

    /** Lets the unit come nearer to the time that it is; returns whether it is behind yet. */
    follow(now_ms: number): boolean {
        return this.#exports.paced_follow(this.#unit, ns(now_ms)) !== 0;
    }

    /** The unit's time stands from the request on until its asker waits for something else. */
    async ask(_: number, request: Bytes): Promise<Bytes> {
        const { memory, paced_request, paced_message, paced_answer } = this.#exports;
        new Uint8Array(memory.buffer, paced_request(this.#unit), request.length).set(request);
        const length = paced_message(this.#unit, request.length);
        return new Uint8Array(memory.buffer, paced_answer(this.#unit), length).slice();
    }

    setInput(input: number, level: 0 | 1): void {
        this.#exports.paced_set_input(this.#unit, input, level);
    }

    get now_s(): number {
        return seconds(this.#exports.paced_now_ns(this.#unit));
    }

    get stood_s(): number {
        return seconds(this.#exports.paced_stood_ns(this.#unit));
    }

    /** There is no line to it, and so nothing of what a line needs. */
    sessions(): number {
        return 0;
    }

    hurry(): void {}
}

import { File, OpenFile, WASI } from "@bjorn3/browser_wasi_shim";
import type { Bytes } from "./program_host";

/** What the module rkm04-unit exports; see tools/simulator/wasm/paced.h. */
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

const ns = (ms: number): bigint => BigInt(Math.round(ms * 1e6));
const seconds = (time_ns: bigint): number => Number(time_ns) / 1e9;

/** The firmware as a unit that runs: it follows the clock that its owner reads, and answers messages. */
export class UnitProgram {
    readonly #exports: Exports;
    readonly #unit: number;

    constructor(bytes: Bytes, now_ms: number) {
        const streams = [0, 1, 2].map(() => new OpenFile(new File([])));
        const wasi = new WASI(["rkm04-unit"], [], streams);
        const module = new WebAssembly.Module(bytes);
        const instance = new WebAssembly.Instance(module, { wasi_snapshot_preview1: wasi.wasiImport });
        wasi.initialize(instance as Parameters<WASI["initialize"]>[0]);
        this.#exports = instance.exports as unknown as Exports;
        this.#unit = this.#exports.paced_begin(ns(now_ms));
        if (this.#unit === 0) {
            throw new Error("there is not memory enough for the virtual unit");
        }
    }

    /** Lets the unit come nearer to the time that it is; returns whether it is behind yet. */
    follow(now_ms: number): boolean {
        return this.#exports.paced_follow(this.#unit, ns(now_ms)) !== 0;
    }

    ask(request: Bytes): Bytes {
        const { memory, paced_request, paced_message, paced_answer } = this.#exports;
        new Uint8Array(memory.buffer, paced_request(this.#unit), request.length).set(request);
        const length = paced_message(this.#unit, request.length);
        return new Uint8Array(memory.buffer, paced_answer(this.#unit), length).slice();
    }

    setInput(input: number, level: 0 | 1): void {
        this.#exports.paced_set_input(this.#unit, input, level);
    }

    /** The unit's time. */
    get now_s(): number {
        return seconds(this.#exports.paced_now_ns(this.#unit));
    }

    /** For how long in all its time has stood. */
    get stood_s(): number {
        return seconds(this.#exports.paced_stood_ns(this.#unit));
    }
}

import type { Bytes } from "../program_host";
import { instantiated, ns } from "../unit_module";

/** What the module of a unit exports, beside how it begins; see tools/unit_host/paced_line.h. */
interface Exports {
    memory: WebAssembly.Memory;
    paced_line_follow: (unit: number, real_ns: bigint) => number;
    paced_line_bytes: (unit: number) => number;
    paced_line_hear: (unit: number, count: number) => void;
    paced_line_said: (unit: number) => number;
    paced_line_take_said: (unit: number) => number;
    paced_line_set_input: (unit: number, input: number, level: number) => void;
    paced_line_stood_ns: (unit: number) => bigint;
}

type Begin = "gve_unit_begin" | "pos_unit_begin";

/** The firmware as a unit that runs beside the clock of its owner, and the bytes of its line. */
export class PacedUnit {
    readonly #exports: Exports;
    readonly #unit: number;

    constructor(bytes: Bytes, begin: Begin, now_ms: number) {
        const exports = instantiated<Exports & Record<Begin, (real_ns: bigint) => number>>(bytes);
        this.#exports = exports;
        this.#unit = exports[begin](ns(now_ms));
        if (this.#unit === 0) {
            throw new Error("there is not memory enough for the virtual unit");
        }
    }

    /** Lets the unit come nearer to the time that it is; returns whether it is behind yet. */
    follow(now_ms: number): boolean {
        return this.#exports.paced_line_follow(this.#unit, ns(now_ms)) !== 0;
    }

    /** What it has said since the last call. */
    takeSaid(): Bytes {
        const { memory, paced_line_said, paced_line_take_said } = this.#exports;
        const count = paced_line_take_said(this.#unit);
        return new Uint8Array(memory.buffer, paced_line_said(this.#unit), count).slice();
    }

    hear(data: Bytes): void {
        const { memory, paced_line_bytes, paced_line_hear } = this.#exports;
        new Uint8Array(memory.buffer, paced_line_bytes(this.#unit), data.length).set(data);
        paced_line_hear(this.#unit, data.length);
    }

    setInput(input: number, level: 0 | 1): void {
        this.#exports.paced_line_set_input(this.#unit, input, level);
    }

    /** For how long in all its time has stood, as nobody let it go on. */
    get stood_s(): number {
        return Number(this.#exports.paced_line_stood_ns(this.#unit)) / 1e9;
    }
}

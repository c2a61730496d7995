import { bytesOf } from "./answers";
import type { Command } from "./job_text";
import type { Positions } from "./told";

/** GVE_EXECUTED_UNKNOWN, as numbers of WebAssembly have it. */
const UNKNOWN = -1;

/** What the module gve134-unit exports of a job; see tools/lines/lines_gve134_executed.h. */
export interface ExecutedExports {
    memory: WebAssembly.Memory;
    lines_gve134_executed_begin: () => number;
    lines_gve134_executed_request: (line: number) => number;
    lines_gve134_executed_start: (line: number, x: number, y: number, z: number, a: number) => void;
    lines_gve134_executed_lose: (line: number) => void;
    lines_gve134_executed_take: (line: number, length: number) => void;
    lines_gve134_executed_stand: (line: number, x: number, y: number, z: number, a: number) => void;
    lines_gve134_executed_look: (line: number, length: number, x: number, y: number, z: number, a: number) => number;
    lines_gve134_executed_place: (line: number) => number;
}

/** Which of the vectors that the unit has taken are over, by where the axes are: tools/gve134_job/gve_executed.h. */
export class Executed {
    readonly #exports: ExecutedExports;
    readonly #line: number;

    constructor(exports: ExecutedExports) {
        this.#exports = exports;
        this.#line = exports.lines_gve134_executed_begin();
        if (this.#line === 0) {
            throw new Error("there is not memory enough for the line");
        }
    }

    /** A job begins; `place`: where its first vector does. */
    start([x = 0, y = 0, z = 0, a = 0]: Positions): void {
        this.#exports.lines_gve134_executed_start(this.#line, x, y, z, a);
    }

    /** From now on the number is not known. */
    lose(): void {
        this.#exports.lines_gve134_executed_lose(this.#line);
    }

    /** The unit has taken these. */
    taken(commands: Command[]): void {
        this.#exports.lines_gve134_executed_take(this.#line, this.#put(commands));
    }

    /** All that was taken is over, and the axes stand there. */
    stood([x = 0, y = 0, z = 0, a = 0]: Positions): void {
        this.#exports.lines_gve134_executed_stand(this.#line, x, y, z, a);
    }

    /** How many are over when the axes are there; `perhaps` these were taken, too. Null: it is not known. */
    look([x = 0, y = 0, z = 0, a = 0]: Positions, perhaps: Command[]): number | null {
        const over = this.#exports.lines_gve134_executed_look(this.#line, this.#put(perhaps), x, y, z, a);
        return over === UNKNOWN ? null : over;
    }

    /** Where the first vector begins that is not over. */
    get place(): Positions {
        return [...new Int32Array(this.#exports.memory.buffer, this.#exports.lines_gve134_executed_place(this.#line), 4)];
    }

    /** The length of their text; what the line has no room for is never under way. */
    #put(commands: Command[]): number {
        const bytes = bytesOf(commands.map(({ text }) => text)) ?? new Uint8Array();
        new Uint8Array(this.#exports.memory.buffer, this.#exports.lines_gve134_executed_request(this.#line)).set(bytes);
        return bytes.length;
    }
}

import type { FromService, UnitState } from "../protocol";
import { NOTHING_KNOWN, percentOf, type Known } from "./known";

const NO_UNIT = {
    connected: false, version: null, reference: false, error: null, away: false, restarted: false, wanted: null, job: null,
} as const;

/** What the page is told of connection and job; every change is told. */
export class DeskState {
    /** When the unit answered last. */
    heard_ms: number | null = null;
    readonly #tell: (told: FromService) => void;
    #known: Known = NOTHING_KNOWN;
    #now: UnitState = {
        ...NO_UNIT, port: null, virtual: false, busy: null, halt: null, seen_ago_s: null,
        known: { port: null, spindle: null, percent: null }, file: null, machine: null,
    };

    constructor(tell: (told: FromService) => void) {
        this.#tell = tell;
    }

    get now(): UnitState {
        return this.#now;
    }

    get known(): Known {
        return this.#known;
    }

    set known(known: Known) {
        this.#known = known;
        this.change({ known: { port: known.port, spindle: known.spindle, percent: percentOf(known) } });
    }

    change(changes: Partial<UnitState>): void {
        const before = JSON.stringify(this.#now);
        this.#now = { ...this.#now, ...changes };
        if (JSON.stringify(this.#now) !== before) {
            this.tell();
        }
    }

    /** There is no unit any more, or another one. */
    leave(changes: Partial<UnitState>): void {
        this.known = NOTHING_KNOWN;
        this.change({ ...NO_UNIT, ...changes });
    }

    tell(): void {
        const ago_s = this.heard_ms === null ? null : (performance.now() - this.heard_ms) / 1000;
        this.#tell({ type: "state", ...this.#now, seen_ago_s: ago_s });
    }
}

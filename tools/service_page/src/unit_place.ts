import type { Bytes } from "./program_host";
import type { Trouble } from "./protocol";

/** How an answer is waited for: longer than by tools/rkm04, as a page and its worker may be busy. */
export interface Wait {
    /** For the answer to begin. */
    patience_ms: number;
    attempts: number;
    /** Whether it must not be executed twice, so that it needs a session. */
    session: boolean;
    /** Whether a second answer is waited for. */
    scans?: true;
}

export const USUAL: Wait = { patience_ms: 400, attempts: 4, session: true };
export const STORING: Wait = { patience_ms: 2500, attempts: 3, session: true };
export const SCANNING: Wait = { patience_ms: 100, attempts: 2, session: true, scans: true };
export const OPENING: Wait = { patience_ms: 400, attempts: 2, session: true };
/** For what may be executed twice: questions, and K. */
export const LOOKING: Wait = { patience_ms: 400, attempts: 2, session: false };
export const AT_ONCE: Wait = { ...USUAL, session: false };
export const ONCE: Wait = { patience_ms: 400, attempts: 1, session: false };

export const BROADCAST = 0;
export const NODES_MAX = 16;

/** What the desk can be connected to: the unit in the page, or a line with units. One request at a time. */
export interface Place {
    readonly port: string;
    readonly isVirtual: boolean;
    /** Bytes of a text that go in one message. */
    readonly text_bytes_max: number;
    /** The time by which speeds are told. */
    readonly now_s: number;
    /** For how long in all the time of the unit has stood; null: it is not known to. */
    readonly stood_s: number | null;
    /** Whether the last scan has got two answers. */
    readonly isTwice: boolean;
    /** The number of the message that was written last: a request's own, or Version, which begins its session. */
    readonly written: number;
    /** The answer; of all units (node 0) it is empty. Fails with a LineTrouble. */
    ask(node: number, request: Bytes, wait: Wait): Promise<Bytes>;
    /** How many sessions were begun with a node: after another one it may be another unit. */
    sessions(node: number): number;
    /** Something else waits: what is under way is not repeated any more. */
    hurry(): void;
    setInput(input: number, level: 0 | 1): void;
}

/** It was not done; the trouble is why, and what to do. */
export class Refusal extends Error {
    readonly trouble: Trouble;

    constructor(cause: string, next: string, more: Partial<Trouble> = {}) {
        super(cause);
        this.trouble = { kind: "Failure", cause, next, ...more };
    }
}

/** There is no connection to a unit. */
export class LineTrouble extends Refusal {
    constructor(kind: string, cause: string, next: string) {
        super(cause, next, { kind });
    }
}

import type { FromService, UnitState } from "../protocol";

/** What a state has where no port is open. */
export const GONE = { connected: false, version: null, error: null, away: false, restarted: false, doubt: false } as const;

/** What the page is told of connection and unit; every change is told at once. */
export class Board {
    /** When the unit answered last. */
    heard_ms: number | null = null;
    readonly tell: (told: FromService) => void;
    #state: UnitState = { ...GONE, port: null, virtual: false, node: 1, busy: null, halt: null, unheld: [], seen_ago_s: null };

    constructor(tell: (told: FromService) => void) {
        this.tell = tell;
    }

    get state(): UnitState {
        return this.#state;
    }

    change(part: Partial<UnitState>): void {
        const before = JSON.stringify(this.#state);
        this.#state = { ...this.#state, ...part };
        if (JSON.stringify(this.#state) !== before) {
            this.tellState();
        }
    }

    tellState(): void {
        const seen_ago_s = this.heard_ms === null ? null : (performance.now() - this.heard_ms) / 1000;
        this.tell({ type: "state", ...this.#state, seen_ago_s });
    }
}

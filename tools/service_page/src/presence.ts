import { Cell } from "./signal";

const FRESH_MS = 1000;
const TICK_MS = 200;

/** What it takes of a state; a unit without a node has none in its looks either. */
interface Seen {
    connected: boolean;
    port: string | null;
    node?: number;
    /** Seconds since the unit answered last; null: it never has. */
    seen_ago_s: number | null;
}

/** Whether what the page knows of the unit is true now; if not, how long ago the unit was seen. */
export class Presence {
    /** Whether the unit has told its state within the last second. */
    readonly isFresh = new Cell(false);
    /** Whole seconds since the unit answered last; null: it never has, or is not to be asked. */
    readonly seconds = new Cell<number | null>(null);
    readonly #isOpen: Cell<boolean>;
    #state: Seen | null = null;
    #looked_ms = -Infinity;
    #seen_ms: number | null = null;

    /** `isOpen`: whether the service is there. */
    constructor(isOpen: Cell<boolean>) {
        this.#isOpen = isOpen;
        isOpen.onChange(() => this.#tick());
        window.setInterval(() => this.#tick(), TICK_MS);
    }

    /** The unit was looked at. */
    look(node?: number): void {
        if (this.#state?.connected && node === this.#state.node) {
            this.#looked_ms = this.#seen_ms = performance.now();
            this.#tick();
        }
    }

    setState(state: Seen): void {
        const before = this.#state;
        if (state.port !== before?.port || state.node !== before.node || !state.connected) {
            this.#looked_ms = -Infinity;
        }
        this.#state = state;
        this.#seen_ms = state.seen_ago_s === null ? null : performance.now() - 1000 * state.seen_ago_s;
        this.#tick();
    }

    #tick(): void {
        const now_ms = performance.now();
        const isFresh = this.#isOpen.value && now_ms - this.#looked_ms <= FRESH_MS;
        const seconds = this.#seen_ms === null ? null : Math.floor((now_ms - this.#seen_ms) / 1000);
        if (seconds !== this.seconds.value) {
            this.seconds.set(seconds);
        }
        if (isFresh !== this.isFresh.value) {
            this.isFresh.set(isFresh);
        }
    }
}

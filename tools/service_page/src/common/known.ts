/** What the pages of several units know of theirs. */
import { Pace } from "../pace";
import type { Presence } from "../presence";
import type { Port, Trouble } from "../protocol";
import { Cell } from "../signal";

export interface CommonState {
    connected: boolean;
    port: string | null;
    virtual: boolean;
    version: string | null;
    busy: string | null;
    error: Trouble | null;
    away: boolean;
    halt: "asked" | "failed" | null;
    restarted: boolean;
    seen_ago_s: number | null;
    node?: number;
}

export type Answer = { id: number | null; from: number | null; message: string } & (
    | { text: string; error: null }
    | { text: null; error: Trouble }
);

/** What a service says to the page of any unit. */
export type CommonFromService =
    | { type: "hello"; client?: number; beat: number }
    | { type: "beat"; beat: number }
    | { type: "ports"; ports: Port[] }
    | ({ type: "answer" } & Answer)
    | { type: "error"; error: Trouble };

export interface CommonLink {
    readonly isOpen: Cell<boolean>;
    readonly client: number | null;
    nextId(): number;
    send(message: { type: string }): boolean;
    onRefused(handler: (message: { type: string }) => void): void;
    /** Each of these kinds has its type here: Answer, CommonState, or one of CommonFromService. */
    on(kind: "answer" | "error" | "live" | "ports" | "state", handler: (message: any) => void): void;
}

/** What the parts that all pages have see of a unit. */
export interface Known {
    readonly link: CommonLink;
    readonly presence: Presence;
    readonly state: { readonly value: CommonState | null; onChange(show: () => void): void };
    /** Calls back at once and whenever anything changes. */
    watch(show: () => void): void;
    ask(type: "halt" | "seen"): boolean;
}

/** The state of a unit, and what was told within the last second. */
export class SeenUnit<Line extends CommonLink, State extends CommonState, Live> {
    readonly link: Line;
    readonly presence: Presence;
    readonly state = new Cell<State | null>(null);
    /** The last look, however old. */
    readonly last = new Cell<Live | null>(null);
    readonly #news = new Cell<Live | null>(null);
    readonly #looks = new Pace("time_s", "uptime", "frames");
    readonly #states = new Pace("seen_ago_s");

    constructor(link: Line, presence: Presence) {
        this.link = link;
        this.presence = presence;
        link.on("state", (state: State) => {
            const before = this.state.value;
            const isOther = state.port !== before?.port || state.node !== before?.node;
            if (isOther || (state.restarted && before?.restarted !== true)) {
                this.last.set(null);
            }
            if (this.#states.isDue(state)) {
                this.state.set(state);
            }
        });
        this.last.onChange((live) => {
            if (this.#looks.isDue(live)) {
                this.#news.set(live);
            }
        });
        link.isOpen.onChange((isOpen) => {
            if (!isOpen) {
                this.#states.isDue(null);
                this.state.set(null);
            }
        });
    }

    /** What is known now; null: it is not. */
    get now(): Live | null {
        return this.presence.isFresh.value ? this.last.value : null;
    }

    /** Calls back at once, at every change, and each second while there is none. */
    watch(show: () => void): void {
        this.state.watch(show);
        this.#news.onChange(show);
        this.presence.isFresh.onChange(show);
        this.presence.seconds.onChange(show);
    }
}

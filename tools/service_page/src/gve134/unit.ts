import { Link } from "../link";
import type { Presence } from "../presence";
import { Cell } from "../signal";
import { FLAG, type FromService, type Live, type ToService, type UnitState } from "./protocol";

export type UnitLink = Link<FromService, ToService>;

/** What a unit does, for words and colours. */
export type Doing = "unknown" | "reference" | "crystal" | "fault" | "rest" | "moves" | "brakes" | "waits" | "stopped";

/** What the page knows of the unit: its state, and what was told within the last second. */
export class Unit {
    readonly link: UnitLink;
    readonly presence: Presence;
    readonly state = new Cell<UnitState | null>(null);
    /** The last look, however old. */
    readonly last = new Cell<Live | null>(null);

    constructor(link: UnitLink, presence: Presence) {
        this.link = link;
        this.presence = presence;
        link.on("state", (state) => {
            const before = this.state.value;
            if (state.port !== before?.port || (state.restarted && !before.restarted)) {
                this.last.set(null);
            }
            this.state.set(state);
        });
        link.on("live", (live) => this.last.set(live));
        link.isOpen.onChange((isOpen) => {
            if (!isOpen) {
                this.state.set(null);
            }
        });
    }

    /** What is known now; null: it is not. */
    get now(): Live | null {
        return this.presence.isFresh.value ? this.last.value : null;
    }

    get doing(): Doing {
        const now = this.now;
        if (this.state.value?.reference && this.link.isOpen.value) {
            return "reference";
        }
        return now === null ? "unknown" : doingOf(now.flags);
    }

    /** Calls back at once and whenever anything changes. */
    watch(show: () => void): void {
        this.state.watch(show);
        this.last.onChange(show);
        this.presence.isFresh.onChange(show);
        this.presence.seconds.onChange(show);
    }

    /** Asks for something by a type that needs no more. */
    ask(type: "halt" | "go" | "delete" | "resume" | "seen"): boolean {
        return this.link.send({ type, id: this.link.nextId() });
    }
}

export function doingOf(flags: number): Doing {
    const has = (bit: number): boolean => (flags & bit) !== 0;
    if (has(FLAG.noCrystal)) {
        return "crystal";
    }
    if (has(FLAG.fault)) {
        return "fault";
    }
    if (has(FLAG.inta)) {
        return has(FLAG.run) ? "waits" : "stopped";
    }
    return has(FLAG.run) ? (has(FLAG.stop) ? "brakes" : "moves") : "rest";
}

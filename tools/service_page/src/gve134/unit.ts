import { SeenUnit } from "../common/known";
import type { Link } from "../link";
import type { Presence } from "../presence";
import { FLAG, type FromService, type Live, type ToService, type UnitState } from "./protocol";

export type UnitLink = Link<FromService, ToService>;

/** What a unit does, for words and colours. */
export type Doing = "unknown" | "reference" | "crystal" | "fault" | "rest" | "moves" | "brakes" | "waits" | "stopped";

/** What the page knows of the unit. */
export class Unit extends SeenUnit<UnitLink, UnitState, Live> {
    constructor(link: UnitLink, presence: Presence) {
        super(link, presence);
        link.on("live", (live) => this.last.set(live));
    }

    get doing(): Doing {
        const now = this.now;
        if (this.state.value?.reference && this.link.isOpen.value) {
            return "reference";
        }
        return now === null ? "unknown" : doingOf(now.flags);
    }

    /** Asks for something by a type that needs no more. */
    ask(type: "halt" | "go" | "delete" | "resume" | "seen"): boolean {
        return this.link.send({ type, id: this.link.nextId() });
    }
}

/** Whether the axes move. */
export const isInMotion = (flags: number): boolean => ["moves", "brakes"].includes(doingOf(flags));

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

import { AXES, INPUTS, type AxisLive, type Live } from "../protocol";
import { has, hasFault, type AxisState } from "./axis_state";
import { CLOCK_HALF, Restarted, type Unit } from "./client";
import { images } from "./table";

/** For so long an order of another master is told. */
const OTHERS_MS = 5000;
/** Requests of others a second: fewer may be one that was repeated. */
const OTHERS_LEAST = 0.5;
/** By which the unit's clock may be behind: a time, and a share of that from look to look. */
const SLACK_MS = 500;
const SLACK_SHARE = 0.01;
const CLOCK = 2 ** 32;
const WORD = 2 ** 16;
const MP = 1;
const INIC = 4;

/** CONTROL and FEED of an axis. */
export interface Wanted {
    control: number;
    feed: number;
}

/** Looks at a unit, and whether somebody else gives it orders. Nothing here changes anything there. */
export class Looks {
    unit: Record<string, number> | null = null;
    axes: AxisState[] = [];
    wanted: Wanted[] = [];
    readonly #own = new Set<number>();
    readonly #others_ms = new Map<number, number>();
    #frames: { frames: number; requests: number; at_ms: number } | null = null;
    #uptime: { uptime_ms: number; at_ms: number } | null = null;

    /** Something is asked of axes from here: what changes there is no one else's. */
    touch(axes: Iterable<number>): void {
        for (const axis of axes) {
            this.#own.add(axis);
        }
    }

    /** The clock is read last: a restart in the middle of a look is seen by it, or by the axes of the next look. */
    async look(unit: Unit, stood_s: number): Promise<Live> {
        await unit.requireKnown();
        const wanted = await readWanted(unit);
        const axes = await unit.axes();
        const state = await unit.read();
        const at_ms = performance.now();
        const others = this.#othersOf(state.frames ?? 0, unit.wire.requests, at_ms);
        if (this.#hasRestarted(state.uptime ?? 0, at_ms, axes)) {
            throw new Restarted(unit.wire.name);
        }
        this.#uptime = { uptime_ms: state.uptime ?? 0, at_ms };
        this.#compare(axes, wanted, at_ms);
        [this.unit, this.axes, this.wanted] = [state, axes, wanted];
        const inputs = INPUTS.map((input) => ((state.inputs ?? 0) >> (input - 1)) & 1);
        return {
            time_s: at_ms / 1000,
            unit: { ...state, stood_s, inputs, others } as unknown as Live["unit"],
            axes: axes.map((axis, index) => this.#live(axis, wanted[index] ?? { control: 0, feed: 0 })),
        };
    }

    #live(axis: AxisState, { control, feed }: Wanted): AxisLive {
        const waits = (control & INIC) !== 0 && has(axis, "JEDE");
        const byOther_ms = this.#others_ms.get(axis.axis) ?? -Infinity;
        return {
            ...axis, state: waits ? "WAITING" : axis.state, feed, permitted: (control & MP) !== 0,
            by_other: performance.now() - byOther_ms < OTHERS_MS,
        };
    }

    /**
     * Whether it has, since the last look: its clock went back, or is behind and the axes are as after a start. A clock that
     * is behind alone is that of a virtual unit, which may be slow.
     */
    #hasRestarted(uptime_ms: number, at_ms: number, axes: AxisState[]): boolean {
        if (this.#uptime === null) {
            return false;
        }
        const gone_ms = (uptime_ms - this.#uptime.uptime_ms + CLOCK) % CLOCK;
        if (gone_ms >= CLOCK_HALF) {
            return true;
        }
        const passed_ms = at_ms - this.#uptime.at_ms;
        const isBehind = gone_ms < passed_ms - Math.max(SLACK_MS, SLACK_SHARE * passed_ms);
        return isBehind && axes.every(isNew) && !this.axes.every(isNew);
    }

    /** Requests a second that the unit has got and that were not from here; null: it is not known yet. */
    #othersOf(frames: number, requests: number, at_ms: number): number | null {
        const before = this.#frames;
        this.#frames = { frames, requests, at_ms };
        if (before === null || requests < before.requests) {
            return null;
        }
        const more = ((frames - before.frames + CLOCK) % CLOCK) - (requests - before.requests);
        const rate = more / Math.max((at_ms - before.at_ms) / 1000, 0.01);
        return rate > OTHERS_LEAST && more < CLOCK_HALF ? Math.round(10 * rate) / 10 : 0;
    }

    /**
     * DONE, MP and FEED change by orders, or FEED by a fault: if not by an order from here, then by another's. A fault may
     * have come after the FEED of its first look was read.
     */
    #compare(axes: AxisState[], wanted: Wanted[], at_ms: number): void {
        this.axes.forEach((before, index) => {
            const [axis, old, now] = [axes[index], this.wanted[index], wanted[index]];
            if (axis === undefined || old === undefined || now === undefined || this.#own.has(axis.axis)) {
                return;
            }
            const isFault = hasFault(axis) && now.feed === 0;
            const isSame = before.done === axis.done && ((old.control ^ now.control) & MP) === 0 && (isFault || old.feed === now.feed);
            if (!isSame) {
                this.#others_ms.set(axis.axis, at_ms);
            }
        });
        this.#own.clear();
    }
}

async function readWanted(unit: Unit): Promise<Wanted[]> {
    const { first, words } = images.FAST_OUT;
    const found = await unit.wire.read(first, words * AXES.length);
    return AXES.map((_, index) => {
        const [control = 0, high = 0, low = 0] = found.slice(words * index);
        return { control, feed: high * WORD + low };
    });
}

/** Whether an axis is as after a start. */
const isNew = ({ status, done, position_steps, captures }: AxisState): boolean => [status, done, position_steps, captures].every((each) => each === 0);

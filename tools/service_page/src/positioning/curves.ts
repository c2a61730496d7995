import { Chart, type ChartData, type Range } from "../chart";
import { byId } from "../dom";
import { AXES, FEED_PER_MM_MIN, FLAG, STATUS, UM_PER_MM, type AxisLive, type Live } from "./protocol";
import { isUnderWay, type Unit } from "./unit";

const SHOWN_SECONDS = 30;
/** Looks further apart have no line between them. */
const GAP_SECONDS = 1.5;

type Quantity = (axis: AxisLive) => number | null;

/** The way that it goes, or will go: to the target, or as it went last. */
const sign = ({ status, way_left_um }: AxisLive): number => (way_left_um !== 0 ? Math.sign(way_left_um) : status & STATUS.SMER ? -1 : 1);

const made: Record<"speed" | "position", Quantity> = {
    speed: (axis) => ((axis.status & STATUS.SMER ? -1 : 1) * axis.speed) / FEED_PER_MM_MIN,
    position: ({ position_um }) => position_um / UM_PER_MM,
};

/** A feed without permission is no wish: the line is interrupted. */
const asked: Record<"speed" | "position", Quantity> = {
    speed: (axis) => (axis.permitted && isUnderWay(axis) ? (sign(axis) * axis.feed) / FEED_PER_MM_MIN : null),
    position: (axis) => (isUnderWay(axis) && (axis.flags & FLAG.HOMING) === 0 ? (axis.position_um + axis.way_left_um) / UM_PER_MM : null),
};

/** The last half minute: what was asked for, broad and pale, and what was made. */
export class Curves {
    readonly #unit: Unit;
    readonly #charts = (["speed", "position"] as const).map((quantity) => {
        const range = (): Range => [-SHOWN_SECONDS, 0];
        const chart = new Chart({ host: byId(`curve-${quantity}`, HTMLElement), quantity, group: "live", range, showsTime: true, isDouble: true });
        return { quantity, chart };
    });
    #samples: { time_s: number; axes: AxisLive[] }[] = [];
    #came_ms = 0;

    constructor(unit: Unit) {
        this.#unit = unit;
        unit.last.onChange((live) => this.#add(live));
        unit.watch(() => this.#show());
    }

    #add(live: Live | null): void {
        const before = this.#samples.at(-1)?.time_s;
        if (live === null || (before !== undefined && live.time_s < before)) {
            this.#samples = [];
        } else if (before !== undefined && live.time_s > before + GAP_SECONDS) {
            this.#samples.push({ time_s: before + 0.001, axes: [] });
        }
        if (live !== null) {
            this.#samples.push(live);
            this.#came_ms = performance.now();
        }
        while ((this.#samples[0]?.time_s ?? Infinity) < (live?.time_s ?? 0) - SHOWN_SECONDS) {
            this.#samples.shift();
        }
    }

    #show(): void {
        const now_s = (this.#samples.at(-1)?.time_s ?? 0) + (performance.now() - this.#came_ms) / 1000;
        const times = this.#samples.map(({ time_s }) => time_s - now_s);
        const line = (of: Quantity, index: number): (number | null)[] =>
            this.#samples.map(({ axes }) => (axes[index] === undefined ? null : of(axes[index])));
        for (const { quantity, chart } of this.#charts) {
            const lines = [asked[quantity], made[quantity]].flatMap((of) => AXES.map((_, index) => line(of, index)));
            chart.setData([times, ...lines] as ChartData);
        }
        byId("curves", HTMLElement).dataset.samples = String(this.#unit.now === null ? 0 : this.#samples.length);
    }
}

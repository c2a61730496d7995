import type { ChartData } from "./chart";
import { MOTORS, type Curve, type MotorCurve } from "./protocol";

export type Quantity = "speed" | "position";

/** Two points at one time are a jump; they are drawn this far apart, far below a pixel. */
const JUMP_SECONDS = 1e-9;

function increasing(times: number[]): number[] {
    let last = -Infinity;
    return times.map((time) => (last = time > last ? time : last + JUMP_SECONDS));
}

/** Value of a polyline at `x`, from the index of the last point that is not behind it; null outside. */
function between(xs: number[], ys: number[], index: number, x: number): number | null {
    const [x0, y0] = [xs[index], ys[index]];
    if (x0 === undefined || y0 === undefined) {
        return null;
    }
    const [x1, y1] = [xs[index + 1], ys[index + 1]];
    if (x1 === undefined || y1 === undefined) {
        return x === x0 ? y0 : null;
    }
    return y0 + ((y1 - y0) * (x - x0)) / (x1 - x0);
}

function onto(common: number[], xs: number[], ys: number[]): (number | null)[] {
    let index = -1;
    return common.map((x) => {
        while (index + 1 < xs.length && (xs[index + 1] ?? Infinity) <= x) {
            index += 1;
        }
        return between(xs, ys, index, x);
    });
}

/** The curves of all motors over the union of their times: exact, as all are polylines. */
export function toChartData(curve: Curve, quantity: Quantity, shown: ReadonlySet<number>): ChartData {
    const curves = MOTORS.map((motor) => (shown.has(motor) ? curve.motors[motor] : undefined));
    const times = curves.map((one) => (one ? increasing(one.t) : []));
    const common = [...new Set(times.flat())].sort((a, b) => a - b);
    return [common, ...curves.map((one, i) => onto(common, times[i] ?? [], one?.[quantity] ?? []))];
}

/** Speed and position of a motor at a time; null where it has not begun. */
export function valueAt(curve: MotorCurve, quantity: Quantity, seconds: number): number | null {
    const { t } = curve;
    let [low, high] = [-1, t.length];
    while (high - low > 1) {
        const middle = (low + high) >> 1;
        if ((t[middle] ?? Infinity) <= seconds) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return between(t, curve[quantity], low, seconds);
}

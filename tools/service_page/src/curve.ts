import type { ChartData, Range } from "./chart";
import { MOTORS, type Curve, type MotorCurve } from "./protocol";

export type Quantity = "speed" | "position";

/** Two points at one time are a jump; they are drawn this far apart, far below a pixel. */
const JUMP_SECONDS = 1e-9;

interface Line {
    xs: number[];
    ys: number[];
}

function increasing(times: number[]): number[] {
    let last = -Infinity;
    return times.map((time) => (last = time > last ? time : last + JUMP_SECONDS));
}

/** A position that changes with each pulse and stays between them. */
function stairs({ t, before }: MotorCurve, steps: [seconds: number, position: number][]): Line {
    const first = Math.min(t[0] ?? 0, steps[0]?.[0] ?? Infinity);
    const line: Line = { xs: [first], ys: [before] };
    let last = before;
    for (const [seconds, position] of steps) {
        line.xs.push(seconds, seconds);
        line.ys.push(last, position);
        last = position;
    }
    line.xs.push(t.at(-1) ?? first);
    line.ys.push(last);
    return line;
}

/** The single pulses where they are known, else lines between points. */
function positions(one: MotorCurve): Line {
    if (one.steps) {
        return stairs(one, one.steps);
    }
    // A position that is overwritten at the very beginning would only stretch the axis.
    const first = Math.max(one.t.findIndex((time) => time !== one.t[0]) - 1, 0);
    return { xs: one.t.slice(first), ys: one.position.slice(first) };
}

function lineOf(one: MotorCurve, quantity: Quantity): Line {
    const { xs, ys } = quantity === "position" ? positions(one) : { xs: one.t, ys: one.speed };
    return { xs: increasing(xs), ys };
}

/** Value of a polyline at `x`, from the index of the last point that is not after it; null outside. */
function between({ xs, ys }: Line, index: number, x: number): number | null {
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

function onto(common: number[], line: Line): (number | null)[] {
    let index = -1;
    return common.map((x) => {
        while (index + 1 < line.xs.length && (line.xs[index + 1] ?? Infinity) <= x) {
            index += 1;
        }
        return between(line, index, x);
    });
}

/** The curves of all motors over the union of their times: exact, as all are polylines. */
export function toChartData(curve: Curve, quantity: Quantity, shown: ReadonlySet<number>): ChartData {
    const lines = MOTORS.map((motor) => {
        const one = shown.has(motor) ? curve.motors[motor] : undefined;
        return one ? lineOf(one, quantity) : { xs: [], ys: [] };
    });
    const common = [...new Set(lines.flatMap(({ xs }) => xs))].sort((a, b) => a - b);
    return [common, ...lines.map((line) => onto(common, line))];
}

/** Index of the last of increasing numbers that is not above `x`; -1 if there is none. */
function lastUpTo(xs: number[], x: number): number {
    let [low, high] = [-1, xs.length];
    while (high - low > 1) {
        const middle = (low + high) >> 1;
        if ((xs[middle] ?? Infinity) <= x) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/** Speed and position of a motor at a time; null where it has not begun. */
export function valueAt(curve: MotorCurve, quantity: Quantity, seconds: number): number | null {
    const line = lineOf(curve, quantity);
    return between(line, lastUpTo(line.xs, seconds), seconds);
}

/** How many single pulses of all motors are drawn in a part of the time. */
export function singleSteps(curve: Curve, [from, to]: Range): number {
    const steps = Object.values(curve.motors).flatMap((one) => one.steps ?? []);
    return steps.filter(([seconds]) => from <= seconds && seconds <= to).length;
}

/** Least and greatest value that is seen between two x, at the edges too; null if there is none. */
export function extent([xs, ...lines]: ChartData, [from, to]: Range): Range | null {
    const [first, last] = [lastUpTo(xs, from), lastUpTo(xs, to)];
    const seen = lines.flatMap((ys) => [
        ...ys.slice(first + 1, last + 1),
        atEdge(xs, ys, first, from),
        atEdge(xs, ys, last, to),
    ]);
    const values = seen.filter((value) => value !== null);
    const least = values.reduce((a, b) => Math.min(a, b), Infinity);
    const most = values.reduce((a, b) => Math.max(a, b), -Infinity);
    return least > most ? null : [least, most];
}

/** The value of one of several lines at an edge of what is seen. */
function atEdge(xs: number[], ys: (number | null)[], index: number, x: number): number | null {
    const pair = [ys[index], ys[index + 1]];
    if (pair[0] == null || pair[1] == null) {
        return null;
    }
    return between({ xs: xs.slice(index, index + 2), ys: [pair[0], pair[1]] }, 0, x);
}

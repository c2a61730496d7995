import { isVector, stepsOf, type Command } from "./job_text";
import type { Positions } from "./told";

/** Of the queue; a vector without a way takes none. */
const PLACES = 128;
/** What drops vectors, or puts others in their place. */
const LOSES_TRACK = ["D", "K", "R", "J", "!7J"];
const AXES = "XYZA";

/** Which of the vectors that the unit has taken are over, by where the axes are. */
export class Executed {
    /** So many are over; null: it is not known any more. */
    done: number | null = 0;
    /** Where the first vector begins that is not over. */
    place: Positions;
    readonly #waiting: number[][] = [];
    /** Pulses of all axes that were seen of the first of them. */
    #gone = 0;
    #places = 0;
    /** The axes that the job has moved; of a coupled A the positions are those of another. */
    readonly #moved = [false, false, false, false];

    /** `place`: where the first vector begins. */
    constructor(place: Positions) {
        this.place = [...place];
    }

    /** The unit has taken these. */
    taken(commands: Command[]): void {
        for (const command of commands) {
            if (isVector(command)) {
                if (command.letter === "L") {
                    this.#pass(this.#waiting.length);
                }
                this.#append(stepsOf(command));
            } else if (command.letter === "N") {
                this.#countAnew(command.text.slice(1));
            } else if (command.letter === "W" || LOSES_TRACK.includes(command.text)) {
                this.done = null;
            }
        }
    }

    /** All that was taken is over, and the axes stand there. */
    stood(place: Positions): void {
        this.#pass(this.#waiting.length);
        this.place = [...place];
    }

    /** How many are over when the axes are there; `perhaps` these were taken, too. */
    look(place: Positions, perhaps: Command[]): number | null {
        let at = this.place;
        const known = this.#waiting.length;
        const ahead = [...this.#waiting, ...perhaps.filter(isVector).map(stepsOf)];
        for (const [number, steps] of ahead.entries()) {
            const ways = at.map((from, axis) => (this.#moved[axis] === true ? ((place[axis] ?? 0) - from) | 0 : 0));
            const gone = ways.reduce((sum, way) => sum + Math.abs(way), 0);
            if (isOn(steps, ways) && (number > 0 || gone >= this.#gone)) {
                const over = number + (ways.every((way, axis) => way === steps[axis]) ? 1 : 0);
                this.#pass(Math.min(over, known));
                this.#gone = over === number && number < known ? gone : 0;
                return this.done === null ? null : this.done + Math.max(0, over - known);
            }
            at = at.map((from, axis) => from + (steps[axis] ?? 0));
        }
        return this.done;
    }

    #append(steps: number[]): void {
        this.#waiting.push(steps);
        this.#places += steps.some((each) => each !== 0) ? 1 : 0;
        steps.forEach((each, axis) => (this.#moved[axis] ||= each !== 0));
        while (this.#places > PLACES) {
            this.#pass(1);
        }
    }

    #pass(count: number): void {
        this.#gone = count > 0 ? 0 : this.#gone;
        for (const steps of this.#waiting.splice(0, count)) {
            this.#places -= steps.some((each) => each !== 0) ? 1 : 0;
            this.place = this.place.map((from, axis) => from + (steps[axis] ?? 0));
            this.done = this.done === null ? null : this.done + 1;
        }
    }

    #countAnew(parameters: string): void {
        this.#pass(this.#waiting.length);
        const axis = AXES.indexOf(parameters[0] ?? " ");
        const written = Number(parameters.slice(1).replace(/^,/, ""));
        this.place = this.place.map((at, each) => (parameters === "" ? 0 : each === axis ? written : at));
    }
}

/**
 * Whether the axes come by a place on a vector, given from where that begins: axis j makes its pulse k when the path has
 * come to the part k / |d_j| of the vector. Parts are compared as whole numbers, as those of long vectors lie close.
 */
function isOn(steps: number[], ways: number[]): boolean {
    let begin: [bigint, bigint] = [0n, 1n];
    let end: [bigint, bigint] = [2n, 1n];
    for (const [axis, step] of steps.entries()) {
        const way = ways[axis] ?? 0;
        if (Math.sign(step) * Math.sign(way) < 0 || Math.abs(way) > Math.abs(step)) {
            return false;
        }
        if (step !== 0) {
            const [from, whole] = [BigInt(Math.abs(way)), BigInt(Math.abs(step))];
            begin = isLess(begin, [from, whole]) ? [from, whole] : begin;
            end = isLess([from + 1n, whole], end) ? [from + 1n, whole] : end;
        }
    }
    return isLess(begin, end);
}

const isLess = ([a, b]: [bigint, bigint], [c, d]: [bigint, bigint]): boolean => a * d < c * b;

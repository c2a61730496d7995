import type { Range } from "./chart";

const STEP = 1.25;
/** At 16 000 steps/s, eight pulses. */
const NARROWEST_SECONDS = 0.0005;

/** Which part of the whole is seen. */
export class Zoom {
    #whole: Range = [0, 1];
    #part: Range | null = null;
    readonly #onChange: () => void;

    constructor(onChange: () => void) {
        this.#onChange = onChange;
    }

    get range(): Range {
        return this.#part ?? this.#whole;
    }

    get part(): Range | null {
        return this.#part;
    }

    /** The whole changes as the program does; a part that lies outside of it is left. */
    setWhole(seconds: number): void {
        this.#whole = [0, Math.max(seconds, NARROWEST_SECONDS)];
        if (this.#part !== null && this.#part[0] >= this.#whole[1]) {
            this.#part = null;
        }
    }

    /** Forgets the part; nothing is drawn yet. */
    leave(): void {
        this.#part = null;
    }

    reset(): void {
        this.leave();
        this.#onChange();
    }

    show([from, to]: Range): void {
        const [start, end] = this.#whole;
        const middle = (from + to) / 2;
        const half = Math.max(to - from, NARROWEST_SECONDS) / 2;
        const part: Range = [Math.max(middle - half, start), Math.min(middle + half, end)];
        this.#part = part[0] <= start && part[1] >= end ? null : part;
        this.#onChange();
    }

    /** Makes the part narrower (steps > 0) or wider, around a point that stays where it is. */
    by(steps: number, centre?: number): void {
        const [from, to] = this.range;
        const fixed = centre ?? (from + to) / 2;
        const factor = STEP ** -steps;
        this.show([fixed - (fixed - from) * factor, fixed + (to - fixed) * factor]);
    }
}

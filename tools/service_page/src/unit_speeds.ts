/** Looks that are further apart tell no speed. */
const PAUSE_SECONDS = 2;
/** Steps/s, with a margin; what is faster is a position that was written. */
const POSSIBLE = 20_000;

/** Speeds from positions: the mean from one look to the next. */
export class Speeds {
    #before: { seconds: number; positions: number[] } | null = null;
    #last: (number | null)[] = [];

    /** Steps/s at a look; null where they are not known, as at the first one. */
    of(seconds: number, positions: number[]): (number | null)[] {
        const before = this.#before;
        const passed = before === null ? 0 : seconds - before.seconds;
        if (before !== null && passed === 0) {
            return this.#last;
        }
        this.#before = { seconds, positions };
        this.#last = positions.map((position, index) => {
            const speed = (position - (before?.positions[index] ?? 0)) / passed;
            const isKnown = passed > 0 && passed < PAUSE_SECONDS && Math.abs(speed) <= POSSIBLE;
            return isKnown ? Math.round(10 * speed) / 10 : null;
        });
        return this.#last;
    }
}

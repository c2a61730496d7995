const BEAT_MS = 500;
/** What the page asks for with an older sign of life is refused: nobody expects it any more. */
const LATE_MS = 2000;
const BEATS_MAX = 64;

/** The signs of life that the page gets, and how old each of them is. */
export class Beats {
    readonly #given = new Map<number, number>();
    #last = 0;
    #due_ms = 0;

    isDue(now_ms: number): boolean {
        return now_ms >= this.#due_ms;
    }

    next(now_ms: number): number {
        this.#last += 1;
        this.#given.set(this.#last, now_ms);
        this.#given.delete(this.#last - BEATS_MAX);
        this.#due_ms = now_ms + BEAT_MS;
        return this.#last;
    }

    /** Whether what carries this sign of life comes too late; what carries none does not. */
    isLate(beat: number | undefined, now_ms: number): boolean {
        return beat !== undefined && now_ms - (this.#given.get(beat) ?? -Infinity) > LATE_MS;
    }
}

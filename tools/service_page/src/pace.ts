const STILL_MS = 1000;

/** When what is known is shown anew: at once after a change, else each second, which spares batteries. */
export class Pace {
    readonly #steady: Set<string>;
    #last = "";
    #shown_ms = -Infinity;

    /** `steady`: names of what goes on by itself, such as clocks, which is no change. */
    constructor(...steady: string[]) {
        this.#steady = new Set(steady);
    }

    isDue(known: unknown): boolean {
        const text = JSON.stringify(known, (name, value: unknown) => (this.#steady.has(name) ? null : value));
        const now_ms = performance.now();
        if (text === this.#last && now_ms - this.#shown_ms < STILL_MS) {
            return false;
        }
        [this.#last, this.#shown_ms] = [text, now_ms];
        return true;
    }
}

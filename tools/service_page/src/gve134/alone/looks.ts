import { DONE } from "./answers";
import type { UnitLink } from "./link";
import { INTA, INTERRUPTS, causesOf, type Positions } from "./told";

/** Looks that are further apart tell no speed. */
const PAUSE_S = 2;
/** Pulses/s, with a margin for the time of a look; what is faster is a position that was written. */
const POSSIBLE = 250_000;
/** From one question for late pulses to the next. */
const SELDOM_MS = 2000;
/** Of the way made; of a longer one every other place is left out. */
const PLACES_MAX = 20_000;

export interface Seen {
    time_s: number;
    positions: Positions;
    speeds: (number | null)[];
    flags: number;
    inputs: number[];
    causes: string[];
    late: number | null;
}

/** What the unit does, as the line tells it. Nothing here changes anything there. */
export class Looks {
    flags: number | null = null;
    #causes: string[] = [];
    #late: number | null = null;
    #inputs: number[] | null = null;
    #seldom_due_ms = 0;
    #before: { at_s: number; positions: Positions } | null = null;

    /**
     * Asks for state and positions, and less often for what seldom changes. In this order, so that axes which stand by
     * their flags are at these positions.
     */
    async look(link: UnitLink, isWithInputs: boolean): Promise<Seen> {
        const flags = await link.byte("F");
        const positions = await link.positions();
        const now_ms = performance.now();
        if (isWithInputs || this.#inputs === null) {
            const bits = (await link.byte("I1")) | ((await link.byte("I2")) << 8);
            this.#inputs = INTERRUPTS.map(([number]) => (bits >> number) & 1);
        }
        if ((flags & INTA) === 0) {
            this.#causes = [];
        } else if (this.#causes.length === 0) {
            this.#causes = await causesOf(link, flags);
        }
        if (isWithInputs && now_ms >= this.#seldom_due_ms) {
            this.#seldom_due_ms = now_ms + SELDOM_MS;
            const late = await link.ask("SR7");
            this.#late = late.code === DONE ? parseInt(late.values, 16) : null;
        }
        this.flags = flags;
        const speeds = this.#speeds(now_ms / 1000, positions);
        return { time_s: now_ms / 1000, positions, speeds, flags, inputs: this.#inputs, causes: this.#causes, late: this.#late };
    }

    /** The mean from one look to the next. */
    #speeds(at_s: number, positions: Positions): (number | null)[] {
        const before = this.#before;
        this.#before = { at_s, positions };
        const passed_s = before === null ? 0 : at_s - before.at_s;
        return positions.map((at, axis) => {
            const speed = (at - (before?.positions[axis] ?? 0)) / passed_s;
            return passed_s > 0 && passed_s < PAUSE_S && Math.abs(speed) <= POSSIBLE ? Math.round(10 * speed) / 10 : null;
        });
    }
}

/** The way that the axes have made, as far as it was seen. */
export class Made {
    #places: Positions[] = [];

    clear(): void {
        this.#places = [];
    }

    /** Goes on by corners that were passed to a place; those that are new. */
    go(corners: Positions[], at: Positions): Positions[] {
        const found = [...corners, at];
        if (found.length === 1 && this.#places[this.#places.length - 1]?.join() === at.join()) {
            return [];
        }
        this.#places.push(...found);
        if (this.#places.length > PLACES_MAX) {
            this.#places = this.#places.filter((_, number) => number % 2 === 0);
        }
        return found;
    }

    /** All of it; only X, Y, Z are drawn. */
    get told(): { type: "made"; places: Positions[] } {
        return { type: "made", places: this.#places.map((place) => place.slice(0, 3)) };
    }
}

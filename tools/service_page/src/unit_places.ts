import * as messages from "./unit_messages";
import { LOOKING } from "./unit_place";
import type { Ask } from "./unit_view";

/** For so long a place is told after it was asked for. */
const TOLD_MS = 1000;

/** Where the programs are, one motor asked for in each look: four would slow down the rest. */
export class Places {
    #seen = new Map<number, { at_ms: number; place: number }>();

    /** Asks that of these motors that was asked longest ago; the others run no command. */
    async look(running: number[], ask: Ask): Promise<void> {
        this.#seen = new Map([...this.#seen].filter(([motor]) => running.includes(motor)));
        const asked_ms = (motor: number): number => this.#seen.get(motor)?.at_ms ?? -Infinity;
        const motor = running.reduce((best, each) => (asked_ms(each) < asked_ms(best) ? each : best), running[0] ?? 0);
        if (motor === 0) {
            return;
        }
        try {
            const answer = await ask(messages.request(messages.GET_PROGRESS, motor), LOOKING);
            this.#seen.set(motor, { at_ms: performance.now(), place: messages.progress(answer, motor).command });
        } catch (error) {
            if (!(error instanceof messages.UnknownMessage)) {
                throw error;
            }
        }
    }

    /** The ordinal of the command that is being run; null: not known, or there is none. */
    of(motor: number): number | null {
        const seen = this.#seen.get(motor);
        return seen === undefined || performance.now() - seen.at_ms > TOLD_MS ? null : seen.place || null;
    }
}

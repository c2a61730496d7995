import type { Bytes } from "./program_host";
import type { ToService } from "./protocol";
import type { Simulator } from "./simulator";
import { UnitDesk } from "./unit_desk";
import { GREETING } from "./unit_line";
import type { StatusNames } from "./unit_messages";
import { UnitOrders } from "./unit_orders";
import { UnitProgram } from "./unit_program";

const STEP_MS = 8;
/** So long the unit may catch up before the page is heard again. */
const BUSY_MS = 5;

/** Runs the unit beside the clock of the worker, and hears the page in between. A fault of it ends it for good. */
export class UnitRunner {
    readonly #unit: UnitProgram;
    readonly #desk: UnitDesk;
    readonly #timer: number;
    #isOver = false;

    constructor(bytes: Bytes, simulator: Simulator, names: StatusNames, say: (text: string) => void) {
        const unit = new UnitProgram(bytes, performance.now());
        const orders = new UnitOrders((request) => unit.ask(request), simulator, names);
        this.#unit = unit;
        this.#desk = new UnitDesk(unit, orders, (told) => say(JSON.stringify(told)));
        this.#timer = self.setInterval(() => this.#step(() => undefined), STEP_MS);
    }

    hear(text: string): void {
        this.#step((now_ms) =>
            text === GREETING ? this.#desk.greet(now_ms) : this.#desk.obey(JSON.parse(text) as ToService, now_ms),
        );
    }

    #step(work: (now_ms: number) => void): void {
        if (this.#isOver) {
            return;
        }
        try {
            const spent_ms = this.#follow();
            const now_ms = performance.now();
            work(now_ms);
            this.#desk.tick(now_ms, spent_ms);
        } catch (error) {
            this.#isOver = true;
            self.clearInterval(this.#timer);
            throw error;
        }
    }

    /** Brings the unit to the time that it is; returns what that took. */
    #follow(): number {
        const begin_ms = performance.now();
        let now_ms = begin_ms;
        while (this.#unit.follow(now_ms) && now_ms - begin_ms < BUSY_MS) {
            now_ms = performance.now();
        }
        return performance.now() - begin_ms;
    }
}

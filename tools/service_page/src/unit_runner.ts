import type { Bytes } from "./program_host";
import { GREETING } from "./protocol";
import { SerialLine, broadcastFrame } from "./serial_line";
import type { Simulator } from "./simulator";
import type { Asked } from "./unit_answer";
import { UnitDesk } from "./unit_desk";
import type { StatusNames } from "./unit_messages";
import { LineTrouble } from "./unit_place";
import { UnitProgram } from "./unit_program";
import { STOP } from "./unit_stop";

const STEP_MS = 8;
/** So long the unit may catch up before the page is heard again. */
const BUSY_MS = 5;

/** What the page tells of the serial port that it has opened. */
export type PortNews =
    | { kind: "opened"; port: string; baud: number }
    | { kind: "heard"; data: Bytes }
    | { kind: "lost"; cause: string; next: string };

/**
 * What is to be done with that port; all else that is said to the page is text. `lastWords` are what it writes itself if
 * it is closed while a button is held.
 */
export type PortOrder = { kind: "write" | "lastWords"; data: Bytes } | { kind: "close" };

/**
 * Runs the unit beside the clock of the worker, and the line of a serial port, and hears the page in between. A fault of
 * it ends it for good.
 */
export class UnitRunner {
    readonly #bytes: Bytes;
    readonly #unit: UnitProgram;
    readonly #desk: UnitDesk;
    readonly #order: (order: PortOrder) => void;
    readonly #timer: number;
    #line: SerialLine | null = null;
    #isOver = false;

    constructor(
        bytes: Bytes, simulator: Simulator, names: StatusNames, say: (said: string | PortOrder) => void,
    ) {
        this.#bytes = bytes;
        this.#order = say;
        this.#unit = new UnitProgram(bytes, performance.now());
        this.#desk = new UnitDesk(this.#unit, simulator, names, {
            tell: (told) => say(JSON.stringify(told)),
            close: () => this.#closePort(),
            fail: (error) => this.#end(error),
        });
        this.#timer = self.setInterval(() => this.#step(() => undefined), STEP_MS);
    }

    hear(text: string): void {
        this.#step((now_ms) =>
            text === GREETING ? this.#desk.greet(now_ms) : this.#desk.obey(JSON.parse(text) as Asked, now_ms),
        );
    }

    hearOfPort(news: PortNews): void {
        this.#step(() => this.#noteNews(news));
    }

    #noteNews(news: PortNews): void {
        if (news.kind === "opened") {
            const write = (data: Bytes): void => this.#order({ kind: "write", data });
            this.#line = new SerialLine(this.#bytes, news.port, news.baud, write);
            this.#desk.offer(this.#line);
            this.#order({ kind: "lastWords", data: broadcastFrame(this.#bytes, news.baud, STOP) });
        } else if (news.kind === "heard") {
            this.#line?.hear(news.data);
        } else if (this.#line !== null) {
            const [line, why] = [this.#line, new LineTrouble("PortLost", news.cause, news.next)];
            this.#line = null;
            this.#desk.lose(line, why);
            line.lose(why);
        }
    }

    #closePort(): void {
        this.#line = null;
        this.#order({ kind: "close" });
    }

    #step(work: (now_ms: number) => void): void {
        if (this.#isOver) {
            return;
        }
        try {
            const spent_ms = this.#follow();
            const now_ms = performance.now();
            work(now_ms);
            this.#line?.tick();
            this.#desk.tick(now_ms, spent_ms);
        } catch (error) {
            this.#end(error);
        }
    }

    /** An error that nobody catches tells the page. */
    #end(error: unknown): void {
        this.#isOver = true;
        self.clearInterval(this.#timer);
        self.setTimeout(() => {
            throw error;
        });
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

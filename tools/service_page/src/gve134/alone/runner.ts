import type { Bytes } from "../../program_host";
import { GREETING } from "../../protocol";
import { LineTrouble } from "../../unit_place";
import type { PortNews, PortOrder } from "../../unit_runner";
import { UnitDesk, type Asked } from "./desk";
import type { Opened } from "./file";
import type { Mill } from "./mill";
import { VirtualUnit } from "./virtual_port";
import type { BytePort } from "./wire";

const STEP_MS = 4;
/** So long the unit may catch up before the page is heard again. */
const BUSY_MS = 5;

/** Runs the unit beside the clock of the worker, and the desk before it. A fault of it ends it for good. */
export class UnitRunner {
    readonly #virtual: VirtualUnit;
    readonly #desk: UnitDesk;
    readonly #order: (order: PortOrder) => void;
    readonly #fail: (error: unknown) => void;
    readonly #timer: number;
    #port: BytePort | null = null;

    constructor(bytes: Bytes, say: (said: string | PortOrder) => void, fail: (error: unknown) => void) {
        this.#order = say;
        this.#fail = fail;
        this.#virtual = new VirtualUnit(bytes, performance.now());
        this.#desk = new UnitDesk(bytes, this.#virtual, {
            tell: (told) => say(JSON.stringify(told)),
            close: () => this.#closePort(),
            fail: (error) => this.#end(error),
        });
        this.#timer = self.setInterval(() => this.#step(), STEP_MS);
    }

    hear(text: string): void {
        const now_ms = performance.now();
        if (text === GREETING) {
            this.#desk.greet(now_ms);
        } else {
            this.#desk.obey(JSON.parse(text) as Asked, now_ms);
        }
    }

    open(file: Opened): void {
        this.#desk.open(file);
    }

    take(mill: Mill): void {
        this.#desk.take(mill);
    }

    hearOfPort(news: PortNews): void {
        if (news.kind === "opened") {
            const write = (data: Bytes): void => this.#order({ kind: "write", data });
            this.#port = { name: news.port, isVirtual: false, baud: news.baud, write };
            this.#desk.offer(this.#port);
        } else if (this.#port !== null && news.kind === "heard") {
            this.#desk.hear(this.#port, news.data);
        } else if (this.#port !== null && news.kind === "lost") {
            this.#desk.lose(this.#port, new LineTrouble("PortLost", news.cause, news.next));
            this.#port = null;
        }
    }

    #closePort(): void {
        if (this.#port !== null) {
            this.#port = null;
            this.#order({ kind: "close" });
        }
    }

    #step(): void {
        try {
            const begin_ms = performance.now();
            let now_ms = begin_ms;
            while (this.#virtual.follow(now_ms) && now_ms - begin_ms < BUSY_MS) {
                now_ms = performance.now();
            }
            const said = this.#virtual.takeSaid();
            if (said.length > 0) {
                this.#desk.hear(this.#virtual, said);
            }
            this.#desk.tick(performance.now());
        } catch (error) {
            this.#end(error);
        }
    }

    #end(error: unknown): void {
        self.clearInterval(this.#timer);
        this.#fail(error);
    }
}

import type { Bytes } from "../../program_host";
import { GREETING } from "../../protocol";
import { unpacked } from "../../unpack";
import type { PortNews, PortOrder } from "../../unit_runner";
import type { Names } from "./axis_state";
import { PortTrouble, SerialBus } from "./bus";
import { Desk, type Asked } from "./desk";
import { Master } from "./master";
import { Player, type Played, type Script } from "./player";
import { VirtualBus } from "./virtual_bus";

/**
 * What the page says to its worker: first the unit, then texts for the desk, and what a serial port does. Another worker
 * gets the program that plays scripts, and then scripts, each answered under its number.
 */
export type Order =
    | { kind: "unit"; bytes: Bytes; names: Names }
    | { kind: "program"; bytes: Bytes }
    | { kind: "play"; id: number; script: Script }
    | PortNews
    | string;

export type PlayerTold = { id: number; played: Played } | { id: number; trouble: string };

const STEP_MS = 5;
/** So long the unit may catch up before the page is heard again. */
const BUSY_MS = 5;

/** Runs the unit beside the clock of the worker, and the desk before it. A fault of it ends it for good. */
class Runner {
    readonly #bytes: Bytes;
    readonly #virtual: VirtualBus;
    readonly #desk: Desk;
    readonly #say: (said: string | PortOrder) => void;
    #bus: SerialBus | null = null;

    constructor(bytes: Bytes, names: Names, say: (said: string | PortOrder) => void) {
        this.#bytes = bytes;
        this.#say = say;
        this.#virtual = new VirtualBus(bytes, performance.now());
        this.#desk = new Desk(this.#virtual, names, (told) => say(JSON.stringify(told)), fail);
        self.setInterval(() => this.#step(), STEP_MS);
    }

    hear(text: string): void {
        const now_ms = performance.now();
        if (text === GREETING) {
            this.#desk.greet(now_ms);
        } else {
            this.#desk.obey(JSON.parse(text) as Asked, now_ms);
        }
    }

    hearOfPort(news: PortNews): void {
        if (news.kind === "opened") {
            const write = (data: Bytes): void => this.#say({ kind: "write", data });
            this.#bus = new SerialBus(news.port, new Master(this.#bytes, news.baud), write, (bus) => this.#close(bus));
            this.#desk.offer(this.#bus);
        } else if (news.kind === "heard") {
            this.#bus?.hear(news.data);
        } else {
            this.#bus?.lose(new PortTrouble("PortLost", news.cause, news.next));
        }
    }

    #close(bus: SerialBus): void {
        if (this.#bus === bus) {
            this.#bus = null;
            this.#say({ kind: "close" });
        }
    }

    #step(): void {
        const begin_ms = performance.now();
        let now_ms = begin_ms;
        while (this.#virtual.follow(now_ms) && now_ms - begin_ms < BUSY_MS) {
            now_ms = performance.now();
        }
        this.#desk.tick(performance.now());
    }
}

/** An error that nobody catches tells the page. */
function fail(error: unknown): void {
    self.setTimeout(() => {
        throw error;
    });
}

let runner: Runner | null = null;
let player: Player | null = null;

function played(id: number, script: Script): PlayerTold {
    try {
        if (player === null) {
            throw new Error("the program that plays scripts is not there");
        }
        return { id, played: player.play(script) };
    } catch (error) {
        return { id, trouble: error instanceof Error ? error.message.replace(/^\//, "") : String(error) };
    }
}

async function take(order: Order): Promise<void> {
    if (typeof order === "string") {
        runner?.hear(order);
    } else if (order.kind === "unit") {
        runner = new Runner(await unpacked(order.bytes), order.names, (said) => self.postMessage(said));
    } else if (order.kind === "program") {
        player = new Player(await unpacked(order.bytes));
    } else if (order.kind === "play") {
        self.postMessage(played(order.id, order.script));
    } else {
        runner?.hearOfPort(order);
    }
}

/** What comes while the unit is unpacked is done after that, in its order. */
let turn = Promise.resolve();
self.addEventListener("message", ({ data }: MessageEvent<Order>) => {
    turn = turn.then(() => take(data)).catch(fail);
});

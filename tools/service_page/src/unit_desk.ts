import type { Bytes } from "./program_host";
import type { FromService, Node, UnitState } from "./protocol";
import type { Simulator } from "./simulator";
import { answerOf, nameOf, type Asked, type Order, type StopOrder } from "./unit_answer";
import { Beats } from "./unit_beats";
import { Grip } from "./unit_grip";
import * as messages from "./unit_messages";
import { UnitOrders, type Exchange, type Got } from "./unit_orders";
import { AT_ONCE, BROADCAST, LineTrouble, OPENING, Refusal, USUAL, type Place, type Wait } from "./unit_place";
import { RESET } from "./unit_plan";
import { DeskState, merged } from "./unit_state";
import { STOP, stopAll } from "./unit_stop";
import { UnitView } from "./unit_view";

const LOOK_MS = 100;
/** From one look to the next while the unit does not answer. */
const LOOK_AGAIN_MS = 1000;
/** What has waited longer for its turn is refused. */
const TURN_MS = 10_000;
const LOAD_MS = 1000;

const LATE = new Refusal("this came too late and was not sent", "look at the unit, then ask again", { kind: "Late" });
const STOPPED = new Refusal("a stop went ahead of this", "send it again if it is still wanted", { kind: "Stopped" });
const NOT_CONNECTED = new Refusal("no port is open", "connect first", { kind: "NotConnected" });
const UNSENT = new Refusal(
    "the unit was not reached at that time, so this was not sent", "look at the unit, then send it again",
    { kind: "Unsent" },
);

/**
 * Answers the page as the service does, for the unit in it or for those on a line. It is called with the time that it
 * is, at least every few milliseconds. One thing is done at a time, a stop ahead of all others; what cannot be done now
 * is refused now, so that nothing happens later.
 */
export class UnitDesk {
    readonly #virtual: Place;
    readonly #orders: UnitOrders;
    readonly #view: UnitView;
    readonly #tell: (told: FromService) => void;
    readonly #close: () => void;
    readonly #fail: (error: unknown) => void;
    readonly #beats = new Beats();
    readonly #grip = new Grip();
    #place: Place | null;
    /** Why there is none. */
    #why: Refusal = NOT_CONNECTED;
    /** A port that the page has opened. */
    #offered: Place | null = null;
    readonly #state: DeskState;
    #queue: { order: Order; since_ms: number }[] = [];
    #stops: StopOrder[] = [];
    /** Whether all motors stood or braked at the last look, and nothing was asked for since. */
    #isStill = false;
    #isBusy = false;
    #isStopping = false;
    #isUrgent = false;
    #look_due_ms = 0;
    #busy_ms = 0;
    #load = { since_ms: 0, share: 0 };
    #asked = 0;

    /** `close` closes the port of the page; `fail` is told of a fault of the desk. */
    constructor(
        virtual: Place, simulator: Simulator, names: messages.StatusNames,
        told: { tell: (told: FromService) => void; close: () => void; fail: (error: unknown) => void },
    ) {
        this.#virtual = this.#place = virtual;
        this.#view = new UnitView(names);
        this.#tell = told.tell;
        this.#close = told.close;
        this.#fail = told.fail;
        const desk = this;
        const talk = {
            ask: (request: Bytes, wait?: Wait, node?: number) => this.#ask(request, wait, node),
            get session() {
                return desk.#place?.sessions(desk.#state.now.node) ?? 0;
            },
            get text_bytes_max() {
                return (desk.#place ?? virtual).text_bytes_max;
            },
            get isTwice() {
                return desk.#place?.isTwice ?? false;
            },
            tell: (done: number, total: number) =>
                total > 1 && this.#tell({ type: "progress", id: this.#asked, from: 1, value: done / total }),
        };
        this.#orders = new UnitOrders(talk, simulator, names);
        this.#state = new DeskState(virtual.port, told.tell);
    }

    /** A page has come, or has come back: it is told what there is to know. */
    greet(now_ms: number): void {
        this.#tell({
            type: "hello", version: "1", language_default: "en", client: 1, beat: this.#beats.next(now_ms),
        });
        this.#state.tell();
        this.#look_due_ms = now_ms;
        this.#go();
    }

    /** To be called again and again; `spent_ms` is what the unit in the page has needed since the last call. */
    tick(now_ms: number, spent_ms: number): void {
        this.#weigh(now_ms, spent_ms);
        if (this.#beats.isDue(now_ms)) {
            this.#tell({ type: "beat", beat: this.#beats.next(now_ms) });
        }
        if (this.#grip.isLost(now_ms)) {
            this.obey({ type: "stop", id: 0, nodes: [] }, now_ms);
        }
        this.#go();
    }

    /** Does what the page asks for, now or not at all; a stop is never too late. */
    obey(asked: Asked, now_ms: number): void {
        if (asked.type === "stop") {
            this.#stops.push(asked);
            this.#place?.hurry();
            this.#giveUp(STOPPED);
        } else if (asked.type === "hold") {
            if (!asked.held) {
                this.#letGo(now_ms);
            } else if (this.#place !== null && !this.#beats.isLate(asked.beat, now_ms)) {
                this.#grip.set(true, now_ms);
            }
        } else if (asked.type === "forget") {
            this.#state.forget(asked.nodes);
        } else if (asked.type === "input") {
            this.#setInput(asked, now_ms);
        } else if (asked.type !== "ports") {
            const isLate = asked.type !== "connect" && asked.type !== "disconnect" && this.#beats.isLate(asked.beat, now_ms);
            if (isLate) {
                this.#refuse(asked, LATE);
            } else if (isUrgent(asked)) {
                this.#letGo(now_ms);
                this.#queue.unshift({ order: asked, since_ms: now_ms });
                this.#place?.hurry();
            } else {
                this.#queue.push({ order: asked, since_ms: now_ms });
            }
        }
        this.#go();
    }

    /** A run that still waits for the line is never sent. */
    #letGo(now_ms: number): void {
        this.#grip.set(false, now_ms);
        this.#giveUp(STOPPED, isHeld);
    }

    /** The page has opened a port, to which it will connect. */
    offer(place: Place): void {
        this.#offered = place;
    }

    /** The port was lost. What its units do now is not known, and where one may move a stop is not confirmed. */
    lose(place: Place, why: LineTrouble): void {
        if (this.#place !== place) {
            return;
        }
        if (!this.#isStill || this.#state.now.nodes.length > 1) {
            this.#state.lose();
        }
        this.#leave({ error: why.trouble }, why);
        this.#giveUp(UNSENT);
    }

    #leave(more: Partial<UnitState>, why = NOT_CONNECTED): void {
        this.#place = null;
        this.#why = why;
        this.#view.begin();
        this.#state.change({ connected: false, virtual: false, unit: null, nodes: [], ...more });
    }

    #weigh(now_ms: number, spent_ms: number): void {
        this.#busy_ms += spent_ms;
        const passed_ms = now_ms - this.#load.since_ms;
        if (passed_ms >= LOAD_MS) {
            this.#load = { since_ms: now_ms, share: this.#busy_ms / passed_ms };
            this.#busy_ms = 0;
        }
    }

    #go(): void {
        if (!this.#isBusy) {
            this.#isBusy = true;
            this.#work().then(() => (this.#isBusy = false), this.#fail);
        }
    }

    /** Does all that waits, one after the other. */
    async #work(): Promise<void> {
        for (;;) {
            const next = this.#stops.length > 0 ? undefined : this.#queue.shift();
            if (this.#stops.length > 0) {
                await this.#stop(this.#stops.splice(0));
            } else if (next) {
                await this.#do(next.order, next.since_ms);
            } else if (this.#place !== null && performance.now() >= this.#look_due_ms) {
                await this.#look(this.#place);
            } else {
                return;
            }
        }
    }

    async #ask(request: Bytes, wait = USUAL, node = this.#state.now.node): Promise<Bytes> {
        const place = this.#place;
        if (place === null) {
            throw this.#why;
        }
        const hasUrgent = (): boolean => !this.#isUrgent && this.#queue.some(({ order }) => isUrgent(order));
        const isGivenUp = (): boolean => !this.#isStopping && (this.#stops.length > 0 || hasUrgent());
        if (isGivenUp()) {
            throw STOPPED;
        }
        try {
            const answer = await place.ask(node, request, this.#isUrgent ? AT_ONCE : wait);
            if (node !== BROADCAST) {
                this.#state.hear({ port: place.port, node });
            }
            return answer;
        } catch (error) {
            throw error instanceof LineTrouble && error.trouble.kind !== "PortLost" && isGivenUp() ? STOPPED : error;
        }
    }

    /** Refuses what waits for the line; whether there is one is another matter. */
    #giveUp(why: Refusal, isMeant = isForUnit): void {
        const refused = this.#queue.filter(({ order }) => isMeant(order));
        this.#queue = this.#queue.filter(({ order }) => !isMeant(order));
        refused.forEach(({ order }) => this.#refuse(order, why));
    }

    #refuse(order: Order, why: Refusal): void {
        this.#orders.forget();
        this.#answer(order, why, this.#orders.last);
    }

    async #do(order: Order, since_ms: number): Promise<void> {
        if (performance.now() - since_ms > TURN_MS) {
            this.#refuse(order, LATE);
            return;
        }
        this.#orders.forget();
        this.#asked = "id" in order ? order.id : 0;
        this.#isStill = false;
        const place = this.#place;
        const wasAway = this.#state.now.error !== null;
        this.#state.change({ busy: nameOf(order) });
        this.#isUrgent = isUrgent(order);
        const got = await tried(() => this.#obeyed(order));
        this.#isUrgent = false;
        this.#note(got);
        if (got instanceof LineTrouble || wasAway) {
            this.#giveUp(UNSENT);
        }
        this.#state.change({ busy: null });
        this.#answer(order, inDoubt(got, place?.written), this.#orders.last);
        this.#look_due_ms = performance.now();
    }

    async #obeyed(order: Order): Promise<Got> {
        switch (order.type) {
            case "request":
                return this.#orders.ask(order.message, order);
            case "speed":
                return this.#orders.speed(order.motor, order.value);
            case "resume":
                return this.#orders.act("C75");
            case "reset":
                return this.#orders.act(RESET);
            case "connect":
                return this.#connect(order);
            case "disconnect":
                this.#close();
                this.#offered = null;
                this.#leave({ port: null, error: null });
                return { text: "the port is closed", values: {} };
        }
    }

    /** Speaks to the unit of a node, and asks for its version: nothing moves. */
    async #connect({ port, node, failed }: Extract<Order, { type: "connect" }>): Promise<Got> {
        const place = [this.#virtual, this.#offered].find((each) => each?.port === port) ?? null;
        if (failed !== undefined || place === null) {
            const trouble = failed ?? { kind: "PortMissing", cause: `${port} is not open`, next: "choose a port" };
            this.#leave({ port, node, error: trouble });
            throw new Refusal(trouble.cause, trouble.next, trouble);
        }
        this.#place = place;
        this.#view.begin();
        const stop = this.#state.now.stop?.length === 0 ? null : this.#state.now.stop;
        const nodes = this.#state.nodesOf(port);
        this.#state.change({ connected: true, port, node, virtual: place.isVirtual, unit: null, error: null, nodes, stop });
        const { text, values } = await this.#orders.version();
        this.#state.change({ unit: values });
        return { text, values };
    }

    async #look(place: Place): Promise<void> {
        const started_ms = performance.now();
        const got = await tried(() => this.#looked(place));
        const now_ms = performance.now();
        if (!(got instanceof Refusal)) {
            this.#look_due_ms = Math.max(started_ms + LOOK_MS, 2 * now_ms - started_ms);
        } else if (got !== STOPPED && this.#place === place) {
            this.#look_due_ms = now_ms + LOOK_AGAIN_MS;
            this.#state.change({ error: got.trouble });
        }
    }

    /** Only asks, whoever has come back. */
    async #looked(place: Place): Promise<void> {
        const wasAway = this.#state.now.unit === null || this.#state.now.error !== null;
        if (wasAway) {
            this.#view.begin();
            const { version, date } = messages.version(await this.#ask(Uint8Array.of(messages.VERSION), OPENING));
            this.#state.change({ unit: { version, date } });
        }
        const { node } = this.#state.now;
        const ask = (request: Bytes, wait: Wait): Promise<Bytes> => this.#ask(request, wait);
        const live = await this.#view.look(place, node, this.#load.share, ask);
        this.#tell({ type: "live", ...live });
        this.#state.see({ port: place.port, node });
        this.#isStill = live.motors.every(messages.isStopped);
        if (wasAway) {
            this.#state.change({ error: null });
            this.#giveUp(UNSENT);
        }
    }

    #note(got: Refusal | unknown): void {
        if (got instanceof LineTrouble && this.#place !== null) {
            this.#state.change({ error: got.trouble });
        } else if (!(got instanceof Refusal) && this.#state.now.error !== null && this.#place !== null) {
            this.#state.change({ error: null });
        }
    }

    /** K to all motors of all units that are known; a stop that is asked for meanwhile is another one. */
    async #stop(asked: StopOrder[]): Promise<void> {
        const last: Exchange = { request: STOP, answer: new Uint8Array() };
        this.#isStopping = true;
        const got = await tried(() => this.#sendStop(asked.flatMap(({ nodes }) => nodes), last));
        this.#isStopping = false;
        this.#note(got);
        this.#state.change({ busy: null });
        asked.forEach((order) => this.#answer(order, got, last));
        this.#look_due_ms = performance.now();
    }

    async #sendStop(named: Node[], last: Exchange): Promise<Got> {
        const place = this.#place;
        const known = merged(...this.#state.known, ...named);
        const outside = known.filter(({ port }) => port !== this.#virtual.port && port !== place?.port);
        if (place === null) {
            this.#state.change({ busy: "stop", stop: outside });
            throw this.#why;
        }
        const there = merged(...known.filter(({ port }) => port === place.port), this.#state.here);
        const leave = (left: number[]): void =>
            this.#state.change({ stop: [...there.filter((each) => left.includes(each.node)), ...outside] });
        this.#state.change({ busy: "stop", stop: [...there, ...outside] });
        const talk = {
            ask: (request: Bytes, wait: Wait, to: number) => this.#ask(request, wait, to),
            isStopped: (from: number, status: Bytes) => this.#isStopped(place, from, status),
            left: leave,
        };
        const { left, answer } = await stopAll(talk, there.map((each) => each.node));
        last.answer = answer;
        if (left.length > 0 || outside.length > 0) {
            const names = left.map((each) => `node ${each}`);
            names.push(...outside.map((each) => `node ${each.node} of ${each.port}`));
            throw new Refusal(`the stop is not confirmed by ${names.join(", ")}`, "use the emergency stop", {
                kind: "NotConfirmed",
            });
        }
        this.#state.change({ stop: null });
        return { text: "all motors stop", values: { confirmed: there } };
    }

    #isStopped(place: Place, node: number, status: Bytes): boolean {
        const isShown = node === this.#state.now.node;
        const view = isShown ? this.#view : new UnitView(this.#view.names);
        const live = view.show(place, node, status, this.#load.share);
        if (isShown) {
            this.#tell({ type: "live", ...live });
        }
        this.#state.see({ port: place.port, node });
        return live.motors.every(messages.isStopped);
    }

    #answer(order: Order | StopOrder, got: Got | Refusal, last: Exchange): void {
        this.#tell({ type: "answer", ...answerOf(order, this.#state.now.node, got, last) });
    }

    #setInput({ input, level, beat }: Extract<Asked, { type: "input" }>, now_ms: number): void {
        const refusal = this.#beats.isLate(beat, now_ms) ? LATE : this.#place === null ? this.#why : null;
        try {
            if (refusal !== null) {
                throw refusal;
            }
            this.#place?.setInput(input, level);
            this.#look_due_ms = now_ms;
        } catch (error) {
            if (!(error instanceof Refusal)) {
                throw error;
            }
            this.#tell({ type: "error", error: error.trouble });
        }
    }

}

/** What was cut short on the line: the unit may have taken it. A restart says itself what became of it. */
function inDoubt(got: Got | Refusal, message = 0): Got | Refusal {
    const changes = message === messages.SET_COMMAND || message === messages.STORE_FLASH;
    if (!changes || !(got instanceof Refusal) || !/Answer|Lost/.test(got.trouble.kind ?? "")) {
        return got;
    }
    const { cause, next, kind = "" } = got.trouble;
    const moves = message === messages.SET_COMMAND ? "motors may move; " : "";
    return new Refusal("NOT CONFIRMED: it may have been taken", `${moves}${cause}; ${next}`, { kind });
}

const isForUnit = (order: Order): boolean => !("port" in order) && order.type !== "disconnect";
/** Whether it is not to be sent after the button was let go, which is told before its K. */
const isHeld = (order: Order): boolean => "held" in order;
/** Whether it is the K of a button that is let go, which only a stop goes ahead of. */
const isUrgent = (order: Order): boolean => "held" in order && order.text === "K";

/** What came of some work; a refusal is an answer, too. */
async function tried<T>(work: () => Promise<T>): Promise<T | Refusal> {
    try {
        return await work();
    } catch (error) {
        if (error instanceof Refusal) {
            return error;
        }
        throw error;
    }
}

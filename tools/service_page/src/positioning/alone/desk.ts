import { LineTrouble, Refusal } from "../../unit_place";
import type { Trouble } from "../../protocol";
import { Beats } from "../../unit_beats";
import { AXES, type FromService, type ToService } from "../protocol";
import { act } from "./acting";
import type { Names } from "./axis_state";
import { Board } from "./board";
import { PortTrouble, type Bus } from "./bus";
import { Connection, NOT_CONNECTED } from "./connection";
import * as settings from "./settings_all";
import { Stop } from "./stop";
import { settingRows, typeRange } from "./table";
import { VIRTUAL, type VirtualBus } from "./virtual_bus";

/** From one look to the next while the unit does not answer. */
const LOOK_AGAIN_MS = 1000;
/** What has waited longer for its turn is refused. */
const TURN_MS = 10_000;
const NOT_STORED = 4;

const LATE = new Refusal("this came too late and was not sent", "look at the unit, then ask again", { kind: "Late" });
const STOPPED = new Refusal("a stop went ahead of this", "send it again if it is still wanted", { kind: "Stopped" });
const UNSENT = new Refusal(
    "the unit was not reached at that time, so this was not sent", "look at the unit, then send it again", { kind: "Unsent" },
);
const RESTARTED = new Refusal("the unit has restarted", "take note of that first", { kind: "BadRequest" });
const WIRES = new Refusal("only the virtual unit has inputs that can be set here", "those of a unit are wires");

/** What the page asks for, with its last sign of life; `failed`: why the port that it wants could not be opened. */
export type Asked = ToService & { beat?: number; failed?: Trouble };
type HaltOrder = Extract<ToService, { type: "halt" | "hold" }>;
type Work = Exclude<Asked, { type: "halt" | "hold" | "ports" | "input" }>;

const isForUnit = ({ type }: Work): boolean => type !== "connect" && type !== "disconnect" && type !== "seen";

/**
 * Answers the page as the service does, for the unit in it or for one on a line. One thing is done at a time, a stop ahead
 * of all others; what cannot be done now is refused now, so that nothing happens later.
 */
export class Desk {
    readonly #board: Board;
    readonly #line: Connection;
    readonly #virtual: VirtualBus;
    readonly #beats = new Beats();
    #waiting: { order: Work; since_ms: number }[] = [];
    #halts: HaltOrder[] = [];
    #answered: HaltOrder[] = [];
    #isHalting = false;
    /** Axes of which a stop was asked for: only one of that axis ends it. */
    readonly #unheld = new Set<number>();
    #asked: number[] = [];
    #wake: () => void = () => undefined;

    /** `fail` is told of a fault of the desk, which ends it. */
    constructor(virtual: VirtualBus, names: Names, tell: (told: FromService) => void, fail: (error: unknown) => void) {
        this.#virtual = virtual;
        this.#board = new Board(tell);
        this.#line = new Connection(this.#board, virtual, names, () => this.#mindHalt());
        this.#waiting.push({ order: { type: "connect", port: VIRTUAL, node: 1 }, since_ms: performance.now() });
        this.#run().catch(fail);
    }

    /** A page has come, or has come back: it is told what there is to know. */
    greet(now_ms: number): void {
        this.#board.tell({ type: "hello", client: 1, beat: this.#beats.next(now_ms) });
        const rows = settingRows.map((row) => {
            const [least, most] = row.form === "ANY" ? typeRange(row) : [row.least, row.most];
            const part = row.scope === "A" ? ("axis" as const) : ("unit" as const);
            return { name: row.name, part, form: row.form, least, most, delivered: row.start, unit: row.unit, text: row.text };
        });
        this.#board.tell({ type: "rows", rows });
        this.#board.tellState();
        this.#line.tellSettings();
    }

    /** To be called again and again. */
    tick(now_ms: number): void {
        if (this.#beats.isDue(now_ms)) {
            this.#board.tell({ type: "beat", beat: this.#beats.next(now_ms) });
        }
    }

    /** The page has opened a port, to which it will connect. */
    offer(bus: Bus): void {
        this.#line.offer(bus);
    }

    /** Does what the page asks for, now or not at all; a stop is never too late. */
    obey(asked: Asked, now_ms: number): void {
        const isLate = this.#beats.isLate(asked.beat, now_ms);
        if (asked.type === "halt" || asked.type === "hold") {
            this.#halts.push(asked);
            this.#giveUp(STOPPED);
        } else if (asked.type === "input") {
            this.#setInput(asked, isLate);
        } else if (asked.type !== "ports") {
            this.#take(asked, isLate, now_ms);
        }
        this.#wake();
    }

    #take(order: Work, isLate: boolean, now_ms: number): void {
        const isStopping = this.#halts.length > 0 || this.#isHalting;
        // A port is chosen and opened before its connecting comes here, however long that takes.
        if (isLate && order.type !== "connect" && order.type !== "disconnect") {
            this.#answer(order, LATE);
        } else if (isForUnit(order) && isStopping) {
            this.#answer(order, STOPPED);
        } else {
            this.#waiting.push({ order, since_ms: now_ms });
        }
    }

    #setInput({ input, level }: Extract<Asked, { type: "input" }>, isLate: boolean): void {
        const { connected, virtual } = this.#board.state;
        const why = isLate ? LATE : !connected || !virtual ? WIRES : null;
        if (why === null) {
            this.#virtual.unit.setInput(input, level);
        } else {
            this.#board.tell({ type: "error", error: why.trouble });
        }
    }

    #giveUp(why: Refusal): void {
        const given = this.#waiting.filter(({ order }) => isForUnit(order));
        this.#waiting = this.#waiting.filter(({ order }) => !isForUnit(order));
        given.forEach(({ order }) => this.#answer(order, why));
    }

    #answer(order: Work | HaltOrder, got: string | Refusal): void {
        const asker = { type: "answer" as const, id: "id" in order ? order.id : null, from: 1, message: order.type };
        this.#board.tell(got instanceof Refusal ? { ...asker, text: null, error: got.trouble } : { ...asker, text: got, error: null });
    }

    // ---- one thing at a time ----

    async #run(): Promise<never> {
        for (;;) {
            const work = this.#halts.length > 0 ? undefined : this.#waiting.shift();
            if (this.#halts.length > 0) {
                await this.#doHalts();
            } else if (work !== undefined) {
                await this.#do(work.order, work.since_ms);
            } else if (this.#line.unit !== null && performance.now() >= this.#line.look_due_ms) {
                await this.#look();
            } else {
                await this.#rest();
            }
        }
    }

    /** Until something is asked for, or a look is due. */
    #rest(): Promise<void> {
        return new Promise((take) => {
            this.#wake = take;
            if (this.#line.unit !== null) {
                self.setTimeout(take, this.#line.look_due_ms - performance.now());
            }
        });
    }

    /** While the line is used: a stop does not wait for long. */
    #mindHalt(): void {
        if (this.#halts.length > 0 && !this.#isHalting) {
            throw STOPPED;
        }
    }

    async #do(order: Work, since_ms: number): Promise<void> {
        if (performance.now() - since_ms > TURN_MS) {
            this.#answer(order, LATE);
            return;
        }
        const wasAway = this.#board.state.error !== null;
        this.#board.change({ busy: order.type });
        const got = await tried(() => this.#obeyNow(order));
        if (got instanceof LineTrouble || wasAway) {
            this.#giveUp(UNSENT);
        }
        this.#line.note(got);
        this.#board.change({ busy: null });
        this.#answer(order, got);
    }

    async #obeyNow(order: Work): Promise<string> {
        if (order.type === "connect") {
            return this.#line.connect(order);
        }
        if (order.type === "disconnect") {
            return this.#line.disconnect();
        }
        if (order.type === "seen") {
            this.#board.change({ restarted: false });
            return "noted";
        }
        const unit = this.#line.required();
        if (order.type === "write") {
            return this.#write(order.values);
        }
        if (order.type === "settings" || order.type === "store" || order.type === "deliver") {
            return this.#keep(order.type);
        }
        if (this.#board.state.restarted && order.type !== "release" && order.type !== "capture") {
            throw RESTARTED;
        }
        const isLate = (): boolean => this.#beats.isLate(order.beat, performance.now());
        if (isLate()) {
            throw LATE;
        }
        this.#line.looks.touch([order.axis]);
        unit.wire.isLate = isLate;
        try {
            return await act(unit, order);
        } catch (error) {
            this.#board.change(error instanceof LineTrouble ? { doubt: true } : {});
            throw error;
        } finally {
            unit.wire.isLate = () => false;
            this.#line.looks.touch([order.axis]);
        }
    }

    /** Writes those settings that differ. */
    async #write(values: Partial<settings.AllSettings>): Promise<string> {
        const unit = this.#line.required();
        await settings.requireFree(unit, Object.keys(values));
        const found = await settings.readAll(unit);
        this.#line.forgetSettings(); // until they are read again
        try {
            await settings.write(unit, values, found);
        } finally {
            await this.#line.readSettings();
        }
        const now = this.#line.settings ?? found;
        const names = Object.entries(values).flatMap(([part, own]) =>
            Object.keys(own).filter((name) => found[part as "unit"][name] !== now[part as "unit"][name]).map((name) => `${part} ${name}`),
        );
        return names.length > 0 ? `written: ${names.join(", ")}; not stored yet` : "all of them were so";
    }

    /** Reads, stores, or takes the delivered ones. */
    async #keep(what: "settings" | "store" | "deliver"): Promise<string> {
        const unit = this.#line.required();
        if (what === "store") {
            await unit.store(1);
            if (((await unit.read()).condition ?? 0) & NOT_STORED) {
                throw new Refusal(`${unit.wire.name}: after STORE they are not as stored`, "");
            }
        } else if (what === "deliver") {
            this.#line.looks.touch(AXES);
            this.#line.forgetSettings();
            await unit.store(2);
        }
        await this.#line.readSettings();
        const words = { settings: "all settings were read", store: "all settings are stored", deliver: "the delivered settings are in force; not stored yet" };
        return words[what];
    }

    /** Stops for all who have asked for it until the axes stand; a later one stops again. */
    async #doHalts(): Promise<void> {
        this.#isHalting = true;
        this.#answered = [];
        this.#asked = [];
        const got = await tried(() => this.#stop());
        this.#isHalting = false;
        if (!(got instanceof Refusal)) {
            this.#asked.forEach((axis) => this.#unheld.delete(axis));
        }
        this.#board.change({ busy: null, halt: this.#unheld.size > 0 ? "failed" : null, unheld: [...this.#unheld] });
        this.#answered.forEach((order) => this.#answer(order, got));
    }

    async #stop(): Promise<string> {
        const first = this.#moreHalts();
        if (this.#line.unit === null) {
            throw NOT_CONNECTED;
        }
        const axes = [first];
        return new Stop({
            unit: this.#line.unit,
            looks: () => this.#line.looks,
            look: () => this.#line.look(),
            restart: () => this.#line.restart(),
            more: () => axes.pop() ?? this.#moreHalts(),
        }).run();
    }

    /** The axes that are to be stopped since the last time; who has asked is answered with what comes of it. */
    #moreHalts(): number[] {
        const halts = this.#halts;
        this.#halts = [];
        this.#answered.push(...halts);
        const axes = halts.flatMap((order) => (order.type === "hold" ? [order.axis] : [...AXES]));
        if (axes.length > 0) {
            this.#asked.push(...axes);
            axes.forEach((axis) => this.#unheld.add(axis));
            this.#board.change({ busy: "halt", halt: "asked", unheld: [...this.#unheld] });
        }
        return axes;
    }

    async #look(): Promise<void> {
        const started_ms = performance.now();
        const { error, version } = this.#board.state;
        const seen = await tried(() => this.#line.look());
        const now_ms = performance.now();
        if (!(seen instanceof Refusal)) {
            const pause_ms = Math.min((now_ms - started_ms) / 4, this.#line.pause_most_ms);
            this.#line.look_due_ms = Math.max(this.#line.look_due_ms, now_ms + pause_ms);
            this.#board.change({ error: null, version: this.#line.version });
            if (error !== null || version === null) {
                this.#giveUp(UNSENT);
            }
        } else if (seen !== STOPPED) {
            this.#line.look_due_ms = now_ms + LOOK_AGAIN_MS;
            this.#line.note(seen);
        }
    }
}

/** What comes of it, or why not; after a fault of the page nobody knows what was under way on the line. */
async function tried<Got>(work: () => Promise<Got>): Promise<Got | Refusal> {
    try {
        return await work();
    } catch (error) {
        if (error instanceof Refusal) {
            return error;
        }
        console.error(error);
        const what = error instanceof Error ? `${error.name}: ${error.message}` : String(error);
        return new PortTrouble("Fault", what, "this is a fault of the page, connect again");
    }
}

import type { Bytes } from "../../program_host";
import { Beats } from "../../unit_beats";
import { LineTrouble, Refusal } from "../../unit_place";
import type { Trouble } from "../../protocol";
import type { FromService, ToService } from "../protocol";
import * as acts from "./acts";
import { ownFile, type Opened } from "./file";
import { HELD, Jobs, STOPPED } from "./jobs";
import type { UnitLink } from "./link";
import { spindleText } from "./known";
import { homingText, type Mill } from "./mill";
import { UnitConnection } from "./seen_unit";
import { flagsText, positionsText } from "./told";
import type { BytePort } from "./wire";

export const VIRTUAL = "virtual";
/** From one look to the next at least; looks take no more than half of the line's time. */
const LOOK_MS = 100;
/** The same while the unit does not answer. */
const LOOK_AGAIN_MS = 1000;
/** What has waited longer for its turn is refused. */
const TURN_MS = 10_000;
/** For what is under way on the line when a halt is asked for; packets take less. */
const GRACE_MS = 300;

const LATE = new Refusal("this came too late and was not sent", "look at the unit, then ask again", { kind: "Late" });
const NOT_CONNECTED = new Refusal("no port is open", "connect first", { kind: "NotConnected" });
const UNSENT = new Refusal(
    "the unit was not reached at that time, so this was not sent", "look at the unit, then send it again", { kind: "Unsent" },
);
const DISTURBS = new Refusal("a job is under way, and this would disturb it", "halt it first");
const NO_SWITCHES = new Refusal("which switches? no machine file that has them is open", "open one (.rkm)");
const NOT_DONE = new Refusal("a job is not done", "go on with it, or halt and delete it");

/** What the page asks for, with its last sign of life; `failed`: why the port that it wants could not be opened. */
export type Asked = ToService & { beat?: number; failed?: Trouble };
type Input = Extract<Asked, { type: "input" }>;
type Order = Exclude<Asked, Input | { type: "ports" }>;
type Connect = Extract<Asked, { type: "connect" }>;

/** The unit of the page, of which inputs can be set. */
export interface VirtualPort extends BytePort {
    setInput(input: number, level: 0 | 1): void;
}

/**
 * Answers the page as the service does, for the unit in it or for one at a serial port. It is called with the time that
 * it is, at least every few milliseconds. One thing is done at a time, a halt ahead of all others; what cannot be done
 * now is refused now, so that nothing happens later.
 */
export class UnitDesk {
    readonly #virtual: VirtualPort;
    readonly #tell: (told: FromService) => void;
    readonly #close: () => void;
    readonly #fail: (error: unknown) => void;
    readonly #line: UnitConnection;
    readonly #jobs: Jobs;
    readonly #beats = new Beats();
    /** A port that the page has opened. */
    #offered: BytePort | null = null;
    /** Why it is there no more. */
    #lost: LineTrouble | null = null;
    #file: Opened | null = null;
    #mill: Mill | null = null;
    #queue: { order: Order; since_ms: number }[] = [];
    #halts: Order[] = [];
    #halt_since_ms = 0;
    #isHalting = false;
    #isBusy = false;

    /** `bytes` is the module; `close` closes the port of the page; `fail` is told of a fault of the desk. */
    constructor(
        bytes: Bytes, virtual: VirtualPort,
        told: { tell: (told: FromService) => void; close: () => void; fail: (error: unknown) => void },
    ) {
        this.#virtual = virtual;
        this.#tell = told.tell;
        this.#close = told.close;
        this.#fail = told.fail;
        this.#line = new UnitConnection(bytes, told.tell, () => this.#mind());
        this.#jobs = new Jobs(this.#line, (link) => this.#beside(link));
        this.#queue.push({ order: { type: "connect", port: VIRTUAL }, since_ms: performance.now() });
    }

    // ---- what comes ----

    /** A page has come, or has come back: it is told what there is to know. */
    greet(now_ms: number): void {
        this.#tell({ type: "hello", client: 1, beat: this.#beats.next(now_ms) });
        this.#line.state.tell();
        this.#tell(this.#line.made.told);
    }

    tick(now_ms: number): void {
        if (this.#beats.isDue(now_ms)) {
            this.#tell({ type: "beat", beat: this.#beats.next(now_ms) });
        }
        this.#line.link?.wire.stir();
        if (this.#halts.length > 0) {
            this.#line.link?.wire.poke();
        }
        this.#go();
    }

    /** Does what the page asks for, now or not at all; a halt is never too late. */
    obey(asked: Asked, now_ms: number): void {
        const isLate = this.#beats.isLate(asked.beat, now_ms);
        if (asked.type === "halt") {
            this.#halt_since_ms = this.#halts.length > 0 ? this.#halt_since_ms : now_ms;
            this.#halts.push(asked);
            this.#giveUp(STOPPED);
        } else if (asked.type === "input") {
            this.#setInput(asked, isLate);
        } else if (asked.type !== "ports") {
            const isForUnit = asked.type !== "connect" && asked.type !== "disconnect";
            const isStopped = isForUnit && (this.#halts.length > 0 || this.#isHalting);
            if (isStopped || (isForUnit && isLate)) {
                this.#answer(asked, isStopped ? STOPPED : LATE);
            } else {
                this.#queue.push({ order: asked, since_ms: now_ms });
            }
        }
        this.#line.link?.wire.poke();
        this.#go();
    }

    /** The page shows another file. */
    open(file: Opened): void {
        if (this.#mayChange()) {
            this.#file = file;
            this.#line.state.change({ file: file.state });
        }
    }

    /** The page has another machine. */
    take(mill: Mill): void {
        if (this.#mayChange()) {
            this.#mill = mill;
            this.#line.state.change({ machine: mill.machine });
        }
    }

    /** Not while a job is under way, or may be gone on with. */
    #mayChange(): boolean {
        const isFree = this.#line.job?.isOpen !== true;
        if (!isFree) {
            this.#tell({ type: "error", error: NOT_DONE.trouble });
        }
        return isFree;
    }

    /** The page has opened a port, to which it will connect. */
    offer(port: BytePort): void {
        this.#offered = port;
        this.#lost = null;
    }

    /** Bytes have come from a port. */
    hear(port: BytePort, data: Uint8Array): void {
        if (this.#line.port === port) {
            this.#line.link?.wire.take(data);
        }
    }

    /** The port was lost. What its unit does is not known. */
    lose(port: BytePort, why: LineTrouble): void {
        this.#offered = null;
        if (this.#line.port !== port) {
            return;
        }
        const wire = this.#line.link?.wire;
        const { cause, next } = why.trouble;
        const { job } = this.#line;
        this.#lost = why;
        this.#line.drop(new LineTrouble("PortLost", `${cause}; ${job?.sender.sentText ?? 0} vectors were sent and go on by themselves`, next));
        const { restarted, job: told } = this.#line.state.now;
        this.#line.state.leave({ error: why.trouble, restarted, job: told });
        this.#giveUp(UNSENT);
        wire?.poke();
    }

    // ---- one after the other ----

    #go(): void {
        if (!this.#isBusy) {
            this.#isBusy = true;
            this.#work().then(() => (this.#isBusy = false), this.#fail);
        }
    }

    async #work(): Promise<void> {
        for (;;) {
            const { link } = this.#line;
            const next = this.#halts.length > 0 ? undefined : this.#queue.shift();
            if (this.#halts.length > 0) {
                await this.#halt(this.#halts.splice(0));
            } else if (next) {
                await this.#do(next.order, next.since_ms);
            } else if (link !== null && this.#line.state.now.wanted !== null) {
                await this.#override(link);
            } else if (link !== null && performance.now() >= this.#line.look_due_ms) {
                await this.#look(link);
            } else {
                return;
            }
        }
    }

    /** While the line is used: a halt does not wait for long, and a port that is lost is not waited for. */
    #mind(): void {
        if (this.#lost !== null) {
            throw this.#lost;
        }
        const since_ms = performance.now() - this.#halt_since_ms;
        if (this.#halts.length > 0 && !this.#isHalting && since_ms >= (this.#line.job?.isUnderWay ? GRACE_MS : 0)) {
            throw STOPPED;
        }
    }

    get #link(): UnitLink {
        const { link } = this.#line;
        if (link === null) {
            throw this.#lost ?? NOT_CONNECTED;
        }
        return link;
    }

    async #do(order: Order, since_ms: number): Promise<void> {
        if (performance.now() - since_ms > TURN_MS) {
            this.#answer(order, LATE);
            return;
        }
        const wasAway = this.#line.state.now.error !== null;
        this.#line.state.change({ busy: order.type });
        const got = await tried(() => this.#obeyed(order));
        if (got instanceof LineTrouble || wasAway) {
            this.#giveUp(UNSENT);
        }
        this.#line.note(got);
        this.#line.state.change({ busy: null });
        this.#answer(order, got);
    }

    async #obeyed(order: Order): Promise<string> {
        switch (order.type) {
            case "connect":
                return this.#connect(order);
            case "disconnect":
                this.#leave();
                this.#line.state.leave({ port: null, virtual: false });
                return "the port is closed; the unit is left as it is";
            case "seen":
                this.#line.state.change({ restarted: false });
                return "noted";
            default:
                return this.#act(this.#link, order);
        }
    }

    /** What may be done while no job is under way. */
    async #act(link: UnitLink, order: Order): Promise<string> {
        switch (order.type) {
            case "override":
                this.#line.state.change({ wanted: order.percent });
                return `the speed becomes ${order.percent} %`;
            case "typed":
                if (acts.cutsIn(order.text)) {
                    this.#requireNoJob();
                }
                return acts.type(link, order.text);
            case "output":
                await link.order(`O0,${order.port.toString(16).toUpperCase().padStart(2, "0")}`);
                return `port 0 is ${order.port.toString(16).toUpperCase().padStart(2, "0")}`;
            case "spindle":
                await link.order(`!7V${order.permille}`, "spindle");
                return order.permille > 0 ? `the spindle is set to ${order.permille / 10} %` : "spindle off";
            case "go":
                return this.#jobs.goOn(link);
            case "delete":
                return this.#jobs.delete(link);
            case "resume":
                return this.#jobs.resume();
            case "jog":
                return this.#jog(link, order.parts, order.speed);
            case "start":
                return this.#start(link, order.file);
            case "home":
                return this.#home(link, order.axis);
            default:
                throw new Error(`${order.type} is not for the unit`);
        }
    }

    async #jog(link: UnitLink, parts: number[], speed: number): Promise<string> {
        this.#requireNoJob();
        const text = await acts.jog(link, parts, speed);
        this.#line.isJogging = true;
        return text;
    }

    #start(link: UnitLink, number: number): Promise<string> {
        this.#requireNoJob();
        if (this.#file?.state.number !== number) {
            throw new Refusal("another file was opened meanwhile", "look at it, then start again");
        }
        return this.#jobs.begin(link, this.#file);
    }

    /** A reference run is a file of the page's own. */
    #home(link: UnitLink, axis: string | null): Promise<string> {
        this.#requireNoJob();
        const text = this.#mill === null ? null : homingText(this.#mill, axis);
        if (text === null) {
            throw NO_SWITCHES;
        }
        return this.#jobs.begin(link, ownFile(`home ${axis ?? "all"}`, text));
    }

    #requireNoJob(): void {
        const { job } = this.#line;
        if (job?.isOpen) {
            throw new Refusal(`${job.file.state.name} is not done`, "go on with it, or halt and delete it");
        }
    }

    /** Between two commands of a job: a halt, an order, the speed. */
    async #beside(link: UnitLink): Promise<void> {
        if (this.#halts.length > 0) {
            throw HELD;
        }
        const next = this.#queue.shift();
        if (next) {
            const got = await tried(() => this.#actBeside(link, next.order));
            this.#answer(next.order, got);
            if (got instanceof LineTrouble || got === STOPPED) {
                throw got;
            }
        }
        const sped = await tried(() => this.#jobs.override(link));
        if (sped instanceof LineTrouble || sped === STOPPED) {
            throw sped;
        }
        if (sped instanceof Refusal) {
            this.#tell({ type: "answer", id: null, from: 1, message: "override", text: null, error: sped.trouble });
        }
    }

    /** What may be done while a job is under way. */
    async #actBeside(link: UnitLink, order: Order): Promise<string> {
        if (order.type === "resume" || order.type === "seen") {
            return this.#obeyed(order);
        }
        const isQuestion = order.type === "typed" && acts.onlyAsks(order.text);
        if (isQuestion || ["override", "output", "spindle"].includes(order.type)) {
            return this.#act(link, order);
        }
        throw DISTURBS;
    }

    async #override(link: UnitLink): Promise<void> {
        const sped = await tried(() => this.#jobs.override(link));
        if (sped instanceof Refusal) {
            this.#line.note(sped);
            this.#tell({ type: "answer", id: null, from: 1, message: "override", text: null, error: sped.trouble });
        }
    }

    // ---- the port ----

    /** Speaks to the unit of a port, and asks for its version: nothing moves. */
    async #connect({ port, failed }: Connect): Promise<string> {
        const place = [this.#virtual, this.#offered].find((each) => each?.name === port) ?? null;
        if (failed !== undefined || place === null) {
            const why = failed ?? { kind: "PortMissing", cause: `${port} is not open`, next: "choose a port" };
            this.#leave();
            this.#line.state.leave({ port, virtual: false, error: why });
            throw new Refusal(why.cause, why.next, why);
        }
        if (this.#line.port !== place) {
            this.#line.drop(new Refusal("the port was closed", "the rest was not sent"));
            this.#lost = null;
            this.#line.state.heard_ms = null;
            this.#line.state.leave({ port, virtual: place.isVirtual });
            this.#line.open(place);
        }
        this.#line.state.change({ connected: true });
        const link = this.#link;
        await link.connect();
        if (link.wire.restarted) {
            this.#line.restart();
        }
        await this.#line.look(link);
        this.#line.state.change({ version: link.version, error: null });
        return link.version;
    }

    #leave(): void {
        this.#line.drop(new Refusal("the port was closed", "the rest was not sent"));
        this.#lost = null;
        this.#offered = null;
        this.#close();
    }

    /** Only asks, whoever has come back. */
    async #look(link: UnitLink): Promise<void> {
        const { state } = this.#line;
        const started_ms = performance.now();
        const wasAway = state.now.error !== null || state.now.version === null;
        const got = await tried(() => this.#line.look(link));
        const now_ms = performance.now();
        if (!(got instanceof Refusal)) {
            this.#line.look_due_ms = Math.max(started_ms + LOOK_MS, 2 * now_ms - started_ms);
            state.change({ error: null, version: link.version });
            if (wasAway) {
                this.#giveUp(UNSENT);
            }
        } else if (got !== STOPPED) {
            this.#line.look_due_ms = now_ms + LOOK_AGAIN_MS;
            this.#line.note(got);
        }
    }

    /** Sends H for all who have asked for it, and sees the axes stand; a later one halts again. */
    async #halt(asked: Order[]): Promise<void> {
        const line = this.#line;
        line.state.change({ busy: "halt", halt: "asked", wanted: null });
        this.#isHalting = true;
        const got = await tried(() => this.#halted(this.#link));
        this.#isHalting = false;
        line.state.change({ busy: null, halt: got instanceof Refusal ? "failed" : null });
        asked.forEach((order) => this.#answer(order, got));
    }

    async #halted(link: UnitLink): Promise<string> {
        const { flags, positions, restarted, others } = await link.halt();
        if (restarted) {
            this.#line.restart();
        } else if (others !== "" && this.#line.job?.isOpen) {
            this.#line.endJob(new Refusal(others, "the job is gone"));
        }
        let left = flags;
        if (this.#line.isJogging) {
            await link.order("D");
            left = await link.flags();
        }
        this.#line.isJogging = false;
        await this.#line.look(link);
        const what = restarted ? "the unit HAS RESTARTED, its positions count anew; " : others && `${others}; `;
        const text = `${what}the axes stand at ${positionsText(positions)}; ${flagsText(left)}; confirmed by the unit`;
        return text + spindleText(this.#line.state.known);
    }

    // ---- answers ----

    /** Refuses what waits for the line; whether there is one is another matter. */
    #giveUp(why: Refusal): void {
        const isForUnit = ({ order }: { order: Order }): boolean => order.type !== "connect" && order.type !== "disconnect";
        const refused = this.#queue.filter(isForUnit);
        this.#queue = this.#queue.filter((each) => !isForUnit(each));
        refused.forEach(({ order }) => this.#answer(order, why));
    }

    #answer(order: Order, got: string | Refusal): void {
        const asker = { type: "answer" as const, id: "id" in order ? order.id : null, from: 1, message: order.type };
        this.#tell(got instanceof Refusal ? { ...asker, text: null, error: got.trouble } : { ...asker, text: got, error: null });
    }

    #setInput({ input, level }: Input, isLate: boolean): void {
        const isVirtual = this.#line.port === this.#virtual;
        const own = new Refusal("the inputs of a real unit are its own", "only the virtual unit's can be clicked");
        if (isLate || !isVirtual) {
            this.#tell({ type: "error", error: (isLate ? LATE : own).trouble });
            return;
        }
        this.#virtual.setInput(input, level);
    }
}

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

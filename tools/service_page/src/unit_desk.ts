import type { Bytes } from "./program_host";
import type { Live, MotorLive, Node, ToService, Trouble, UnitState } from "./protocol";
import type { Answer, AnswerValues, FromService } from "./protocol";
import { ALL_MOTORS } from "./protocol";
import * as messages from "./unit_messages";
import { Refusal, UnitOrders } from "./unit_orders";
import { Speeds } from "./unit_speeds";

const PORT = "virtual";
const HERE: Node = { port: PORT, node: 1 };
const LOOK_MS = 100;
const BEAT_MS = 500;
/** What the page asks for with an older sign of life is refused: nobody expects it any more. */
const LATE_MS = 2000;
const BEATS_MAX = 64;
/** From one K to the next, and how long a unit is told to stop that does not. */
const STOP_AGAIN_MS = 20;
const STOPPING_MS = 12_000;
const LOAD_MS = 1000;

const LATE: Trouble = {
    kind: "Late",
    cause: "this came too late and was not sent",
    next: "look at the unit, then ask again",
};
const NOT_CONFIRMED: Trouble = {
    kind: "NotConfirmed",
    cause: "the stop is not confirmed by node 1",
    next: "use the emergency stop",
};

/** What runs the unit: the module rkm04-unit. */
export interface RunningUnit {
    follow(now_ms: number): boolean;
    ask(request: Bytes): Bytes;
    setInput(input: number, level: 0 | 1): void;
    readonly now_s: number;
    readonly stood_s: number;
}

type Asked = ToService & { beat?: number };

interface Stopping {
    ids: number[];
    again_ms: number;
    end_ms: number;
    request: Bytes;
    answer: Bytes;
}

/**
 * Answers the page as the service does, for the one unit in it. It is called with the time that it is, at least every
 * few milliseconds, and does nothing between two calls.
 */
export class UnitDesk {
    readonly #unit: RunningUnit;
    readonly #orders: UnitOrders;
    readonly #tell: (told: FromService) => void;
    readonly #speeds = new Speeds();
    readonly #version: { version: string; date: string };
    readonly #beats = new Map<number, number>();
    #beat = 0;
    #beat_due_ms = 0;
    #look_due_ms = 0;
    #stopping: Stopping | null = null;
    #open: Node[] | null = null;
    #busy_ms = 0;
    #load = { since_ms: 0, share: 0 };

    constructor(unit: RunningUnit, orders: UnitOrders, tell: (told: FromService) => void) {
        this.#unit = unit;
        this.#orders = orders;
        this.#tell = tell;
        this.#version = messages.version(unit.ask(Uint8Array.of(messages.VERSION)));
    }

    /** A page has come, or has come back: it is told what there is to know. */
    greet(now_ms: number): void {
        this.#newBeat(now_ms);
        this.#tell({ type: "hello", version: "1", language_default: "en", client: 1, beat: this.#beat });
        this.#tellState();
        this.#look_due_ms = now_ms;
    }

    /** To be called again and again; `spent_ms` is what the unit has needed since the last call. */
    tick(now_ms: number, spent_ms: number): void {
        this.#weigh(now_ms, spent_ms);
        if (now_ms >= this.#beat_due_ms) {
            this.#newBeat(now_ms);
            this.#tell({ type: "beat", beat: this.#beat });
        }
        if (this.#stopping !== null && now_ms >= this.#stopping.again_ms) {
            this.#goOnStopping(this.#stopping, now_ms);
        }
        if (now_ms >= this.#look_due_ms) {
            this.#look_due_ms = now_ms + LOOK_MS;
            this.#look();
        }
    }

    /** Does what the page asks for; a stop is never too late. */
    obey(asked: Asked, now_ms: number): void {
        const isLate = asked.beat !== undefined && now_ms - (this.#beats.get(asked.beat) ?? -Infinity) > LATE_MS;
        if (asked.type === "stop") {
            this.#stop(asked.id, now_ms);
        } else if (asked.type === "input") {
            if (isLate) {
                this.#tell({ type: "error", error: LATE });
            } else {
                this.#unit.setInput(asked.input, asked.level);
            }
        } else if (asked.type === "request") {
            this.#answer(asked.id, asked.message, asked.motor, isLate, () => this.#orders.ask(asked.message, asked));
        } else if (asked.type === "speed") {
            this.#answer(asked.id, "speed", asked.motor, isLate, () => this.#orders.speed(asked.motor, asked.value));
        } else if (asked.type === "resume" || asked.type === "reset") {
            const text = asked.type === "resume" ? "C75" : "\\";
            this.#answer(asked.id, asked.type, ALL_MOTORS, isLate, () => this.#orders.act(text));
        }
        this.#look_due_ms = now_ms;
    }

    #newBeat(now_ms: number): void {
        this.#beat += 1;
        this.#beats.set(this.#beat, now_ms);
        this.#beats.delete(this.#beat - BEATS_MAX);
        this.#beat_due_ms = now_ms + BEAT_MS;
    }

    #weigh(now_ms: number, spent_ms: number): void {
        this.#busy_ms += spent_ms;
        const passed_ms = now_ms - this.#load.since_ms;
        if (passed_ms >= LOAD_MS) {
            this.#load = { since_ms: now_ms, share: this.#busy_ms / passed_ms };
            this.#busy_ms = 0;
        }
    }

    #tellState(): void {
        const state: UnitState = {
            connected: true,
            port: PORT,
            virtual: true,
            node: HERE.node,
            busy: this.#stopping === null ? null : "stop",
            error: null,
            unit: this.#version,
            away: false,
            nodes: [HERE],
            stop: this.#open,
            seen_ago_s: 0,
        };
        this.#tell({ type: "state", ...state });
    }

    #look(): MotorLive[] {
        const { inputs, outputs, motors, unit } = this.#orders.status();
        const now_s = this.#unit.now_s;
        const speeds = this.#speeds.of(now_s, motors.map(({ position }) => position));
        const told = motors.map((motor, index) => ({ ...motor, speed: motor.moving ? (speeds[index] ?? null) : 0 }));
        const clock = { stood_s: this.#unit.stood_s, load: this.#load.share };
        const live: Live = { node: HERE.node, time_s: now_s, motors: told, inputs, outputs, unit: { ...unit, clock } };
        this.#tell({ type: "live", ...live });
        return told;
    }

    /** K to all motors; it is believed when each of them brakes to stay or has nothing to run. */
    #stop(id: number, now_ms: number): void {
        const request = messages.request(messages.SET_COMMAND, ALL_MOTORS, "K");
        const ids = [...(this.#stopping?.ids ?? []), id];
        const answer = this.#unit.ask(request);
        const [again_ms, end_ms] = [now_ms + STOP_AGAIN_MS, now_ms + STOPPING_MS];
        this.#stopping = { ids, again_ms, end_ms, request, answer };
        this.#open = [HERE];
        this.#tellState();
    }

    /** A motor that slows down because of `\` does not take K: it is sent again until it does. */
    #goOnStopping(stopping: Stopping, now_ms: number): void {
        const isConfirmed = this.#look().every(isStopped);
        if (!isConfirmed && now_ms < stopping.end_ms) {
            stopping.answer = this.#unit.ask(stopping.request);
            stopping.again_ms = now_ms + STOP_AGAIN_MS;
            return;
        }
        this.#stopping = null;
        this.#open = isConfirmed ? null : [HERE];
        this.#tellState();
        const got = isConfirmed ? { text: "all motors stop", values: { confirmed: [HERE] } } : NOT_CONFIRMED;
        for (const id of stopping.ids) {
            this.#tellAnswer(id, "stop", ALL_MOTORS, got, stopping.request, stopping.answer);
        }
    }

    #answer(id: number, name: string, motor: number, isLate: boolean, work: () => Got): void {
        this.#orders.forget();
        const got = isLate ? LATE : tried(work);
        const { request, answer } = this.#orders.last;
        this.#tellAnswer(id, name, motor, got, request, answer);
    }

    #tellAnswer(
        id: number, message: string, motor: number, got: Got | Trouble, request: Uint8Array, answer: Uint8Array,
    ): void {
        const isGood = "text" in got;
        const told: Answer = {
            id,
            from: 1,
            message,
            node: HERE.node,
            motor,
            request_bytes: null,
            answer_bytes: null,
            request_message: messages.hex(request),
            answer_message: messages.hex(answer),
            text: isGood ? got.text : null,
            values: isGood ? got.values : null,
            error: isGood ? null : got,
        };
        this.#tell({ type: "answer", ...told });
    }
}

/** What came of an order: words, and the same as values. */
export interface Got {
    text: string;
    values: AnswerValues;
}

function tried(work: () => Got): Got | Trouble {
    try {
        return work();
    } catch (error) {
        if (error instanceof Refusal) {
            return error.trouble;
        }
        throw error;
    }
}

/** Whether a motor brakes to stay, or stands and has nothing to run. */
function isStopped({ stopped, failed, ended, moving, running }: MotorLive): boolean {
    return Boolean(stopped || failed || ended) || !(moving || running);
}

import { LineTrouble, Refusal } from "../../unit_place";
import { AXES } from "../protocol";
import { has, mmText, type AxisState } from "./axis_state";
import { Restarted, type Unit } from "./client";
import { PortTrouble } from "./bus";
import type { Looks } from "./looks";
import { rest } from "./wire";

const PAUSE_MS = 20;
/** How long a stop is tried for on a line that does not answer. */
const ANSWER_MS = 5000;
/** How long an axis may brake before it is told that nobody knows. */
const BRAKE_MS = 60_000;
/** So long axes that stand are looked at: a PLC gives the permission in each of its cycles. */
const HELD_MS = 300;
const MP = 1;

/** What a stop needs of the desk; `more` gives axes that are to be stopped, too, as they come. */
export interface StopDesk {
    unit: Unit;
    looks: () => Looks;
    look: () => Promise<void>;
    restart: () => void;
    more: () => number[];
}

/**
 * Takes the permission away from axes until they are seen to stand, and to be held for a while. Who gives it back
 * meanwhile is overruled: POS_INIT ends the measure. Who then gives it yet again, as a PLC that writes it in every cycle,
 * may move the axis at any moment, so that nothing is confirmed.
 */
export class Stop {
    readonly #desk: StopDesk;
    readonly #axes = new Set<number>();
    readonly #ended = new Set<number>();
    /** Those that have got the permission yet again. */
    readonly #given = new Set<number>();
    #new = new Set<number>();
    #answer_end_ms = 0;
    #brake_end_ms = 0;
    #held_from_ms = 0;

    constructor(desk: StopDesk) {
        this.#desk = desk;
    }

    async run(): Promise<string> {
        const { wire } = this.#desk.unit;
        const before = wire.tries;
        wire.tries = 1;
        try {
            while (!(await this.#turn())) {
                await rest(PAUSE_MS);
            }
        } finally {
            wire.tries = before;
        }
        if (this.#given.size > 0) {
            const who = namesOf(this.#given);
            const cause = `${who} ${who.startsWith("axis") ? "IS" : "ARE"} NOT HELD: another master, such as a PLC, has given the permission (MP) again`;
            throw new Refusal(cause, "the measure is ended now, take the permission away there", { kind: "NotHeld" });
        }
        return this.#text();
    }

    /** Whether all are held. */
    async #turn(): Promise<boolean> {
        const come = this.#desk.more();
        if (come.length > 0) {
            come.forEach((axis) => this.#new.add(axis));
            this.#answer_end_ms = performance.now() + ANSWER_MS;
            this.#brake_end_ms = performance.now() + BRAKE_MS;
        }
        try {
            return await this.#stop();
        } catch (error) {
            if (error instanceof Restarted) {
                this.#desk.restart(); // what has restarted stands
            } else if (!(error instanceof LineTrouble) || error instanceof PortTrouble || error.trouble.kind === "NotConfirmed") {
                throw error;
            } else if (performance.now() > this.#answer_end_ms) {
                throw new LineTrouble("NotConfirmed", error.trouble.cause, error.trouble.next);
            }
        }
        return false;
    }

    async #stop(): Promise<boolean> {
        const { unit, look } = this.#desk;
        if (this.#new.size > 0) {
            const wanted = this.#new;
            await unit.requireNoOther();
            this.#desk.looks().touch(wanted);
            await unit.takePermission(wanted);
            wanted.forEach((axis) => this.#axes.add(axis));
            this.#new = new Set();
            if ([...wanted].some((axis) => !this.#given.has(axis))) {
                this.#held_from_ms = performance.now();
            }
        }
        const looked_ms = performance.now();
        await look();
        this.#answer_end_ms = performance.now() + ANSWER_MS;
        const isAgain = await this.#endAgain();
        const moving = this.#own.filter((axis) => has(axis, "JEDE") && !this.#given.has(axis.axis)).map(({ axis }) => axis);
        if (moving.length > 0 && performance.now() > this.#brake_end_ms) {
            throw new LineTrouble("NotConfirmed", `${unit.wire.name}, axis ${moving.join(", ")}: it still moves`, "");
        }
        if (isAgain || moving.length > 0) {
            this.#held_from_ms = performance.now();
        }
        return looked_ms >= this.#held_from_ms + HELD_MS;
    }

    /** Ends the measures of axes that have got the permission again; whether it was the first time of one. */
    async #endAgain(): Promise<boolean> {
        const { unit, looks } = this.#desk;
        const { wanted } = looks();
        let isFirst = false;
        for (const state of this.#own) {
            const { axis } = state;
            const wasEnded = this.#ended.has(axis);
            if (((wanted[axis - 1]?.control ?? 0) & MP) === 0 || !(wasEnded || mayMove(state))) {
                continue;
            }
            (wasEnded ? this.#given : this.#ended).add(axis);
            isFirst ||= !wasEnded;
            this.#new.add(axis); // POS_INIT gives the permission
            looks().touch([axis]);
            await unit.instruct(axis, "POS_INIT", [0]);
        }
        return isFirst;
    }

    get #own(): AxisState[] {
        return this.#desk.looks().axes.filter(({ axis }) => this.#axes.has(axis));
    }

    #text(): string {
        const states = this.#own;
        const [first] = states;
        const at = states.filter((axis) => has(axis, "DISP")).map(({ axis, position_um }) => `${axis} at ${mmText(position_um)} mm`);
        const text = states.length === 1 && first
            ? `axis ${first.axis} stands at ${mmText(first.position_um)} mm`
            : `${namesOf(this.#axes)} stand${at.length > 0 ? `: ${at.join(", ")}` : ""}`;
        const ended = this.#ended.size === 0 ? "" : `; another master gave ${namesOf(this.#ended)} the permission again, so the measure was ended there`;
        return text + ended;
    }
}

const mayMove = (axis: AxisState): boolean => has(axis, "DISP") && has(axis, "PROG") && !has(axis, "POL");

function namesOf(axes: ReadonlySet<number>): string {
    const numbers = [...axes].sort();
    return numbers.length === AXES.length ? "all axes" : `${numbers.length === 1 ? "axis" : "axes"} ${numbers.join(", ")}`;
}

import { LineTrouble } from "../../unit_place";
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
 * Takes the permission away from axes until they are seen to stand. Who gives it back while they brake, as a PLC that
 * writes it in every cycle, is overruled: POS_INIT ends the measure.
 */
export class Stop {
    readonly #desk: StopDesk;
    readonly #axes = new Set<number>();
    readonly #ended = new Set<number>();
    #new = new Set<number>();
    #answer_end_ms = 0;
    #brake_end_ms = 0;

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
        return this.#text();
    }

    /** Whether all stand. */
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
        }
        await look();
        this.#answer_end_ms = performance.now() + ANSWER_MS;
        const { axes, wanted } = this.#desk.looks();
        const isPermitted = ({ axis }: AxisState): boolean => ((wanted[axis - 1]?.control ?? 0) & MP) !== 0;
        const own = axes.filter(({ axis }) => this.#axes.has(axis));
        const again = own.filter((axis) => isPermitted(axis) && mayMove(axis));
        for (const { axis } of again) {
            this.#desk.looks().touch([axis]);
            await unit.instruct(axis, "POS_INIT", [0]);
            this.#ended.add(axis);
        }
        const moving = own.filter((axis) => has(axis, "JEDE")).map(({ axis }) => axis);
        if (moving.length > 0 && performance.now() > this.#brake_end_ms) {
            throw new LineTrouble("NotConfirmed", `${unit.wire.name}, axis ${moving.join(", ")}: it still moves`, "");
        }
        return again.length === 0 && moving.length === 0 && own.length > 0;
    }

    #text(): string {
        const states = this.#desk.looks().axes.filter(({ axis }) => this.#axes.has(axis));
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

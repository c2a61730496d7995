import type { Link } from "./link";
import type { Answer, Live, MotorLive } from "./protocol";
import { Cell } from "./signal";

/** How often the page says that its button is held; several times within what the service waits for. */
const HOLD_MS = 150;
/** So long the unit may take to say that the motor brakes or stands. */
const CONFIRM_MS = 1500;
/** So long the motor may take to stand; then what is left of its run stays in the unit. */
const STAND_MS = 30_000;
const LOOK_MS = 50;

/** What goes on: nothing; a button is held; it was let go and the stop is not confirmed; the motor runs out. */
export type Phase = "rest" | "held" | "released" | "ends";

interface Run {
    motor: number;
    /** Numbers of the requests whose answers are awaited. */
    asked: Set<number>;
    since_ms: number;
    /** Whether the unit was looked at after it took K. */
    isTaken: boolean;
}

/**
 * Lets a motor run while a button is held. Letting go sends K to it; when that is not confirmed soon, all motors of all
 * units are stopped by `stop`, which says loudly who has not confirmed. When the motor stands, what is left of the run is
 * cleared, so that Resume does not go on with it. Nothing is sent later than it was asked for.
 */
export class Jog {
    readonly phase = new Cell<Phase>("rest");
    /** The motor whose run may still be in the unit; null: there is none. */
    readonly left = new Cell<number | null>(null);
    readonly #link: Link;
    readonly #stop: () => void;
    readonly #isFresh: Cell<boolean>;
    #run: Run | null = null;
    /** Number of the reset that is to clear what is left. */
    #clearing: number | null = null;

    constructor(link: Link, isFresh: Cell<boolean>, stop: () => void) {
        this.#link = link;
        this.#isFresh = isFresh;
        this.#stop = stop;
        link.on("answer", (answer) => this.#hear(answer));
        link.on("live", (live) => this.#see(live));
        link.on("state", ({ connected }) => connected || this.release());
        link.isOpen.onChange(() => this.#lineChanged());
        isFresh.onChange(() => this.#lineChanged());
        window.setInterval(() => this.#tick(), LOOK_MS);
        window.setInterval(() => this.phase.value === "held" && this.#hold(true), HOLD_MS);
    }

    /** A button is pressed: the motor begins to run by this program. */
    press(motor: number, text: string): void {
        if (this.#run !== null || !this.#isFresh.value || !this.#hold(true)) {
            return;
        }
        this.#run = { motor, asked: new Set(), since_ms: performance.now(), isTaken: false };
        this.left.set(motor);
        this.phase.set("held");
        this.#ask(text);
    }

    /** The button is let go. */
    release(): void {
        if (this.#run === null || this.phase.value !== "held") {
            return;
        }
        this.phase.set("released");
        this.#run.since_ms = performance.now();
        this.#ask("K"); // which lets go, too: of two messages the second may never come
    }

    /** All motors were told to stop, by whoever pressed STOP. */
    stopped(): void {
        if (this.#run !== null && this.phase.value !== "ends") {
            this.#end();
        }
    }

    #hold(held: boolean): boolean {
        return this.#link.send({ type: "hold", held });
    }

    #ask(text: string): void {
        const id = this.#link.nextId();
        this.#run?.asked.add(id);
        const isSent = this.#run !== null
            && this.#link.send({ type: "request", id, message: "send", motor: this.#run.motor, text, held: true });
        if (!isSent) {
            this.#giveUp();
        }
    }

    /** What cannot be done to one motor is done to all. */
    #giveUp(): void {
        if (this.#run !== null && this.phase.value !== "ends") {
            this.#end();
            this.#stop();
        }
    }

    #end(): void {
        this.phase.set("ends");
        if (this.#run !== null) {
            this.#run.since_ms = performance.now();
            this.#run.asked.clear();
            this.#hold(false);
        }
        this.#lineChanged();
    }

    #hear({ id, from, message, error }: Answer): void {
        if (message === "reset" && error === null) {
            this.left.set(null);
        } else if (message === "stop") {
            this.stopped();
        }
        const isMine = from === undefined || from === this.#link.client;
        if (isMine && id !== null && id === this.#clearing) {
            this.#clearing = null;
            this.left.set(error === null ? null : this.left.value);
        }
        if (this.#run === null || id === null || !isMine || !this.#run.asked.delete(id)) {
            return;
        }
        const isReleased = this.phase.value === "released";
        if (error === null) {
            this.#run.isTaken = isReleased && this.#run.asked.size === 0;
        } else if (!isReleased || error.kind !== "Stopped") { // a run that had to wait is withdrawn when it is let go
            this.#giveUp();
        }
    }

    #see({ motors }: Live): void {
        const run = this.#run;
        const motor = run === null ? undefined : motors[run.motor - 1];
        if (run === null || motor === undefined) {
            return;
        }
        if (this.phase.value === "released" && run.isTaken && isStopping(motor)) {
            this.#end();
        }
        if (this.phase.value === "ends" && motor.moving === false) {
            this.#clear(run.motor);
        }
    }

    /** A reset of a motor that stands moves nothing. */
    #clear(motor: number): void {
        this.#run = null;
        const id = this.#link.nextId();
        this.#clearing = this.#link.send({ type: "request", id, message: "send", motor, text: "\\" }) ? id : null;
        this.phase.set("rest");
    }

    /** A unit that has fallen silent is sent nothing more when it is back. */
    #lineChanged(): void {
        if (this.#isFresh.value && this.#link.isOpen.value) {
            return;
        }
        this.release();
        if (this.phase.value === "ends") {
            this.#forget();
        }
    }

    #forget(): void {
        this.#run = null;
        this.phase.set("rest");
    }

    #tick(): void {
        const passed_ms = performance.now() - (this.#run?.since_ms ?? Infinity);
        if (this.phase.value === "released" && passed_ms > CONFIRM_MS) {
            this.#giveUp();
        } else if (this.phase.value === "ends" && passed_ms > STAND_MS) {
            this.#forget();
        }
    }
}

function isStopping({ stopped, failed, ended, moving, running }: MotorLive): boolean {
    return Boolean(stopped || failed || ended) || (moving === false && running !== true);
}

import { checkProgram } from "./api";
import type { Link } from "./link";
import { ALL_MOTORS, MOTORS, type Answer, type Live, type ToService, type UnitState } from "./protocol";
import { Cell } from "./signal";
import { keep, recall } from "./storage";

/** A memory that is full may have lost its oldest commands. */
const COMMANDS_MAX = 700;
/** A program of fewer characters goes in one message on any line, without `[` and `]` around it. */
const ONE_MESSAGE_BYTES = 1000;
/** Under which the browser keeps which unit has restarted. */
const KEPT = "restarted";
const [RESET, HOLD, RELEASE] = ["\\", "[", "]"];

type Request = Extract<ToService, { type: "request" }>;

/**
 * The program memories of the unit, as far as this page knows them: what it has sent since the last `\`, or what it has
 * read. Nothing is asked for. What another page or a restart may have changed is not known any more; what another
 * master on the line sends is not seen.
 */
export class Holding {
    /** Whether the unit has started anew since it was connected to, and nobody has taken note of it in this window. */
    readonly restarted = new Cell(false);
    readonly #link: Link;
    readonly #asked = new Map<number, Request>();
    #held = new Map<number, string[]>();
    #unit: Pick<UnitState, "port" | "node" | "connected"> | null = null;
    #counts: number[] = [];
    #work: Promise<void> = Promise.resolve();

    constructor(link: Link) {
        this.#link = link;
        link.onSent((message) => {
            if (message.type === "request") {
                this.#asked.set(message.id, message);
            }
        });
        link.on("answer", (answer) => {
            this.#work = this.#work.then(() => this.#hear(answer)).catch(() => this.#held.clear());
        });
        link.on("state", (state) => this.#setState(state));
        link.on("live", (live) => this.#look(live));
        link.isOpen.onChange(() => this.#held.clear());
    }

    /** Canonical texts of the commands since the last `\`; null: not known. */
    of(motor: number): string[] | null {
        return this.#held.get(motor) ?? null;
    }

    /** The user has taken note of the restart. */
    note(): void {
        keep(KEPT, "");
        this.restarted.set(false);
    }

    get #name(): string {
        return `${this.#unit?.node} ${this.#unit?.port}`;
    }

    /** Another unit, or perhaps another. */
    #setState({ port, node, connected }: UnitState): void {
        const before = this.#unit;
        const isOther = port !== before?.port || node !== before.node;
        if (isOther || !connected) {
            this.#held.clear();
        }
        this.#unit = { port, node, connected };
        if (isOther) {
            this.#counts = [];
            this.restarted.set(recall(KEPT, "") === this.#name);
        }
    }

    /** What a unit has counted since its start becomes less by a start only. */
    #look({ node, unit }: Live): void {
        if (unit === null || node !== this.#unit?.node) {
            return;
        }
        const counts = [unit.late_steps, ...Object.values(unit.line)];
        if (counts.some((count, index) => count < (this.#counts[index] ?? 0))) {
            this.#held.clear();
            keep(KEPT, this.#name);
            this.restarted.set(true);
        }
        this.#counts = counts;
    }

    async #hear(answer: Answer): Promise<void> {
        const isMine = answer.from === undefined || answer.from === this.#link.client;
        const request = isMine && answer.id !== null ? this.#asked.get(answer.id) : undefined;
        if (isMine && answer.id !== null) {
            this.#asked.delete(answer.id);
        }
        if (answer.error?.kind === "UnitRestarted") {
            this.#held.clear();
        } else if (answer.message === "reset") {
            MOTORS.forEach((motor) => (answer.error === null ? this.#held.set(motor, []) : this.#held.delete(motor)));
        } else if (answer.message === "program" && answer.error === null) {
            await this.#take(answer.motor ?? ALL_MOTORS, answer.values?.program ?? "");
        } else if (answer.message === "send" || answer.message === "send_all") {
            await this.#sent(answer, request);
        }
    }

    /** What the unit has told. */
    async #take(motor: number, text: string): Promise<void> {
        const { listing } = await checkProgram(text);
        if (motor !== ALL_MOTORS && listing !== undefined && listing.length < COMMANDS_MAX) {
            this.#held.set(motor, listing.map(([, , command]) => command));
        }
    }

    async #sent({ motor, error, values }: Answer, request: Request | undefined): Promise<void> {
        if (error?.line !== undefined) {
            return;
        }
        const motors = motor === ALL_MOTORS || motor === null ? [...MOTORS] : [motor];
        if (error !== null || request === undefined || values?.overflow || values?.everywhere) {
            motors.forEach((each) => this.#held.delete(each));
        } else if (request.message === "send_all") {
            for (const [each, text] of Object.entries(request.texts ?? {})) {
                await this.#append([Number(each)], text, request.together === true ? true : null);
            }
            if (request.together === true) {
                const others = MOTORS.filter((each) => request.texts?.[each] === undefined);
                others.forEach((each) => this.#held.delete(each)); // they may hold the ] for all
            }
        } else if (values?.alone === undefined) {
            await this.#append(motors, request.text ?? "", (values?.messages ?? 1) > 1);
        } else if (values.alone === RESET) {
            motors.forEach((each) => this.#held.set(each, []));
        }
    }

    /** `isHeld`: whether it went between `[` and `]`; null: if it is too long for one message. */
    async #append(motors: number[], text: string, isHeld: boolean | null): Promise<void> {
        const { listing = [], resets = false } = await checkProgram(text);
        const commands = listing.map(([, , command]) => command);
        const length = commands.reduce((sum, command) => sum + command.length, 0);
        const added = isHeld === true ? [HOLD, ...commands, RELEASE] : commands;
        for (const motor of motors) {
            const before = resets ? [] : this.#held.get(motor);
            if (before === undefined || (isHeld === null && length > ONE_MESSAGE_BYTES)) {
                this.#held.delete(motor);
            } else {
                this.#held.set(motor, [...before, ...added].filter((command) => command !== undefined));
            }
        }
    }
}

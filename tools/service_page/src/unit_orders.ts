import type { Bytes } from "./program_host";
import type { AnswerValues, FoundUnit, MessageName, RequestParts } from "./protocol";
import { ALL_MOTORS, MOTORS } from "./protocol";
import type { Simulator } from "./simulator";
import * as messages from "./unit_messages";
import { LineTrouble, NODES_MAX, Refusal, SCANNING, STORING, type Wait } from "./unit_place";
import { COMMANDS_MAX, HOLD, RELEASE, RESET, heldBack, planned, waitsForRelease, type Plan } from "./unit_plan";

const FLAG_OVERFLOW = 3;
const FLAGS: Record<number, string> = { 1: "the value after", 2: "the command" };
const STORE_ERRORS: Record<number, string> = {
    1: "the memory reports an error; the old program stays",
    2: "the program is too long for the memory",
};
const STAND_MS = 30_000;
const POLL_MS = 50;

/** What came of an order: words, and the same as values. */
export interface Got {
    text: string;
    values: AnswerValues;
}

export interface Exchange {
    request: Bytes;
    answer: Bytes;
}

const NOTHING: Exchange = { request: new Uint8Array(), answer: new Uint8Array() };

/** What orders speak through: the unit that the desk is connected to. */
export interface Talk {
    ask(request: Bytes, wait?: Wait, node?: number): Promise<Bytes>;
    /** A unit of another session may be another one. */
    readonly session: number;
    readonly text_bytes_max: number;
    readonly isTwice: boolean;
    tell(done: number, total: number): void;
}

export const pause = (ms: number): Promise<void> => new Promise((take) => self.setTimeout(take, ms));

/** The orders of a page as messages to its unit. */
export class UnitOrders {
    /** The last exchange that was made for an order. */
    last: Exchange = NOTHING;
    readonly #talk: Talk;
    readonly #simulator: Simulator;
    readonly #names: messages.StatusNames;

    constructor(talk: Talk, simulator: Simulator, names: messages.StatusNames) {
        this.#talk = talk;
        this.#simulator = simulator;
        this.#names = names;
    }

    /** Begins a new record of exchanges. */
    forget(): void {
        this.last = NOTHING;
    }

    async ask(message: MessageName, { motor, text, texts, together }: { motor: number } & RequestParts): Promise<Got> {
        switch (message) {
            case "version":
                return this.version();
            case "send":
                return this.#send(motor, text ?? "");
            case "send_all":
                return this.#sendAll(texts ?? {}, together === true);
            case "store":
                return this.#store(motor);
            case "position":
                return this.#positions(motor);
            case "program":
                return this.#read(messages.GET_COMMAND, motor, programOf);
            case "table":
                return this.#read(messages.GET_TABLE, motor, tableOf);
            case "progress":
                return this.#read(messages.GET_PROGRESS, motor, progressOf);
            case "scan":
                return this.#scan();
        }
    }

    /** Resume or reset, all motors. */
    async act(text: string): Promise<Got> {
        await this.#command(ALL_MOTORS, text);
        return { text: text === RESET ? "reset, the program memory is empty" : "told to go on", values: {} };
    }

    /**
     * Changes the speed of those motors that move: to others V would be a command to be stored. In a limit run, and while
     * the motor stops, V does nothing; a speed that was changed shows in the break points of the move.
     */
    async speed(motor: number, value: number): Promise<Got> {
        const { motors } = await this.#status();
        const { session } = this.#talk;
        const moving = numbersOf(motor).filter((each) => motors[each - 1]?.moving && motors[each - 1]?.running);
        const changed: number[] = [];
        for (const each of moving) {
            const before = await this.#points(each);
            this.#requireSession(session);
            await this.#command(each, `V${value}`);
            changed.push(...((await this.#points(each)) === before ? [] : [each]));
        }
        const words = numbersOf(motor).map((each) => {
            if (!moving.includes(each)) {
                return `motor ${each} runs no move: nothing was sent`;
            }
            const kept = `motor ${each} keeps its speed: it is in a limit run, or stops`;
            return changed.includes(each) ? `motor ${each} speed ${value} steps/s` : kept;
        });
        if (changed.length === 0) {
            throw new Refusal(words.join(", "), "a speed is for moves in progress");
        }
        return { text: words.join(", "), values: { speed: value, motors: changed } };
    }

    /** Where the speed of a move changes, to be compared. */
    async #points(motor: number): Promise<string> {
        return messages.hex(await this.#talk.ask(messages.request(messages.GET_TABLE, motor)));
    }

    async version(wait?: Wait): Promise<Got & { values: { version: string; date: string } }> {
        const told = messages.version(await this.#exchange(Uint8Array.of(messages.VERSION), wait));
        return { text: `version ${told.version} of ${told.date}`, values: told };
    }

    async #status(): Promise<messages.Status> {
        return messages.status(await this.#talk.ask(Uint8Array.of(messages.GET_STATUS)), this.#names);
    }

    async #exchange(request: Bytes, wait?: Wait): Promise<Bytes> {
        this.last = { request, answer: NOTHING.answer };
        const answer = await this.#talk.ask(request, wait);
        this.last = { request, answer };
        return answer;
    }

    /** Sends a text as one message; returns whether the program memory has overflowed. */
    async #command(motor: number, text: string): Promise<boolean> {
        const answer = await this.#exchange(messages.request(messages.SET_COMMAND, motor, text));
        const [flag = 0, character = 0] = messages.content(answer, messages.SET_COMMAND, motor);
        const what = FLAGS[flag];
        if (what !== undefined) {
            const shown = String.fromCharCode(character);
            throw new Refusal(`the unit refuses ${what} ${shown} (flag ${flag})`, "nothing of it was stored or run");
        }
        return flag === FLAG_OVERFLOW;
    }

    async #send(motor: number, text: string): Promise<Got> {
        const plan = planned(this.#simulator, text, this.#talk.text_bytes_max);
        await this.#requireRoom(motor, plan);
        const overflow = await this.#sendTexts(motor, plan, 0, plan.texts.length);
        if (plan.alone !== null) {
            return { text: `${plan.alone} sent`, values: { alone: plan.alone } };
        }
        const lost = overflow ? "; the program memory was full, commands were lost" : "";
        const count = plan.texts.length;
        const values = { commands: plan.commands, messages: count, overflow, notes: [] };
        return { text: `${plan.commands} commands in ${count} message${count > 1 ? "s" : ""} sent${lost}`, values };
    }

    /** Sends all texts to one and the same unit; returns whether the program memory has overflowed. */
    async #sendTexts(motor: number, { texts }: Plan, done: number, total: number): Promise<boolean> {
        let overflow = false;
        for (const [index, text] of texts.entries()) {
            const { session } = this.#talk;
            this.#talk.tell(done + index, total);
            overflow = (await this.#command(motor, text)) || overflow;
            if (index > 0) {
                this.#requireSession(session);
            }
        }
        return overflow;
    }

    /** A question begins a new session unseen, in which the unit may be another one. */
    #requireSession(session: number): void {
        if (session !== this.#talk.session) {
            throw new LineTrouble("UnitRestarted", "the unit has restarted", "look at it before you send again");
        }
    }

    /** Sends each motor its own program, or nothing if one of them is wrong. */
    async #sendAll(texts: Record<string, string>, together: boolean): Promise<Got> {
        const plans = Object.entries(texts).map(
            ([motor, text]) => [Number(motor), this.#plannedOf(motor, text, together)] as const,
        );
        for (const [motor, plan] of plans) {
            await this.#requireRoom(motor, plan);
        }
        if (together && plans.length > 1) {
            await this.#requireOthersEmpty(plans.map(([motor]) => motor));
        }
        const total = plans.reduce((sum, [, plan]) => sum + plan.texts.length, 0);
        let [overflow, done] = [false, 0];
        for (const [motor, plan] of plans) {
            overflow = (await this.#sendTexts(motor, plan, done, total)) || overflow;
            done += plan.texts.length;
        }
        if (together) {
            await this.#start(plans.map(([motor]) => motor));
        }
        const sent = Object.fromEntries(plans.map(([motor, plan]) => [String(motor), plan.commands]));
        const words = plans.map(([motor, plan]) => `motor ${motor}: commands ${plan.commands}`).join(", ");
        const start = together ? "started together" : "each runs since it arrived";
        return { text: `${words}; ${start}`, values: { sent, together, overflow, notes: [] } };
    }

    #plannedOf(motor: string, text: string, together: boolean): Plan {
        try {
            const bytes_max = this.#talk.text_bytes_max;
            const plan = planned(this.#simulator, text, bytes_max);
            if (together && plan.plain.length === 0 && !plan.resets) {
                throw new Refusal("there is no program in it", "send it alone");
            }
            return together ? heldBack(plan, bytes_max) : plan;
        } catch (error) {
            if (error instanceof Refusal) {
                const { cause, next, ...place } = error.trouble;
                const advice = `nothing was sent to any motor; ${next}`;
                throw new Refusal(`motor ${motor}: ${cause}`, advice, { ...place, motor: Number(motor) });
            }
            throw error;
        }
    }

    /** `]` for all motors would be stored in their programs, and let one start that waits. */
    async #requireOthersEmpty(motors: number[]): Promise<void> {
        for (const each of MOTORS.filter((motor) => !motors.includes(motor))) {
            const held = await this.#held(each);
            const waits = waitsForRelease(held);
            if (waits || held.some((command) => command !== HOLD && command !== RELEASE)) {
                throw new Refusal(
                    waits
                        ? waiting(each)
                        : `motor ${each} holds another program, and ] to all motors would be added to it`,
                    "nothing was sent to any motor; reset it, or send without starting together",
                );
            }
        }
    }

    /** Lets all motors start, when none of them slows down any more because of `\`. */
    async #start(motors: number[]): Promise<void> {
        const end_ms = performance.now() + STAND_MS;
        const { session } = this.#talk;
        for (const motor of motors) {
            while (messages.table(await this.#talk.ask(messages.request(messages.GET_TABLE, motor)), motor).length > 0) {
                if (performance.now() > end_ms) {
                    const cause = `motor ${motor} still moves, so nothing was started`;
                    throw new Refusal(cause, "the programs wait for ] to all motors");
                }
                await pause(POLL_MS);
            }
        }
        this.#requireSession(session);
        await this.#command(motors.length > 1 ? ALL_MOTORS : (motors[0] ?? ALL_MOTORS), RELEASE);
    }

    /** Refuses to overwrite what is in the memory and may not have run, or to release it. */
    async #requireRoom(motor: number, { texts, commands, plain, resets, alone }: Plan): Promise<void> {
        if (resets || alone !== null || (commands === 1 && plain[0]?.startsWith("V"))) {
            return;
        }
        const { motors, unit } = await this.#status();
        for (const each of numbersOf(motor)) {
            if (messages.isAtRest(motors[each - 1]) && !unit.memory_locked) {
                continue;
            }
            const brackets = texts[0]?.startsWith(HOLD) && plain[0] !== HOLD ? 2 : 0;
            const held = await this.#held(each);
            const room = Math.max(0, COMMANDS_MAX - held.length - brackets);
            const waits = brackets > 0 && waitsForRelease(held);
            if (commands > room || waits) {
                throw new Refusal(
                    waits
                        ? waiting(each)
                        : `the program has ${commands} commands, and the memory of motor ${each} has room for ${room} more`,
                    "nothing was sent; begin it with \\, which stops the motor, or send it when the program there has run",
                );
            }
        }
    }

    /** The commands in the memory of a motor. */
    async #held(motor: number): Promise<string[]> {
        const answer = await this.#talk.ask(messages.request(messages.GET_COMMAND, motor));
        const text = messages.text(answer, messages.GET_COMMAND, motor);
        return this.#simulator.read(text).commands.map((command) => command.text);
    }

    async #store(motor: number): Promise<Got> {
        const stored: Record<string, number> = {};
        for (const each of numbersOf(motor)) {
            stored[each] = (await this.#held(each)).length;
        }
        const answer = await this.#exchange(messages.request(messages.STORE_FLASH, motor), STORING);
        const [error = 0] = messages.content(answer, messages.STORE_FLASH, motor);
        if (error !== 0) {
            const why = STORE_ERRORS[error] ?? "an error that this page does not know";
            throw new Refusal(`the unit could not store the program (error ${error}): ${why}`, "");
        }
        const words = Object.entries(stored).map(([each, count]) => `motor ${each}: ${count} commands stored`);
        return { text: words.join(", "), values: { stored } };
    }

    async #positions(motor: number): Promise<Got> {
        const answer = await this.#exchange(messages.request(messages.GET_POSITION, motor));
        const found = messages.positions(answer, motor);
        const words = Object.entries(found).map(([each, position]) => `motor ${each}: ${position}`);
        return { text: words.join(", "), values: { positions: found } };
    }

    /** Asks for what only one motor can tell; to a question for all of them the unit answers with a complaint. */
    async #read(message: number, motor: number, read: (answer: Uint8Array, motor: number) => Got): Promise<Got> {
        const answer = await this.#exchange(messages.request(message, motor));
        return motor === ALL_MOTORS
            ? { text: messages.text(answer, message, motor).trim(), values: {} }
            : read(answer, motor);
    }

    /** Asks all addresses who is there; nothing but Version is sent. */
    async #scan(): Promise<Got> {
        const found: FoundUnit[] = [];
        for (let node = 1; node <= NODES_MAX; node += 1) {
            this.#talk.tell(node - 1, NODES_MAX);
            const unit = await this.#lookFor(node);
            if (unit !== null) {
                found.push(unit);
            }
        }
        const nodes = found.map(({ node }) => node).join(", ");
        return { text: `units that answer: ${nodes || "none"}`, values: { found } };
    }

    async #lookFor(node: number): Promise<FoundUnit | null> {
        try {
            const answer = await this.#talk.ask(Uint8Array.of(messages.VERSION), SCANNING, node);
            const remark = this.#talk.isTwice ? "answers twice: two units with this address?" : "";
            return { node, ...messages.version(answer), remark };
        } catch (error) {
            const kind = error instanceof Refusal ? error.trouble.kind : "";
            if (kind === "NoAnswer") {
                return null;
            }
            if (kind === "GarbledAnswer" || kind === "WrongAnswer") {
                return { node, version: null, date: null, remark: "damaged answers: two units with this address?" };
            }
            throw error;
        }
    }
}

function numbersOf(motor: number): number[] {
    return motor === ALL_MOTORS ? [...MOTORS] : [motor];
}

function waiting(motor: number): string {
    return `motor ${motor} waits at [ in another program and would start too`;
}

function programOf(answer: Uint8Array, motor: number): Got {
    return { text: messages.text(answer, messages.GET_COMMAND, motor), values: {} };
}

function tableOf(answer: Uint8Array, motor: number): Got {
    const points = messages.table(answer, motor);
    const words = points.map(([step, speed]) => `(${step}; ${speed})`).join(" ");
    return { text: words || "no move in progress", values: { points } };
}

function progressOf(answer: Uint8Array, motor: number): Got {
    const told = messages.progress(answer, motor);
    return { text: `${told.steps} steps made, command ${told.command}`, values: told };
}

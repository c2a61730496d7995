import type { Bytes } from "./program_host";
import type { AnswerValues, MessageName, RequestParts, Trouble } from "./protocol";
import { ALL_MOTORS, MOTORS } from "./protocol";
import { TEXT_MAX, type Checked, type Simulator } from "./simulator";
import * as messages from "./unit_messages";

const COMMANDS_MAX = 700;
const RESET = "\\";
/** What acts only alone in a message. */
const ALONE = ["K", "C75"];
const FLAG_OVERFLOW = 3;
const FLAGS: Record<number, string> = { 1: "the value after", 2: "the command" };
const STORE_ERRORS: Record<number, string> = {
    1: "the memory reports an error; the old program stays",
    2: "the program is too long for the memory",
};

/** It was not done; the trouble is why, and what to do. */
export class Refusal extends Error {
    readonly trouble: Trouble;

    constructor(cause: string, next: string, place: Partial<Trouble> = {}) {
        super(cause);
        this.trouble = { kind: "Failure", cause, next, ...place };
    }
}

interface Got {
    text: string;
    values: AnswerValues;
}

/** A program without errors as it goes to the unit. */
interface Plan {
    text: string;
    commands: number;
    resets: boolean;
    /** The one command that acts only alone in a message, if it is that. */
    alone: string | null;
}

interface Exchange {
    request: Bytes;
    answer: Bytes;
}

const NOTHING: Exchange = { request: new Uint8Array(), answer: new Uint8Array() };

type Asks = (request: Bytes) => Bytes;

/**
 * The orders of a page as messages to its unit. There is no line between them, so a program goes in one message, and
 * the unit's time stands while an order is obeyed.
 */
export class UnitOrders {
    /** The last exchange that was made for an order. */
    last: Exchange = NOTHING;
    readonly #ask: Asks;
    readonly #simulator: Simulator;
    readonly #names: messages.StatusNames;

    constructor(ask: Asks, simulator: Simulator, names: messages.StatusNames) {
        this.#ask = ask;
        this.#simulator = simulator;
        this.#names = names;
    }

    /** Begins a new record of exchanges. */
    forget(): void {
        this.last = NOTHING;
    }

    ask(message: MessageName, { motor, text, texts, together }: { motor: number } & RequestParts): Got {
        switch (message) {
            case "version":
                return this.#version();
            case "send":
                return this.#send(motor, text ?? "");
            case "send_all":
                return this.#sendAll(texts ?? {}, together === true);
            case "store":
                return this.#store(motor);
            case "position":
                return this.#positions(motor);
            case "program":
                return this.#read(messages.GET_COMMAND, motor, (answer) => ({ text: messages.content(answer), values: {} }));
            case "table":
                return this.#read(messages.GET_TABLE, motor, tableOf);
            case "progress":
                return this.#read(messages.GET_PROGRESS, motor, progressOf);
            case "scan":
                throw new Refusal("the unit in this page has no line", "there is nobody else to be found");
        }
    }

    /** Resume or reset, all motors. */
    act(text: string): Got {
        this.#command(ALL_MOTORS, text);
        return { text: text === RESET ? "reset, the program memory is empty" : "told to go on", values: {} };
    }

    /** Changes the speed of those motors that move: to others V would be a command to be stored. */
    speed(motor: number, value: number): Got {
        const { motors } = this.status();
        const moving = numbersOf(motor).filter((each) => motors[each - 1]?.moving && motors[each - 1]?.running);
        const words = numbersOf(motor).map((each) =>
            moving.includes(each)
                ? `motor ${each} speed ${value} steps/s`
                : `motor ${each} runs no move: nothing was sent`,
        );
        if (moving.length === 0) {
            throw new Refusal(words.join(", "), "a speed is for moves in progress");
        }
        moving.forEach((each) => this.#command(each, `V${value}`));
        return { text: words.join(", "), values: { speed: value, motors: moving } };
    }

    /** What the unit is like now; no order, so that it leaves no record. */
    status(): messages.Status {
        return messages.status(this.#ask(Uint8Array.of(messages.GET_STATUS)), this.#names);
    }

    #exchange(request: Bytes): Bytes {
        const answer = this.#ask(request);
        this.last = { request, answer };
        return answer;
    }

    #version(): Got {
        const told = messages.version(this.#exchange(Uint8Array.of(messages.VERSION)));
        return { text: `version ${told.version} of ${told.date}`, values: told };
    }

    /** Sends a text as one message; returns whether the program memory has overflowed. */
    #command(motor: number, text: string): boolean {
        const [flag = 0, character = 0] = this.#exchange(messages.request(messages.SET_COMMAND, motor, text)).subarray(2);
        const what = FLAGS[flag];
        if (what !== undefined) {
            const shown = String.fromCharCode(character);
            throw new Refusal(`the unit refuses ${what} ${shown} (flag ${flag})`, "nothing of it was stored or run");
        }
        return flag === FLAG_OVERFLOW;
    }

    #send(motor: number, text: string): Got {
        const plan = this.#planned(text);
        this.#requireRoom(motor, plan);
        const overflow = this.#command(motor, plan.text);
        if (plan.alone !== null) {
            return { text: `${plan.alone} sent`, values: { alone: plan.alone } };
        }
        const lost = overflow ? "; the program memory was full, commands were lost" : "";
        const values = { commands: plan.commands, messages: 1, overflow, notes: [] };
        return { text: `${plan.commands} commands in 1 message sent${lost}`, values };
    }

    /** Sends each motor its own program, or nothing if one of them is wrong. */
    #sendAll(texts: Record<string, string>, together: boolean): Got {
        const plans = Object.entries(texts).map(([motor, text]) => [Number(motor), this.#plannedOf(motor, text)] as const);
        plans.forEach(([motor, plan]) => this.#requireRoom(motor, plan));
        if (together) {
            this.#requireRest(plans);
        }
        let overflow = false;
        for (const [motor, plan] of plans) {
            overflow = this.#command(motor, plan.text) || overflow;
        }
        const sent = Object.fromEntries(plans.map(([motor, plan]) => [String(motor), plan.commands]));
        const words = plans.map(([motor, plan]) => `motor ${motor}: commands ${plan.commands}`).join(", ");
        const start = together ? "started together" : "each runs since it arrived";
        return { text: `${words}; ${start}`, values: { sent, together, overflow, notes: [] } };
    }

    #plannedOf(motor: string, text: string): Plan {
        try {
            return this.#planned(text);
        } catch (error) {
            if (error instanceof Refusal) {
                const { cause, next, ...place } = error.trouble;
                const advice = `nothing was sent to any motor; ${next}`;
                throw new Refusal(`motor ${motor}: ${cause}`, advice, { ...place, motor: Number(motor) });
            }
            throw error;
        }
    }

    /** They get their programs at the same tick of the unit; those that stand begin at it, too. */
    #requireRest(plans: (readonly [number, Plan])[]): void {
        const { motors } = this.status();
        for (const [number, { resets }] of plans) {
            const motor = motors[number - 1];
            if (motor?.moving || (!resets && !isAtRest(motor))) {
                throw new Refusal(
                    `motor ${number} has not come to rest, so the programs cannot start together`,
                    "nothing was sent to any motor; press STOP and wait until it stands, or send without starting together",
                );
            }
        }
    }

    #planned(text: string): Plan {
        const checked = this.#checked(text);
        const all = checked.commands.map((command) => command.text);
        const alone = all.length === 1 && ALONE.includes(all[0] ?? "") ? (all[0] ?? null) : null;
        const last = all.lastIndexOf(RESET);
        const sent = all.slice(Math.max(last, 0)).join("");
        if (alone === null && last < 0 && checked.stored === 0) {
            throw new Refusal("there is nothing in it to be sent", "write a command");
        }
        if (checked.stored > COMMANDS_MAX) {
            const cause = `the program has ${checked.stored} commands, and the memory holds ${COMMANDS_MAX}`;
            throw new Refusal(`${cause}; nothing was sent`, "make it shorter");
        }
        if (sent.length > messages.TEXT_BYTES_MAX) {
            const cause = `the program has ${sent.length} bytes, and the unit in this page takes ${messages.TEXT_BYTES_MAX}`;
            throw new Refusal(`${cause}; nothing was sent`, "make it shorter");
        }
        return { text: sent, commands: checked.stored, resets: last >= 0, alone };
    }

    #checked(text: string): Checked {
        if (text.length > TEXT_MAX) {
            throw new Refusal("text is too long", `${TEXT_MAX} characters are the most`, { kind: "TooLarge" });
        }
        const checked = this.#simulator.read(text);
        const first = checked.problems.find(({ severity }) => severity === "error");
        if (first) {
            const { line, column } = first;
            throw new Refusal(first.message, "correct it, then send again", { line, column });
        }
        return checked;
    }

    /** Refuses to overwrite what is in the memory and may not have run. */
    #requireRoom(motor: number, { text, commands, resets, alone }: Plan): void {
        if (resets || alone !== null || (commands === 1 && text.startsWith("V"))) {
            return;
        }
        const { motors, unit } = this.status();
        for (const each of numbersOf(motor)) {
            if (isAtRest(motors[each - 1]) && !unit.memory_locked) {
                continue;
            }
            const room = Math.max(0, COMMANDS_MAX - this.#held(each));
            if (commands > room) {
                throw new Refusal(
                    `the program has ${commands} commands, and the memory of motor ${each} has room for ${room} more`,
                    "nothing was sent; begin it with \\, which stops the motor, or send it when the program there has run",
                );
            }
        }
    }

    /** How many commands the memory of a motor holds. */
    #held(motor: number): number {
        const answer = this.#ask(messages.request(messages.GET_COMMAND, motor));
        return this.#simulator.read(messages.content(answer)).commands.length;
    }

    #store(motor: number): Got {
        const stored = Object.fromEntries(numbersOf(motor).map((each) => [String(each), this.#held(each)]));
        const [error = 0] = this.#exchange(messages.request(messages.STORE_FLASH, motor)).subarray(2);
        if (error !== 0) {
            const why = STORE_ERRORS[error] ?? "an error that this page does not know";
            throw new Refusal(`the unit could not store the program (error ${error}): ${why}`, "");
        }
        const words = Object.entries(stored).map(([each, count]) => `motor ${each}: ${count} commands stored`);
        return { text: words.join(", "), values: { stored } };
    }

    #positions(motor: number): Got {
        const found = messages.positions(this.#exchange(messages.request(messages.GET_POSITION, motor)), motor);
        const words = Object.entries(found).map(([each, position]) => `motor ${each}: ${position}`);
        return { text: words.join(", "), values: { positions: found } };
    }

    /** Asks for what only one motor can tell; to a question for all of them the unit answers with a complaint. */
    #read(message: number, motor: number, read: (answer: Uint8Array) => Got): Got {
        const answer = this.#exchange(messages.request(message, motor));
        return motor === ALL_MOTORS ? { text: messages.content(answer).trim(), values: {} } : read(answer);
    }
}

function numbersOf(motor: number): number[] {
    return motor === ALL_MOTORS ? [...MOTORS] : [motor];
}

/** Whether a motor stands, and all that is stored has run. */
function isAtRest(motor: messages.Status["motors"][number] | undefined): boolean {
    return motor !== undefined && !(motor.moving || motor.running || motor.stopped || motor.failed || motor.ended);
}

function tableOf(answer: Uint8Array): Got {
    const points = messages.table(answer);
    const words = points.map(([step, speed]) => `(${step}; ${speed})`).join(" ");
    return { text: words || "no move in progress", values: { points } };
}

function progressOf(answer: Uint8Array): Got {
    const told = messages.progress(answer);
    return { text: `${told.steps} steps made, command ${told.command}`, values: told };
}

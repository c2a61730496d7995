import type { Bytes } from "../../program_host";
import { LineTrouble, Refusal } from "../../unit_place";
import type { Bus } from "./bus";
import { ANSWERED, DAMAGED, ECHOED, SILENT, WAITS } from "./master";
import * as modbus from "./modbus";

/** How long the first byte of an answer may take; longer than for a command, as a page and its worker may be busy. */
const ANSWER_MS = 400;
/** How often a request is sent at the most. */
const SENT_MAX = 4;

const CHECK_LINE = "are address, rate and format right, is the unit on, and are A and B not swapped?";
const CHECK_FORM = "check rate and format of the line, cable and terminators";
const NOT_BEGUN = new Refusal("this took too long, and it was not told to move", "look at the unit, then ask again", { kind: "NotBegun" });
const NOT_REPEATED = "it was not told again to move, as that would be late; whether it has begun to is not known";
const ENDS: Record<number, (where: string) => LineTrouble> = {
    [SILENT]: (where) => new LineTrouble("NoAnswer", `${where} does not answer`, CHECK_LINE),
    [ECHOED]: (where) => new LineTrouble("NoAnswer", `${where} does not answer, only the adapter's echo comes back`, CHECK_LINE),
    [DAMAGED]: (where) => new LineTrouble("GarbledAnswer", `${where}: what comes is damaged, or no Modbus`, CHECK_FORM),
};

/** Requests to a unit and their answers: the master of the line does it, here are the port and the words for what goes wrong. */
export class Wire {
    readonly bus: Bus;
    readonly node: number;
    /** How often a request may be sent. */
    tries = SENT_MAX;
    /** When it is, nothing is sent that may begin a motion, nor repeated. */
    isLate = (): boolean => false;
    /** Requests sent, repeats among them. */
    requests = 0;
    repeats = 0;
    readonly #look: () => void;
    readonly #exceptions: Record<number, string>;

    /** `look` is called before anything is sent; what it throws ends the request. `exceptions`: their words by number. */
    constructor(bus: Bus, node: number, look: () => void, exceptions: Record<number, string>) {
        this.bus = bus;
        this.node = node;
        this.#look = look;
        this.#exceptions = exceptions;
    }

    /** Where the unit is, for messages. */
    get name(): string {
        return `${this.bus.port}, unit ${this.node}`;
    }

    async read(first: number, count: number): Promise<number[]> {
        return this.#wordsIn(await this.#ask(modbus.readRequest(first, count), `reading register ${first}`), count);
    }

    /** Writes registers, all of them or none. */
    async write(first: number, words: readonly number[]): Promise<void> {
        await this.#ask(modbus.writeRequest(first, words), `writing register ${first}`);
    }

    /** Writes registers, then reads others; also whether the request had to be repeated. `begins`: it may begin a motion. */
    async writeAndRead(first: number, words: readonly number[], read: number, count: number, begins = false): Promise<[number[], boolean]> {
        const before = this.repeats;
        const answer = await this.#ask(modbus.writeReadRequest(first, words, read, count), `writing register ${first}`, begins);
        return [this.#wordsIn(answer, count), this.repeats !== before];
    }

    /** Vendor, product and version. */
    async identify(): Promise<string[]> {
        return modbus.textsIn(await this.#ask(modbus.identifyRequest(), "the identification"));
    }

    #wordsIn(answer: Bytes, count: number): number[] {
        const words = modbus.wordsIn(answer, count);
        if (words === null) {
            throw wrongUnit(this.name);
        }
        return words;
    }

    /** Sends a request until it is answered. */
    async #ask(request: Bytes, what: string, begins = false): Promise<Bytes> {
        const { master } = this.bus;
        master.ask(this.node, request, ANSWER_MS, this.tries);
        let end = WAITS;
        for (let sent = 0; end === WAITS; ) {
            master.take(await this.bus.read(master.left_ms));
            end = master.poll();
            const { out } = master;
            if (out.length > 0) {
                this.#look();
                if (begins && this.isLate()) {
                    throw sent > 0 ? new LineTrouble("NoAnswer", `${this.name} does not answer`, NOT_REPEATED) : NOT_BEGUN;
                }
                this.requests += 1;
                this.repeats += sent > 0 ? 1 : 0;
                sent += 1;
                this.bus.write(out);
                master.noteWritten();
            }
        }
        const trouble = ENDS[end];
        if (trouble !== undefined) {
            throw trouble(this.name);
        }
        return end === ANSWERED ? master.answer : this.#refused(what, master.answer[1] ?? 0);
    }

    #refused(what: string, exception: number): never {
        const why = this.#exceptions[exception] ?? "an exception that this unit does not have";
        throw new ExceptionRefusal(`${this.name}: ${what}: ${why} (exception ${exception})`);
    }
}

/** Lets others work for a while. */
export const rest = (ms: number): Promise<void> => new Promise((take) => self.setTimeout(take, ms));

/** A request was answered by an exception, and has changed nothing. */
export class ExceptionRefusal extends Refusal {
    constructor(cause: string) {
        super(cause, "", { kind: "RequestRefused" });
    }
}

export const wrongUnit = (where: string): LineTrouble =>
    new LineTrouble("WrongUnit", `${where}: something answers that is no positioning unit`, "is it another?");

import { LineTrouble, Refusal } from "../../unit_place";
import type { Bytes } from "../../program_host";
import { joined, type Bus } from "./bus";
import * as modbus from "./modbus";
import { register } from "./table";

/** How long the first byte of an answer may take; longer than for a command, as a page and its worker may be busy. */
const ANSWER_MS = 400;
const STORE_MS = 2200;
/** Silence that long in an answer is its end, whole or not. */
const REST_MS = 150;
/** After a request that was sent again, or had no answer, one may come yet; so long it is waited for. */
const LATE_MS = 150;
/** However much others say, or a line hums: a request goes out after so long, and what comes then is an answer or none. */
const OTHERS_MS_MAX = 500;
const FRAME_BYTES_MAX = 256;
const GAP_CHARACTERS = 3.5;
const GAP_MS_MIN = 1.75;
/** How often a request is sent at the most. */
const SENT_MAX = 4;

const CHECK_LINE = "are address, rate and format right, is the unit on, and are A and B not swapped?";

/**
 * Requests to a unit and their answers. Repeating is safe: the unit executes no instruction word twice, and all else that
 * is written is the same again.
 */
export class Wire {
    readonly bus: Bus;
    readonly node: number;
    /** How often a request may be sent. */
    tries = SENT_MAX;
    /** Requests sent, repeats among them. */
    requests = 0;
    repeats = 0;
    readonly #look: () => void;
    readonly #exceptions: Record<number, string>;
    #isOwed = false;
    #quiet_ms = 0;

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
        await this.#ask(modbus.writeRequest(first, words), `writing register ${first}`, first === register("STORE").number);
    }

    /** Writes registers, then reads others; also whether the request had to be repeated. */
    async writeAndRead(first: number, words: readonly number[], read: number, count: number): Promise<[number[], boolean]> {
        const before = this.repeats;
        const answer = await this.#ask(modbus.writeReadRequest(first, words, read, count), `writing register ${first}`);
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
    async #ask(content: number[], what: string, isStore = false): Promise<Bytes> {
        const frame = modbus.framed(this.node, content);
        for (let sent = 1; ; sent += 1) {
            this.#look();
            this.requests += 1;
            this.repeats += sent > 1 ? 1 : 0;
            await this.#beQuiet();
            this.bus.write(frame);
            const answer = await this.#hear(frame, isStore ? STORE_MS : 0);
            this.#isOwed = sent > 1 || answer instanceof LineTrouble;
            if (!(answer instanceof LineTrouble)) {
                return this.#accepted(answer, what);
            }
            if (sent >= this.tries) {
                throw answer;
            }
        }
    }

    #accepted(answer: Bytes, what: string): Bytes {
        const [code = 0, exception = 0] = answer;
        if (code & modbus.REFUSED) {
            const why = this.#exceptions[exception] ?? "an exception that this unit does not have";
            throw new ExceptionRefusal(`${this.name}: ${what}: ${why} (exception ${exception})`);
        }
        return answer;
    }

    /** Drops what has come too late, and leaves the silence that ends a frame for all units. */
    async #beQuiet(): Promise<void> {
        const end_ms = performance.now() + OTHERS_MS_MAX;
        while ((await this.bus.read(this.#isOwed ? LATE_MS : 0)).length > 0 && performance.now() < end_ms);
        this.#isOwed = false;
        const gap_ms = Math.max(GAP_CHARACTERS * this.bus.byte_ms, GAP_MS_MIN);
        const left_ms = this.#quiet_ms + gap_ms - performance.now();
        if (left_ms > 0) {
            await rest(left_ms);
        }
    }

    async #hear(frame: Bytes, more_ms: number): Promise<Bytes | LineTrouble> {
        let heard: Bytes = new Uint8Array();
        let end_ms = performance.now() + ANSWER_MS + frame.length * this.bus.byte_ms + more_ms;
        const last_ms = end_ms + FRAME_BYTES_MAX * this.bus.byte_ms + OTHERS_MS_MAX;
        for (let left_ms = end_ms - performance.now(); left_ms > 0; left_ms = end_ms - performance.now()) {
            const data = await this.bus.read(left_ms);
            heard = joined(heard, data);
            const isEcho = heard.length <= frame.length && heard.every((byte, at) => byte === frame[at]);
            const own = startsWith(heard, frame) ? heard.slice(frame.length) : heard;
            const answer = modbus.findAnswer(own, this.node, frame[1] ?? 0);
            this.#quiet_ms = performance.now();
            if (answer !== null) {
                return answer;
            }
            if (data.length > 0 && !isEcho) {
                end_ms = Math.min(last_ms, performance.now() + REST_MS + heard.length * this.bus.byte_ms);
            }
        }
        return this.#failed(heard, frame);
    }

    #failed(heard: Bytes, frame: Bytes): LineTrouble {
        if (heard.length === 0) {
            return new LineTrouble("NoAnswer", `${this.name} does not answer`, CHECK_LINE);
        }
        if (heard.length === frame.length && startsWith(heard, frame)) {
            return new LineTrouble("NoAnswer", `${this.name} does not answer, only the adapter's echo comes back`, CHECK_LINE);
        }
        const next = "check rate and format of the line, cable and terminators";
        return new LineTrouble("GarbledAnswer", `${this.name}: what comes is damaged, or no Modbus`, next);
    }
}

const startsWith = (data: Bytes, start: Bytes): boolean =>
    data.length >= start.length && start.every((byte, at) => data[at] === byte);

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

import type { Bytes } from "../../program_host";
import { instantiated, ns } from "../../unit_module";
import { Refusal } from "../../unit_place";
import { answerOf, bytesOf, type Answer } from "./answers";
import { Executed, type ExecutedExports } from "./executed";

/** LINES_GVE134_HEARD_BYTES */
const HEARD_BYTES = 4096;
/** Who was not looked at for so long has slept. */
const SLEPT_MS = 2000;

/** What is asked for: enum gve_master_kind of tools/gve134_master/gve_master.h. */
export const ASK = 0;
export const PACKET = 1;
export const PACKET_ONCE = 2;
export const LONG = 3;
export const RESET = 4;
export const CONNECT = 5;
export const HALT = 6;
export const OWN = 7;

/** How it has ended: the first of enum gve_master_end. */
const WAITS = 0;
export const ANSWERED = 1;

/** What the module gve134-unit exports of a line; see tools/lines/lines_gve134.h. */
interface Exports extends ExecutedExports {
    lines_gve134_begin: (baud: number, sums: number) => number;
    lines_gve134_request: (line: number) => number;
    lines_gve134_heard: (line: number) => number;
    lines_gve134_ask: (line: number, kind: number, length: number, wait_ms: bigint, now: bigint) => void;
    lines_gve134_take: (line: number, length: number, now: bigint) => void;
    lines_gve134_poll: (line: number, now: bigint) => number;
    lines_gve134_forget: (line: number) => void;
    lines_gve134_until: (line: number) => bigint;
    lines_gve134_out: (line: number) => number;
    lines_gve134_take_out: (line: number) => number;
    lines_gve134_digit: (line: number) => number;
    lines_gve134_values: (line: number) => number;
    lines_gve134_other: (line: number) => number;
    lines_gve134_version: (line: number) => number;
    lines_gve134_restarted: (line: number) => number;
    lines_gve134_others: (line: number) => number;
}

/** Where bytes go; those that come are given to the wire. */
export interface BytePort {
    readonly name: string;
    readonly isVirtual: boolean;
    readonly baud: number;
    /** For how long in all the time of a virtual unit has stood. */
    readonly stood_s?: number;
    write(data: Bytes): void;
}

/** A line with a unit: the master of tools/gve134_master, and the bytes of a port. */
export class Wire {
    port: BytePort;
    /** Of the job that was begun last. */
    readonly executed: Executed;
    /** Looked at again and again while something is waited for; may throw what ends that. */
    look: () => void = () => undefined;
    /** Told of every request: what is sent, and the answer if any came. */
    onSent: (commands: string[]) => void = () => undefined;
    onAnswer: (commands: string[], answer: Answer | null) => void = () => undefined;
    /** The unit may have executed what was not sent from here. */
    onLost: () => void = () => undefined;
    readonly #exports: Exports;
    readonly #line: number;
    #wake: (() => void) | null = null;
    #stirred_ms = Date.now();
    #slept_ms = 0;

    constructor(bytes: Bytes, port: BytePort) {
        this.port = port;
        this.#exports = instantiated<Exports>(bytes);
        this.#line = this.#exports.lines_gve134_begin(port.baud, 1);
        if (this.#line === 0) {
            throw new Error("there is not memory enough for the line");
        }
        this.executed = new Executed(this.#exports);
    }

    /** The unit's answer to ?. */
    get version(): string {
        return this.#text(this.#exports.lines_gve134_version(this.#line));
    }

    /** Whether the unit was found to have started anew when it was connected to again. */
    get restarted(): boolean {
        return this.#exports.lines_gve134_restarted(this.#line) !== 0;
    }

    /** What another program was found to have done then, as an end of a request; 0: nothing. */
    get others(): number {
        return this.#exports.lines_gve134_others(this.#line);
    }

    /** What another device has answered. */
    get other(): string {
        return this.#text(this.#exports.lines_gve134_other(this.#line));
    }

    /** The answer to the last request. */
    get answer(): Answer {
        const { lines_gve134_digit, lines_gve134_values } = this.#exports;
        return answerOf(lines_gve134_digit(this.#line), this.#text(lines_gve134_values(this.#line)));
    }

    /** Bytes have come. */
    take(data: Uint8Array): void {
        const { memory, lines_gve134_heard, lines_gve134_take } = this.#exports;
        for (let at = 0; at < data.length; at += HEARD_BYTES) {
            const part = data.subarray(at, at + HEARD_BYTES);
            new Uint8Array(memory.buffer, lines_gve134_heard(this.#line), part.length).set(part);
            lines_gve134_take(this.#line, part.length, this.#now);
        }
        this.poke();
    }

    /** Called every few milliseconds. It goes by the date, as other clocks may stand while the computer sleeps. */
    stir(): void {
        const now_ms = Date.now();
        const passed_ms = now_ms - this.#stirred_ms;
        this.#slept_ms += passed_ms > SLEPT_MS ? passed_ms : 0;
        this.#stirred_ms = now_ms;
    }

    /** For how long nobody has looked, since this was asked last. */
    takeSlept_s(): number {
        this.stir();
        const slept_ms = this.#slept_ms;
        this.#slept_ms = 0;
        return Math.round(slept_ms / 1000);
    }

    /** Something has happened at which a wait is to look. */
    poke(): void {
        this.#wake?.();
    }

    /** How a request has ended. `wait_ms`: for the axes to stand. */
    async ask(kind: number, commands: string[], wait_ms = 0): Promise<number> {
        const { memory, lines_gve134_request, lines_gve134_ask, lines_gve134_forget } = this.#exports;
        const text = bytesOf(commands);
        if (text === null) {
            throw new Refusal(`${commands.length} commands are too many for a packet`, "nothing was sent");
        }
        new Uint8Array(memory.buffer, lines_gve134_request(this.#line), text.length).set(text);
        lines_gve134_ask(this.#line, kind, text.length, BigInt(wait_ms), this.#now);
        let end = WAITS;
        this.onSent(commands);
        try {
            await this.#until(() => {
                end = this.#poll();
                return end === WAITS ? this.#left_ms : 0;
            });
        } catch (error) {
            lines_gve134_forget(this.#line);
            throw error;
        } finally {
            this.onAnswer(commands, end === ANSWERED ? this.answer : null);
        }
        return end;
    }

    /** Waits; what comes meanwhile is no answer to anything. */
    pause(wait_ms: number): Promise<void> {
        const until_ms = performance.now() + wait_ms;
        return this.#until(() => until_ms - performance.now());
    }

    /** Looks whenever something has happened, until no time is left. */
    #until(left_ms: () => number): Promise<void> {
        return new Promise((end, fail) => {
            let timer: ReturnType<typeof setTimeout> | undefined;
            const look = (): void => {
                clearTimeout(timer);
                try {
                    this.look();
                    const wait_ms = left_ms();
                    if (wait_ms > 0) {
                        timer = setTimeout(look, wait_ms);
                        return;
                    }
                    end();
                } catch (error) {
                    fail(error);
                }
                this.#wake = null;
            };
            this.#wake = look;
            look();
        });
    }

    #poll(): number {
        const { memory, lines_gve134_poll, lines_gve134_out, lines_gve134_take_out } = this.#exports;
        const end = lines_gve134_poll(this.#line, this.#now);
        const length = lines_gve134_take_out(this.#line);
        if (length > 0) {
            this.port.write(new Uint8Array(memory.buffer, lines_gve134_out(this.#line), length).slice());
        }
        return end;
    }

    /** Until the next look is due, and more than nothing. */
    get #left_ms(): number {
        return Math.max(1, Math.ceil(Number(this.#exports.lines_gve134_until(this.#line) - this.#now) / 1e6));
    }

    get #now(): bigint {
        return ns(performance.now());
    }

    #text(place: number): string {
        const bytes = new Uint8Array(this.#exports.memory.buffer, place);
        return String.fromCharCode(...bytes.subarray(0, bytes.indexOf(0)));
    }
}

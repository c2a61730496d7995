import type { Bytes } from "../../program_host";
import { addressed, encoded, fits, formOf, parsed, type Answer } from "./answers";

export const PATIENCE_MS = 500;
/** After so much silence no packet is open, and nothing is thrown away any more. */
export const PACKET_OVER_MS = 1200;
export const MEMORY_MS = 2500;
const GAP_MS = 100;
/** Between two parts of an answer: what a converter makes of them. */
const CUT_MS = 30;
const BITS_PER_BYTE = 10;
const LINE_BYTES_MAX = 4096;
/** What a unit without checksums answers to a command with one. */
export const BARE = /^[24AC]$/;

/** Where bytes go; those that come are given to the wire. */
export interface BytePort {
    readonly name: string;
    readonly isVirtual: boolean;
    readonly baud: number;
    /** For how long in all the time of a virtual unit has stood. */
    readonly stood_s?: number;
    write(data: Bytes): void;
}

/** What is sent at once and has one answer; `counts` commands if it comes whole. */
export interface Request {
    commands: string[];
    form: RegExp;
    counts: number;
    patience_ms: number;
}

export function requestOf(command: string, patience_ms = PATIENCE_MS): Request {
    const counts = /^[@>]/.test(addressed(command).slice(1)) ? 0 : 1;
    return { commands: [command], form: formOf(command), counts, patience_ms };
}

/** Commands C and B that are taken together or not at all. */
export function packetOf(commands: string[]): Request {
    const whole = ["*S", ...commands, `*E${commands.length}`];
    return { commands: whole, form: new RegExp(`^(0|${commands.length})$`), counts: whole.length, patience_ms: PACKET_OVER_MS };
}

export const encodedRequest = ({ commands }: Request, sums: boolean): string =>
    commands.map((command) => encoded(command, sums)).join("");

/** What has come since a request was sent, and was no answer to it. */
export interface Heard {
    damaged: number;
    /** What was sent came back. */
    echoes: number;
    /** An answer of a unit without checksums. */
    bare: boolean;
    /** The values of an answer to something else. */
    other: string;
}

const nothing = (): Heard => ({ damaged: 0, echoes: 0, bare: false, other: "" });

/**
 * Bytes of the line: requests out, and out of what comes back the answer to each. A line that is damaged ends a wait: it
 * was the answer, as only one is under way. The rest of a line that had begun to come before a request went out is none.
 */
export class Wire {
    readonly port: BytePort;
    sums = true;
    heard = nothing();
    /** Looked at again and again while something is waited for; may throw what ends that. */
    look: () => void = () => undefined;
    /** Told of every exchange: what is sent, and the answer if any came. */
    onSent: (commands: string[]) => void = () => undefined;
    onAnswer: (commands: string[], answer: Answer | null) => void = () => undefined;
    #text = "";
    #sent = "";
    /** A line had begun to come when a request went out: until then its rest can come. */
    #cut_until = -Infinity;
    #wake: (() => void) | null = null;

    constructor(port: BytePort) {
        this.port = port;
    }

    /** Bytes have come. */
    take(data: Uint8Array): void {
        this.#text += String.fromCharCode(...data.filter((each) => each !== 0x0a));
        this.poke();
    }

    /** Something has happened at which a wait is to look. */
    poke(): void {
        this.#wake?.();
    }

    /** Sends once and waits; null: nothing came, or nothing that could be read. */
    async exchange(request: Request): Promise<Answer | null> {
        const text = encodedRequest(request, this.sums);
        this.write(text);
        const on_line_ms = (1000 * BITS_PER_BYTE * text.length) / this.port.baud;
        this.onSent(request.commands);
        const answer = await this.wait(request.form, on_line_ms + request.patience_ms);
        this.onAnswer(request.commands, answer);
        return answer;
    }

    /** Sends; what has come before that is no answer to it. */
    write(text: string): void {
        this.look();
        if (this.#text !== "") {
            this.#cut_until = this.#text.endsWith("\r") ? -Infinity : performance.now() + CUT_MS;
        }
        this.#text = "";
        this.heard = nothing();
        this.#sent = text;
        this.send(text);
    }

    /** Sends beside what is waited for. */
    send(text: string): void {
        this.port.write(Uint8Array.from(text, (letter) => letter.charCodeAt(0)));
    }

    /** The first answer of a form; null: there is none in time, or it was damaged. */
    async wait(form: RegExp | null, wait_ms: number): Promise<Answer | null> {
        let until = performance.now() + wait_ms;
        const last = until + GAP_MS;
        for (let left = wait_ms; left > 0; left = until - performance.now()) {
            for (const line of await this.lines(left)) {
                const answer = parsed(line, this.sums);
                if (form === null) {
                    continue;
                }
                if (answer !== null && fits(answer, form)) {
                    return answer;
                }
                if (answer !== null) {
                    this.heard.other = answer.values;
                } else if (this.#isDamage(line)) {
                    return null;
                }
            }
            if (this.#text !== "") {
                until = Math.min(last, Math.max(until, performance.now() + GAP_MS));
            }
        }
        this.heard.damaged += this.#text === "" ? 0 : 1;
        return null;
    }

    /** Waits; what comes meanwhile is no answer to anything. */
    async pause(wait_ms: number): Promise<void> {
        await this.wait(null, wait_ms);
    }

    /** The lines that come whole, as soon as there is one or the time is over. */
    async lines(wait_ms: number): Promise<string[]> {
        this.look();
        if (!this.#text.includes("\r")) {
            await new Promise<void>((end) => {
                const timer = setTimeout(end, wait_ms);
                this.#wake = () => {
                    clearTimeout(timer);
                    end();
                };
            });
            this.#wake = null;
            this.look();
        }
        const lines = this.#text.split("\r");
        this.#text = (lines.pop() ?? "").slice(-LINE_BYTES_MAX);
        if (lines.length > 0 && performance.now() < this.#cut_until) {
            this.#cut_until = -Infinity;
            if (parsed(lines[0] ?? "", true) === null) {
                lines.shift();
            }
        }
        return lines.filter((line) => line !== "");
    }

    /** Notes a line that is no answer. False: it is what was sent, from a line that echoes. */
    #isDamage(line: string): boolean {
        if (this.#sent.includes(`${line}\r`)) {
            this.heard.echoes += 1;
            return false;
        }
        this.heard.bare ||= BARE.test(line);
        this.heard.damaged += 1;
        return true;
    }
}

import type { Bytes } from "../../program_host";
import { LineTrouble } from "../../unit_place";
import type { Master } from "./master";

/** The port cannot be used, or not any more. */
export class PortTrouble extends LineTrouble {}

/** Bytes that go to a line and come from it. */
export abstract class Bus {
    abstract readonly port: string;
    abstract readonly isVirtual: boolean;
    readonly master: Master;
    #heard: Bytes = new Uint8Array();
    #lost: LineTrouble | null = null;
    #wake: () => void = () => undefined;

    constructor(master: Master) {
        this.master = master;
    }

    protected abstract send(data: Bytes): void;
    abstract close(): void;

    write(data: Bytes): void {
        this.#requireThere();
        this.send(data);
    }

    /** What has come, or comes within a time; empty: nothing. */
    async read(patience_ms: number): Promise<Bytes> {
        this.#requireThere();
        if (this.#heard.length === 0 && patience_ms > 0) {
            await new Promise<void>((take) => {
                this.#wake = take;
                self.setTimeout(take, patience_ms);
            });
            this.#requireThere();
        }
        const heard = this.#heard;
        this.#heard = new Uint8Array();
        return heard;
    }

    /** Takes what has come. */
    hear(data: Bytes): void {
        this.#heard = joined(this.#heard, data);
        this.#wake();
    }

    /** The port has gone: nothing is sent on it any more. */
    lose(why: LineTrouble): void {
        this.#lost = why;
        this.#wake();
    }

    #requireThere(): void {
        if (this.#lost !== null) {
            throw this.#lost;
        }
    }
}

function joined(one: Bytes, other: Bytes): Bytes {
    const both = new Uint8Array(one.length + other.length);
    both.set(one);
    both.set(other, one.length);
    return both;
}

/** The line of a serial port that the page has opened. */
export class SerialBus extends Bus {
    readonly isVirtual = false;
    readonly #write: (data: Bytes) => void;
    readonly #close: (bus: SerialBus) => void;

    constructor(
        readonly port: string, master: Master, write: (data: Bytes) => void, close: (bus: SerialBus) => void,
    ) {
        super(master);
        this.#write = write;
        this.#close = close;
    }

    protected send(data: Bytes): void {
        this.#write(data);
    }

    close(): void {
        this.#close(this);
    }
}

import { told } from "./common/told";
import type { SerialWords } from "./common/serial_words";
import type { Bytes } from "./program_host";
import type { Port, Trouble } from "./protocol";
import type { PortNews, PortOrder } from "./unit_runner";

/*
 * The part of WebSerial that is used, which browsers without it do not know:
 * https://wicg.github.io/serial/
 */
interface SerialPort extends EventTarget {
    readonly readable: ReadableStream<Bytes> | null;
    readonly writable: WritableStream<Bytes> | null;
    getInfo(): { usbVendorId?: number; usbProductId?: number };
    open(options: SerialForm & { bufferSize?: number }): Promise<void>;
    close(): Promise<void>;
}

/** Rate and form of characters; what is left out is 8N1. */
export interface SerialForm {
    baudRate: number;
    parity?: "none" | "even" | "odd";
    stopBits?: 1 | 2;
}

interface Serial {
    getPorts(): Promise<SerialPort[]>;
    requestPort(): Promise<SerialPort>;
}

const serial = (navigator as Navigator & { serial?: Serial }).serial;

/** Whether the browser reaches serial ports, from where this page has come. */
export const hasSerial = serial !== undefined;

/** Lets the browser ask which port; every other name is of one that the user has allowed. */
const CHOOSE = "serial";
const BUFFER_BYTES = 65_536;
/** So often last words are written: a unit that answers meanwhile disturbs the first of them. */
const LAST_WORDS = 8;
/** What was written so long ago and not answered may still wait in the port: it is dropped before anything else is written. */
const UNANSWERED_MS = 200;
/** What could not be written for so long is not written any more, and is as lost as on a line. */
const DROP_MS = 500;

/** A port that is open. */
interface Open {
    port: SerialPort;
    name: string;
    reader: ReadableStreamDefaultReader<Bytes> | null;
    writer: WritableStreamDefaultWriter<Bytes> | null;
    /** When what nobody has answered yet was written; null: all is answered. */
    unanswered_ms: number | null;
    reading: Promise<void>;
    isClosing: boolean;
    lastWords: Bytes | null;
}

/** It was not opened; the trouble is why, and what to do. */
export class NotOpened extends Error {
    readonly trouble: Trouble;

    constructor(kind: string, cause: string, next: string) {
        super(cause);
        this.trouble = { kind, cause, next };
    }
}

/**
 * The serial ports of the browser, one of them open at most. Its bytes go to the worker, which speaks the line, and come
 * from there. A port is opened when the user connects, and at no other time.
 */
export class SerialPorts {
    readonly #tell: (news: PortNews) => void;
    readonly #t: SerialWords;
    /** Whether somebody holds a button on which a motor runs. */
    isHeld = false;
    #ports: { port: SerialPort; name: string }[] = [];
    #open: Open | null = null;

    constructor(tell: (news: PortNews) => void, t: SerialWords) {
        this.#tell = tell;
        this.#t = t;
        // Ahead of what lets the button go, which needs the worker, and so comes too late.
        for (const kind of ["beforeunload", "pagehide"]) {
            window.addEventListener(kind, (event) => this.#leave(event), { capture: true });
        }
    }

    /** Those that the user has allowed before, and the choice of another one. */
    async list(): Promise<Port[]> {
        (await serial?.getPorts())?.forEach((port) => this.#nameOf(port));
        const known = this.#ports.map(({ name }) => ({ port: name, label: name }));
        return hasSerial ? [...known, { port: CHOOSE, label: this.#t("port.choose") }] : [];
    }

    isOpen(name: string): boolean {
        return this.#open?.name === name;
    }

    /** Opens a port by its name, and returns that; must be called while the user presses something. */
    async open(name: string, form: SerialForm): Promise<string> {
        const known = this.#ports.find((each) => each.name === name)?.port;
        const port = known ?? (await this.#chosen());
        const found = this.#nameOf(port);
        await this.#close();
        this.isHeld = false;
        try {
            await port.open({ ...form, bufferSize: BUFFER_BYTES });
        } catch (error) {
            const cause = this.#t("serial.notOpened", { port: found, cause: words(error) });
            throw new NotOpened("PortBusy", cause, this.#t("serial.notOpenedNext"));
        }
        const writer = port.writable?.getWriter() ?? null;
        const open: Open = { port, name: found, reader: null, writer, unanswered_ms: null, reading: Promise.resolve(), isClosing: false, lastWords: null };
        this.#open = open;
        port.addEventListener("disconnect", () => this.#lose(port, this.#t("serial.unplugged")));
        this.#tell({ kind: "opened", port: found, baud: form.baudRate });
        open.reading = this.#read(open);
        return found;
    }

    obey(order: PortOrder): void {
        if (order.kind === "close") {
            void this.#close();
            return;
        }
        const open = this.#open;
        if (order.kind === "lastWords") {
            Object.assign(open ?? {}, { lastWords: order.data });
        } else if (open !== null) {
            void this.#write(open, order.data);
        }
    }

    async #write(open: Open, data: Bytes): Promise<void> {
        const asked_ms = performance.now();
        try {
            if (asked_ms - (open.unanswered_ms ?? asked_ms) > UNANSWERED_MS) {
                await this.#drop(open);
            }
        } catch (error) {
            this.#lose(open.port, words(error));
        }
        const { writer } = open;
        if (performance.now() - asked_ms < DROP_MS) {
            open.unanswered_ms = asked_ms;
            writer?.write(data).catch((error: unknown) => writer === open.writer && this.#lose(open.port, words(error)));
        }
    }

    /** Takes back what the port has not sent yet. */
    async #drop(open: Open): Promise<void> {
        const { writer } = open;
        open.writer = null;
        if (writer !== null) {
            await writer.abort();
            writer.releaseLock();
            open.writer = open.port.writable?.getWriter() ?? null;
        }
    }

    /** The page is being closed. The browser asks whether it is to be, which gives the last words the time to go out. */
    #leave(event: Event): void {
        const { writer, lastWords } = this.#open ?? {};
        if (!this.isHeld || !writer || !lastWords) {
            return;
        }
        event.preventDefault();
        const data = new Uint8Array(LAST_WORDS * lastWords.length);
        for (let at = 0; at < data.length; at += lastWords.length) {
            data.set(lastWords, at);
        }
        writer.write(data).catch(() => undefined);
    }

    async #chosen(): Promise<SerialPort> {
        try {
            if (serial === undefined) {
                throw new Error(this.#t("serial.none"));
            }
            return await serial.requestPort();
        } catch (error) {
            throw new NotOpened("", this.#t("serial.notChosen", { cause: words(error) }), this.#t("serial.notChosenNext"));
        }
    }

    #nameOf(port: SerialPort): string {
        const known = this.#ports.find((each) => each.port === port);
        if (known) {
            return known.name;
        }
        const { usbVendorId, usbProductId } = port.getInfo();
        const hex = (value = 0): string => value.toString(16).padStart(4, "0");
        const kind = usbVendorId === undefined ? "COM" : `USB ${hex(usbVendorId)}:${hex(usbProductId)}`;
        const same = this.#ports.filter(({ name }) => name.startsWith(kind)).length;
        const name = same === 0 ? kind : `${kind} (${same + 1})`;
        this.#ports.push({ port, name });
        return name;
    }

    /** A damaged character ends a stream, and the port has another one; when it is lost, it has none any more. */
    async #read(open: Open): Promise<void> {
        let [last, cause]: [ReadableStream<Bytes> | null, string] = [null, told("closed")];
        while (open.port.readable !== null && open.port.readable !== last && !open.isClosing) {
            last = open.port.readable;
            open.reader = last.getReader();
            try {
                await this.#readAll(open, open.reader);
            } catch (error) {
                cause = words(error);
            } finally {
                open.reader.releaseLock();
            }
        }
        this.#lose(open.port, cause);
    }

    async #readAll(open: Open, reader: ReadableStreamDefaultReader<Bytes>): Promise<void> {
        for (;;) {
            const { value, done } = await reader.read();
            if (done) {
                return;
            }
            open.unanswered_ms = null;
            this.#tell({ kind: "heard", data: value });
        }
    }

    #lose(port: SerialPort, cause: string): void {
        const open = this.#open;
        if (open?.port !== port || open.isClosing) {
            return;
        }
        void this.#close();
        this.#tell({ kind: "lost", cause: this.#t("serial.lost", { port: open.name, cause }), next: this.#t("serial.lostNext") });
    }

    async #close(): Promise<void> {
        const open = this.#open;
        if (open === null) {
            return;
        }
        this.#open = null;
        open.isClosing = true;
        const { port, reader, writer } = open;
        for (const step of [() => writer?.abort(), () => reader?.cancel(), () => open.reading, () => writer?.releaseLock(), () => port.close()]) {
            try {
                await step();
            } catch {
                // It is gone: there is nothing left of it to be closed.
            }
        }
    }
}

const words = (error: unknown): string => told(error instanceof Error ? error.message : String(error));

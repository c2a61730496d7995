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

/** A port that is open. */
interface Open {
    port: SerialPort;
    name: string;
    reader: ReadableStreamDefaultReader<Bytes> | null;
    writer: WritableStreamDefaultWriter<Bytes> | null;
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
        const open: Open = { port, name: found, reader: null, writer, reading: Promise.resolve(), isClosing: false, lastWords: null };
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
        const { port, writer } = this.#open ?? {};
        if (order.kind === "lastWords") {
            Object.assign(this.#open ?? {}, { lastWords: order.data });
            return;
        }
        writer?.write(order.data).catch((error: unknown) => port && this.#lose(port, words(error)));
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
                await this.#readAll(open.reader);
            } catch (error) {
                cause = words(error);
            } finally {
                open.reader.releaseLock();
            }
        }
        this.#lose(open.port, cause);
    }

    async #readAll(reader: ReadableStreamDefaultReader<Bytes>): Promise<void> {
        for (;;) {
            const { value, done } = await reader.read();
            if (done) {
                return;
            }
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
        try {
            await open.reader?.cancel();
            await open.reading;
            await open.writer?.close();
            open.writer?.releaseLock();
            await open.port.close();
        } catch {
            // It is gone: there is nothing left to be closed.
        }
    }
}

const words = (error: unknown): string => told(error instanceof Error ? error.message : String(error));

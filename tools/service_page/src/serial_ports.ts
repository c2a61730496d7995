import { t } from "./i18n";
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
    open(options: { baudRate: number; bufferSize?: number }): Promise<void>;
    close(): Promise<void>;
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

/** A port that is open. */
interface Open {
    port: SerialPort;
    name: string;
    reader: ReadableStreamDefaultReader<Bytes> | null;
    writer: WritableStreamDefaultWriter<Bytes> | null;
    reading: Promise<void>;
    isClosing: boolean;
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
    #ports: { port: SerialPort; name: string }[] = [];
    #open: Open | null = null;

    constructor(tell: (news: PortNews) => void) {
        this.#tell = tell;
    }

    /** Those that the user has allowed before, and the choice of another one. */
    async list(): Promise<Port[]> {
        (await serial?.getPorts())?.forEach((port) => this.#nameOf(port));
        const known = this.#ports.map(({ name }) => ({ port: name, label: name }));
        return hasSerial ? [...known, { port: CHOOSE, label: t("port.choose") }] : [];
    }

    isOpen(name: string): boolean {
        return this.#open?.name === name;
    }

    /** Opens a port by its name, and returns that; must be called while the user presses something. */
    async open(name: string, baud: number): Promise<string> {
        const known = this.#ports.find((each) => each.name === name)?.port;
        const port = known ?? (await this.#chosen());
        const found = this.#nameOf(port);
        await this.#close();
        try {
            await port.open({ baudRate: baud, bufferSize: BUFFER_BYTES });
        } catch (error) {
            const cause = t("serial.notOpened", { port: found, cause: words(error) });
            throw new NotOpened("PortBusy", cause, t("serial.notOpenedNext"));
        }
        const writer = port.writable?.getWriter() ?? null;
        const open: Open = { port, name: found, reader: null, writer, reading: Promise.resolve(), isClosing: false };
        this.#open = open;
        port.addEventListener("disconnect", () => this.#lose(port, t("serial.unplugged")));
        this.#tell({ kind: "opened", port: found, baud });
        open.reading = this.#read(open);
        return found;
    }

    obey(order: PortOrder): void {
        if (order.kind === "close") {
            void this.#close();
            return;
        }
        const { port, writer } = this.#open ?? {};
        writer?.write(order.data).catch((error: unknown) => port && this.#lose(port, words(error)));
    }

    async #chosen(): Promise<SerialPort> {
        try {
            if (serial === undefined) {
                throw new Error(t("serial.none"));
            }
            return await serial.requestPort();
        } catch (error) {
            throw new NotOpened("", t("serial.notChosen", { cause: words(error) }), t("serial.notChosenNext"));
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
        let [last, cause]: [ReadableStream<Bytes> | null, string] = [null, "closed"];
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
        this.#tell({ kind: "lost", cause: t("serial.lost", { port: open.name, cause }), next: t("serial.lostNext") });
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

const words = (error: unknown): string => (error instanceof Error ? error.message : String(error));

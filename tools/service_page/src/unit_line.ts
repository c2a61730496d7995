import type { SerialWords } from "./common/serial_words";
import type { Line } from "./link";
import { GREETING, type Port } from "./protocol";
import { NotOpened, SerialPorts, type SerialForm } from "./serial_ports";
import type { PortNews, PortOrder } from "./unit_runner";

const VIRTUAL = "virtual";
const BAUD = 19_200;

/** What a page of any unit asks for; ports are opened on the way, all else is for the worker. */
interface Asked {
    type: string;
    port?: string;
    rate?: number;
    format?: string;
    held?: boolean;
}

/** How a port is to be opened of which the page asks for this. */
export type FormOf = (asked: { rate?: number; format?: string }) => SerialForm;

const usualForm: FormOf = ({ rate }) => ({ baudRate: rate ?? BAUD });

/**
 * The line from the page to the worker that runs its unit and speaks to others. What concerns serial ports is done on
 * the way, as only a page can ask for them.
 */
export class UnitLine implements Line {
    onmessage: Line["onmessage"] = null;
    onclose: Line["onclose"] = null;
    readonly #worker: Worker;
    readonly #ports: SerialPorts;
    readonly #formOf: FormOf;
    /** Until a port was chosen and opened, others are not asked for. */
    #isOpening = false;

    constructor(worker: Worker, ports: SerialPorts, formOf = usualForm) {
        this.#worker = worker;
        this.#ports = ports;
        this.#formOf = formOf;
        worker.onmessage = (event: MessageEvent<string | PortOrder>) => this.#hear(event);
        worker.onerror = () => this.onclose?.();
        worker.postMessage(GREETING);
    }

    get isReady(): boolean {
        return this.#worker.onmessage !== null;
    }

    send(text: string): void {
        const asked = JSON.parse(text) as Asked;
        if (asked.type === "hold") {
            this.#ports.isHeld = asked.held === true;
        }
        if (asked.type === "ports") {
            void this.#tellPorts();
        } else if (this.#mustOpen(asked)) {
            void this.#connect(asked);
        } else {
            this.#worker.postMessage(text);
        }
    }

    close(): void {
        this.#worker.onmessage = this.#worker.onerror = null;
    }

    #hear(event: MessageEvent<string | PortOrder>): void {
        if (typeof event.data === "string") {
            this.onmessage?.(event);
        } else {
            this.#ports.obey(event.data);
        }
    }

    #mustOpen({ type, port }: Asked): boolean {
        return type === "connect" && port !== VIRTUAL && !this.#ports.isOpen(port ?? "");
    }

    async #tellPorts(): Promise<void> {
        const told: { type: "ports"; ports: Port[] } = { type: "ports", ports: await this.#ports.list() };
        this.onmessage?.(new MessageEvent("message", { data: JSON.stringify(told) }));
    }

    async #connect(asked: Asked): Promise<void> {
        if (this.#isOpening) {
            return;
        }
        this.#isOpening = true;
        try {
            const opened = await this.#ports.open(asked.port ?? "", this.#formOf(asked));
            await this.#tellPorts();
            this.#worker.postMessage(JSON.stringify({ ...asked, port: opened }));
        } catch (error) {
            if (!(error instanceof NotOpened)) {
                throw error;
            }
            await this.#tellPorts();
            this.#worker.postMessage(JSON.stringify({ ...asked, failed: error.trouble }));
        } finally {
            this.#isOpening = false;
        }
    }
}

/** Ports, opened in the name of a worker. */
export function portsOf(worker: Worker, t: SerialWords): SerialPorts {
    return new SerialPorts((news: PortNews) => worker.postMessage(news), t);
}

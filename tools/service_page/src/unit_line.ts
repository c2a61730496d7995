import type { Line } from "./link";
import { GREETING, type FromService, type ToService } from "./protocol";
import { NotOpened, SerialPorts } from "./serial_ports";
import type { PortNews, PortOrder } from "./unit_runner";

const VIRTUAL = "virtual";
const BAUD = 19_200;

type Connect = Extract<ToService, { type: "connect" }>;

/**
 * The line from the page to the worker that runs its unit and speaks to others. What concerns serial ports is done on
 * the way, as only a page can ask for them.
 */
export class UnitLine implements Line {
    onmessage: Line["onmessage"] = null;
    onclose: Line["onclose"] = null;
    readonly #worker: Worker;
    readonly #ports: SerialPorts;

    constructor(worker: Worker, ports: SerialPorts) {
        this.#worker = worker;
        this.#ports = ports;
        worker.onmessage = (event: MessageEvent<string | PortOrder>) => this.#hear(event);
        worker.onerror = () => this.onclose?.();
        worker.postMessage(GREETING);
    }

    get isReady(): boolean {
        return this.#worker.onmessage !== null;
    }

    send(text: string): void {
        const asked = JSON.parse(text) as ToService;
        if (asked.type === "ports") {
            void this.#tellPorts();
        } else if (asked.type === "connect" && asked.port !== VIRTUAL && !this.#ports.isOpen(asked.port)) {
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

    #tell(told: FromService): void {
        this.onmessage?.(new MessageEvent("message", { data: JSON.stringify(told) }));
    }

    async #tellPorts(): Promise<void> {
        this.#tell({ type: "ports", ports: await this.#ports.list() });
    }

    async #connect({ type, port, node, rate }: Connect): Promise<void> {
        try {
            const opened = await this.#ports.open(port, rate ?? BAUD);
            await this.#tellPorts();
            this.#worker.postMessage(JSON.stringify({ type, port: opened, node }));
        } catch (error) {
            if (!(error instanceof NotOpened)) {
                throw error;
            }
            await this.#tellPorts();
            this.#worker.postMessage(JSON.stringify({ type, port, node, failed: error.trouble }));
        }
    }
}

/** Ports, opened in the name of a worker. */
export function portsOf(worker: Worker): SerialPorts {
    return new SerialPorts((news: PortNews) => worker.postMessage(news));
}

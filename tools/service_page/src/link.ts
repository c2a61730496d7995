import { Cell } from "./signal";
import type { FromService, ToService } from "./protocol";

const FIRST_RETRY_MS = 300;
const LAST_RETRY_MS = 3000;

type Kind = FromService["type"];
type Of<K extends Kind> = Extract<FromService, { type: K }>;

/**
 * The WebSocket to the service. It opens itself again when it is lost; nothing is queued meanwhile, and opening
 * sends nothing, so that a page which comes back never acts on a unit.
 */
export class Link {
    readonly isOpen = new Cell(false);
    /** The number that the service gave to this page; answers to its requests carry it. */
    client: number | null = null;
    readonly #handlers = new Map<Kind, ((message: FromService) => void)[]>();
    #socket: WebSocket | null = null;
    #retry_ms = FIRST_RETRY_MS;
    #last_id = 0;

    on<K extends Kind>(kind: K, handler: (message: Of<K>) => void): void {
        const handlers = this.#handlers.get(kind) ?? [];
        handlers.push(handler as (message: FromService) => void);
        this.#handlers.set(kind, handlers);
    }

    open(): void {
        const socket = new WebSocket(`ws://${location.host}/ws`);
        this.#socket = socket;
        socket.onopen = () => {
            this.#retry_ms = FIRST_RETRY_MS;
            this.isOpen.set(true);
        };
        socket.onmessage = (event) => this.#receive(JSON.parse(String(event.data)) as FromService);
        socket.onclose = () => {
            this.isOpen.set(false);
            window.setTimeout(() => this.open(), this.#retry_ms);
            this.#retry_ms = Math.min(2 * this.#retry_ms, LAST_RETRY_MS);
        };
    }

    /** Sends now or not at all; returns whether it was sent. */
    send(message: ToService): boolean {
        if (this.#socket?.readyState !== WebSocket.OPEN) {
            return false;
        }
        this.#socket.send(JSON.stringify(message));
        return true;
    }

    /** A number for a request, of which the answer reminds. */
    nextId(): number {
        this.#last_id += 1;
        return this.#last_id;
    }

    #receive(message: FromService): void {
        if (message.type === "hello") {
            this.client = message.client ?? null;
        }
        for (const handler of this.#handlers.get(message.type) ?? []) {
            handler(message);
        }
    }
}

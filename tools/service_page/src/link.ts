import { Cell } from "./signal";
import type { FromService, ToService } from "./protocol";

const FIRST_RETRY_MS = 300;
const LAST_RETRY_MS = 3000;
/** The service gives a sign of life twice a second: after so long without any it is taken for dead. */
const SILENT_MS = 2000;
const LOOK_MS = 250;

/** All that is said has a type; a greeting and signs of life have numbers. */
interface Said {
    type: string;
    beat?: number;
    client?: number;
}

/** What messages go over: a WebSocket to the service, or what takes its place. */
export interface Line {
    onmessage: ((event: MessageEvent) => void) | null;
    onclose: (() => void) | null;
    /** Whether it takes messages now. */
    readonly isReady: boolean;
    send(text: string): void;
    close(): void;
}

/**
 * The line to the service. It opens itself again when it is lost or falls silent; nothing is queued meanwhile,
 * and opening sends nothing, so that a page which comes back never acts on a unit.
 */
export class Link<From extends Said = FromService, To extends Said = ToService> {
    /** Whether the service is there, as far as it is known. */
    readonly isOpen = new Cell(false);
    /** The number that the service gave to this page; answers to its requests carry it. */
    client: number | null = null;
    readonly #handlers = new Map<string, ((message: From) => void)[]>();
    readonly #onRefused: ((message: To) => void)[] = [];
    readonly #onSent: ((message: To) => void)[] = [];
    readonly #connectTo: () => Line;
    #socket: Line | null = null;
    #heard_ms = 0;
    /** The youngest sign of life: what is sent carries it, and the service refuses what is older than it looks. */
    #beat = 0;
    #retry_ms = FIRST_RETRY_MS;
    #last_id = 0;

    constructor(connectTo: () => Line) {
        this.#connectTo = connectTo;
    }

    on<K extends From["type"]>(kind: K, handler: (message: Extract<From, { type: K }>) => void): void {
        const handlers = this.#handlers.get(kind) ?? [];
        handlers.push(handler as (message: From) => void);
        this.#handlers.set(kind, handlers);
    }

    /** Calls the handler with what was not sent. */
    onRefused(handler: (message: To) => void): void {
        this.#onRefused.push(handler);
    }

    /** Calls the handler with what is being sent. */
    onSent(handler: (message: To) => void): void {
        this.#onSent.push(handler);
    }

    open(): void {
        this.#connect();
        window.setInterval(() => this.#watch(), LOOK_MS);
    }

    /** Sends now or not at all; returns whether it was sent. */
    send(message: To): boolean {
        this.#watch();
        if (!this.isOpen.value || this.#socket?.isReady !== true) {
            this.#onRefused.forEach((handler) => handler(message));
            return false;
        }
        this.#onSent.forEach((handler) => handler(message));
        this.#socket.send(JSON.stringify({ ...message, beat: this.#beat }));
        return true;
    }

    /** A number for a request, of which the answer reminds. */
    nextId(): number {
        this.#last_id += 1;
        return this.#last_id;
    }

    #connect(): void {
        const socket = this.#connectTo();
        this.#socket = socket;
        this.#heard_ms = performance.now();
        socket.onmessage = (event) => this.#receive(JSON.parse(String(event.data)) as From);
        socket.onclose = () => this.#lose();
    }

    #watch(): void {
        if (performance.now() - this.#heard_ms > SILENT_MS) {
            this.#lose();
        }
    }

    /** A socket that is dead, or may be, is used no more, whatever still comes from it. */
    #lose(): void {
        const socket = this.#socket;
        if (socket === null) {
            return;
        }
        this.#socket = null;
        socket.onmessage = socket.onclose = null;
        socket.close();
        this.isOpen.set(false);
        window.setTimeout(() => this.#connect(), this.#retry_ms);
        this.#retry_ms = Math.min(2 * this.#retry_ms, LAST_RETRY_MS);
    }

    #receive(message: From): void {
        this.#heard_ms = performance.now();
        if (message.type === "hello" || message.type === "beat") {
            this.#beat = message.beat ?? 0;
        }
        if (message.type === "hello") {
            this.client = message.client ?? null;
            this.#retry_ms = FIRST_RETRY_MS;
            this.isOpen.set(true);
        }
        for (const handler of this.#handlers.get(message.type) ?? []) {
            handler(message);
        }
    }
}

import type { Line } from "./link";

/** What a page says when it comes or comes back. */
export const GREETING = "";

/** The line from the page to the worker that runs its unit. */
export class UnitLine implements Line {
    onmessage: Line["onmessage"] = null;
    onclose: Line["onclose"] = null;
    readonly #worker: Worker;

    constructor(worker: Worker) {
        this.#worker = worker;
        worker.onmessage = (event: MessageEvent) => this.onmessage?.(event);
        worker.onerror = () => this.onclose?.();
        worker.postMessage(GREETING);
    }

    get isReady(): boolean {
        return this.#worker.onmessage !== null;
    }

    send(text: string): void {
        this.#worker.postMessage(text);
    }

    close(): void {
        this.#worker.onmessage = this.#worker.onerror = null;
    }
}

import type { Line } from "./link";

/** The WebSocket to the service program. */
export class ServiceLine implements Line {
    readonly #socket = new WebSocket(`ws://${location.host}/ws`);

    set onmessage(take: Line["onmessage"]) {
        this.#socket.onmessage = take;
    }

    set onclose(end: Line["onclose"]) {
        this.#socket.onclose = end;
    }

    get isReady(): boolean {
        return this.#socket.readyState === WebSocket.OPEN;
    }

    send(text: string): void {
        this.#socket.send(text);
    }

    close(): void {
        this.#socket.close();
    }
}

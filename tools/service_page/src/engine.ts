import type { Columns } from "./common/told";
import type { Order, Told } from "./engine_worker";
import { t } from "./i18n";
import type { Bytes } from "./program_host";
import type { Line } from "./link";
import type { Curve, CurveRequest, Example, Verdict } from "./protocol";
import type { SerialPorts } from "./serial_ports";
import { UnitLine, portsOf } from "./unit_line";
import type { StatusNames } from "./unit_messages";

/** What a page brings along that no service serves; tools/rkm04 service --static puts it in. */
interface Brought {
    /** The program rkm04-host for WebAssembly, compressed (gzip), base64. */
    program: string;
    /** The module rkm04-unit, likewise. */
    unit: string;
    /** What Get Status tells by number. */
    names: StatusNames;
    /** The script of the worker. */
    worker: string;
    examples: Example[];
    /** What the workers say, in Czech. */
    words: Columns;
}

/** The simulator cannot be had; the message is why. */
export class NoEngine extends Error {}

interface Waiting {
    take: (answer: never) => void;
    fail: (error: Error) => void;
}

/** The simulator in a worker, so that the page, and STOP on it, never wait for it. */
export class Engine {
    readonly examples: Example[];
    readonly words: Columns;
    /** Whether the page has a unit of its own. */
    readonly hasUnit = typeof WebAssembly !== "undefined";
    readonly #brought: Brought;
    readonly #worker: Worker | null;
    /** The worker of the unit, which must not wait for checks and curves. */
    #unit: { worker: Worker; ports: SerialPorts } | null = null;
    readonly #waiting = new Map<number, Waiting>();
    #last_id = 0;

    constructor(brought: Brought) {
        this.examples = brought.examples;
        this.words = brought.words;
        this.#brought = brought;
        this.#worker = this.hasUnit ? begun(brought) : null;
        if (this.#worker !== null) {
            this.#worker.onmessage = ({ data }: MessageEvent<Told>) => this.#hear(data);
            this.#worker.onerror = ({ message }) => this.#lose(message);
        }
    }

    check(text: string): Promise<Verdict> {
        return this.#ask((id) => ({ kind: "check", id, text }));
    }

    curve(request: CurveRequest): Promise<Curve> {
        return this.#ask((id) => ({ kind: "curve", id, request }));
    }

    /** A line to the unit, which begins with the first one. */
    line(): Line {
        if (this.#unit === null) {
            const { unit, names } = this.#brought;
            const worker = begun(this.#brought);
            worker.postMessage({ kind: "unit", bytes: decoded(unit), names } satisfies Order);
            this.#unit = { worker, ports: portsOf(worker, t) };
        }
        return new UnitLine(this.#unit.worker, this.#unit.ports);
    }

    #ask<T>(order: (id: number) => Order): Promise<T> {
        this.#last_id += 1;
        const id = this.#last_id;
        return new Promise<T>((take, fail) => {
            if (this.#worker === null) {
                fail(new NoEngine(t("alone.noWebAssembly")));
                return;
            }
            this.#waiting.set(id, { take, fail });
            this.#worker.postMessage(order(id));
        });
    }

    #hear(told: Told): void {
        const waiting = this.#waiting.get(told.id);
        this.#waiting.delete(told.id);
        if ("trouble" in told) {
            waiting?.fail(new NoEngine(told.trouble));
        } else {
            waiting?.take(told.answer as never);
        }
    }

    /** The worker has ended, or could not begin. */
    #lose(message: string): void {
        this.#waiting.forEach(({ fail }) => fail(new NoEngine(`${t("alone.failed")} (${message})`)));
        this.#waiting.clear();
    }
}

function decoded(text: string): Bytes {
    return Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
}

/** A worker that has the program. */
function begun({ program, worker }: Brought): Worker {
    const place = URL.createObjectURL(new Blob([worker], { type: "text/javascript" }));
    const made = new Worker(place);
    made.postMessage({ kind: "program", bytes: decoded(program) } satisfies Order);
    return made;
}

/** The engine of a page that no service serves; null: there is a service, and it does the work. */
export const engine: Engine | null = (() => {
    const brought = document.getElementById("alone")?.textContent;
    return brought ? new Engine(JSON.parse(brought) as Brought) : null;
})();

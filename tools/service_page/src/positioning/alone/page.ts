import type { Columns } from "../../common/told";
import { byId } from "../../dom";
import type { Line } from "../../link";
import type { Bytes } from "../../program_host";
import { hasSerial, type SerialForm, type SerialPorts } from "../../serial_ports";
import { UnitLine, portsOf, type FormOf } from "../../unit_line";
import { t } from "../i18n";
import type { Unit } from "../unit";
import type { Names } from "./axis_state";
import type { Script } from "./player";
import { ScriptPanel, type ScriptExample } from "./script";
import type { Order, PlayerTold } from "./worker";

/** What a page brings along that no service serves; `service --static` puts it in. */
interface Brought {
    /** The module positioning-unit for WebAssembly, compressed (gzip), base64. */
    unit: string;
    /** The program positioning-host, likewise. */
    program: string;
    examples: ScriptExample[];
    /** The script of the worker. */
    worker: string;
    names: Names;
    words: Columns;
}

const FORMS: Record<string, Omit<SerialForm, "baudRate">> = {
    "8E1": { parity: "even", stopBits: 1 },
    "8O1": { parity: "odd", stopBits: 1 },
    "8N1": { parity: "none", stopBits: 1 },
    "8N2": { parity: "none", stopBits: 2 },
};
const RATE = 19_200;

const formOf: FormOf = ({ rate = RATE, format = "8E1" }) => ({ baudRate: rate, ...FORMS[format] });

/** The unit of a page that needs no service, in a worker, and the serial ports of the browser. */
class Alone {
    readonly #brought: Brought;
    #made: { worker: Worker; ports: SerialPorts } | null = null;

    constructor(brought: Brought) {
        this.#brought = brought;
    }

    /** Shows what only such a page has; returns whether it has a unit. */
    begin(unit: Unit): boolean {
        const hasUnit = typeof WebAssembly !== "undefined";
        const shown = [["alone-hint", hasUnit], ["alone-none", !hasUnit], ["serial-hint", hasUnit && !hasSerial]] as const;
        shown.forEach(([id, isShown]) => (byId(id, HTMLElement).hidden = !isShown));
        const fields = ["rate", "format"].map((id) => byId(id, HTMLSelectElement));
        fields.forEach((field) => (field.closest("label")!.hidden = !hasSerial));
        unit.state.watch((state) => fields.forEach((field) => (field.disabled = state?.connected === true)));
        window.addEventListener("beforeunload", (event) => unit.state.value?.virtual === false && unit.didMove && event.preventDefault());
        if (hasUnit) {
            this.#beginScripts();
        }
        return hasUnit;
    }

    /** Scripts are played in a worker of their own, so that the unit, and STOP, never wait for them. */
    #beginScripts(): void {
        let worker: Worker | null = null;
        const panel: ScriptPanel = new ScriptPanel(this.#brought.examples, (id: number, script: Script) => {
            if (worker === null) {
                worker = this.#begun({ kind: "program", bytes: decoded(this.#brought.program) });
                worker.onmessage = ({ data }: MessageEvent<PlayerTold>) => panel.hear(data);
            }
            worker.postMessage({ kind: "play", id, script } satisfies Order);
        });
    }

    /** A worker, with what it is to have first. */
    #begun(first: Order): Worker {
        const worker = new Worker(URL.createObjectURL(new Blob([this.#brought.worker], { type: "text/javascript" })));
        worker.postMessage(first);
        return worker;
    }

    /** What its workers say, in Czech. */
    get words(): Columns {
        return this.#brought.words;
    }

    /** How a port is to be opened, as the page has it. */
    readonly form = (): { rate: number; format: string } => ({
        rate: Number(byId("rate", HTMLSelectElement).value),
        format: byId("format", HTMLSelectElement).value,
    });

    /** A line to the unit, which begins with the first one. */
    line(): Line {
        if (this.#made === null) {
            const { unit, names } = this.#brought;
            const worker = this.#begun({ kind: "unit", bytes: decoded(unit), names });
            this.#made = { worker, ports: portsOf(worker, t) };
        }
        return new UnitLine(this.#made.worker, this.#made.ports, formOf);
    }
}

const decoded = (text: string): Bytes => Uint8Array.from(atob(text), (character) => character.charCodeAt(0));

/** Null: a service does the work. */
export const alone: Alone | null = (() => {
    const brought = document.getElementById("alone")?.textContent;
    return brought ? new Alone(JSON.parse(brought) as Brought) : null;
})();

import type { Columns } from "../../common/told";
import { byId } from "../../dom";
import type { Line } from "../../link";
import type { NoMachine } from "../../machine_file";
import { MACHINE_BYTES_MAX, troubleOf } from "../../machine_words";
import { hasSerial, type SerialPorts } from "../../serial_ports";
import { UnitLine, portsOf } from "../../unit_line";
import { fileWords } from "../files";
import { numberText, t } from "../i18n";
import { isUnderWay } from "../job";
import { AXES, type MachineText } from "../protocol";
import { Refused } from "../refused";
import type { Unit } from "../unit";
import { TEXT_MAX, type Opened } from "./file";
import type { NoMill } from "./mill";
import type { Order, Read } from "./worker";

/** What a page brings along that no service serves; `service --static` puts it in. */
interface Brought {
    /** The program gve134-host for WebAssembly, compressed (gzip), base64. */
    program: string;
    /** The module gve134-unit, likewise. */
    unit: string;
    /** The script of the workers. */
    worker: string;
    examples: { name: string; text: string }[];
    words: Columns;
}

const GCODE = /\.(nc|ngc|gcode|tap)$/i;
const RATE = 115_200;

interface Waiting {
    take: (read: Read) => void;
    fail: (error: Error) => void;
}

/** The unit of a page that needs no service, and what reads its files, in a worker each; the serial ports of the browser. */
class Alone {
    readonly #brought: Brought;
    readonly #waiting = new Map<number, Waiting>();
    #unit: { worker: Worker; ports: SerialPorts } | null = null;
    #reader: Worker | null = null;
    #last_id = 0;
    #opened: Opened[] = [];
    #machine: MachineText = { name: "", text: "" };

    constructor(brought: Brought) {
        this.#brought = brought;
    }

    /** Shows what only such a page has, and not what it cannot do; returns whether it has a unit. */
    begin(unit: Unit): boolean {
        const hasUnit = typeof WebAssembly !== "undefined";
        const shown = [["alone-hint", hasUnit], ["alone-none", !hasUnit], ["serial-hint", hasUnit && !hasSerial]] as const;
        shown.forEach(([id, isShown]) => (byId(id, HTMLElement).hidden = !isShown));
        ["machine-open", "machine-edit", "home-all"].forEach((id) => (byId(id, HTMLElement).hidden = !hasUnit));
        const rate = byId("rate", HTMLSelectElement);
        rate.closest("label")!.hidden = !hasSerial;
        unit.state.watch((state) => (rate.disabled = state?.connected === true));
        byId("file", HTMLInputElement).accept = ".gve,text/plain";
        window.addEventListener("beforeunload", (event) => isUnderWay(unit.state.value?.job ?? null) && event.preventDefault());
        return hasUnit;
    }

    /** How a port is to be opened, as the page has it. */
    readonly form = (): { rate: number } => ({ rate: Number(byId("rate", HTMLSelectElement).value) });

    /** A line to the unit, which begins with the first one. */
    line(): Line {
        if (this.#unit === null) {
            const worker = this.#begun();
            worker.postMessage({ kind: "unit", bytes: decoded(this.#brought.unit) } satisfies Order);
            this.#unit = { worker, ports: portsOf(worker, t) };
        }
        return new UnitLine(this.#unit.worker, this.#unit.ports, ({ rate }) => ({ baudRate: rate ?? RATE }));
    }

    // ---- files ----

    /** What its workers say, in Czech. */
    get words(): Columns {
        return this.#brought.words;
    }

    get examples(): string[] {
        return this.#brought.examples.map(({ name }) => name);
    }

    async openExample(name: string): Promise<void> {
        await this.#open(name, this.#brought.examples.find((each) => each.name === name)?.text ?? "");
    }

    async open(kind: "file" | "machine", file: File): Promise<void> {
        if (kind === "machine") {
            return this.#openMachine(file);
        }
        if (GCODE.test(file.name)) {
            throw new Refused(t("alone.gcode", { name: file.name }));
        }
        const text = file.size <= TEXT_MAX ? await file.text() : "";
        if (file.size > TEXT_MAX || text.includes("\0")) {
            throw new Refused(t(file.size > TEXT_MAX ? "alone.large" : "alone.noText", { name: file.name }));
        }
        await this.#open(file.name, text);
    }

    /** The machine file that is open, as it is written. */
    get machine(): MachineText {
        return this.#machine;
    }

    async #openMachine(file: File): Promise<void> {
        const { name } = file;
        if (file.size > MACHINE_BYTES_MAX) {
            throw new Refused(t("machine.tooLarge", { name, bytes: numberText(MACHINE_BYTES_MAX) }));
        }
        const bytes = new Uint8Array(await file.arrayBuffer());
        const read = await this.#ask((id) => ({ kind: "judge", id, bytes }));
        const mill = "mill" in read ? read.mill : null;
        if (mill === null || !("machine" in mill)) {
            throw new Refused(`${name}: ${mill === null ? t("alone.failed") : whyNot(mill)}; ${t("machine.notOpened")}`);
        }
        this.#machine = { name, text: new TextDecoder().decode(bytes) };
        this.#unit?.worker.postMessage({ kind: "machine", mill } satisfies Order);
    }

    /** A file that was opened. */
    file(number: number): Opened {
        const found = this.#opened.find(({ state }) => state.number === number);
        if (found === undefined) {
            throw new Refused(t("alone.failed"));
        }
        return found;
    }

    async #open(name: string, text: string): Promise<void> {
        const opened = await this.#read(name, text);
        this.#opened = [...this.#opened.slice(-1), opened];
        this.#unit?.worker.postMessage({ kind: "file", file: opened } satisfies Order);
    }

    async #read(name: string, text: string): Promise<Opened> {
        const read = await this.#ask((id) => ({ kind: "read", id, name, text }));
        if (!("opened" in read)) {
            throw new Refused("trouble" in read ? (await fileWords())(read.trouble) : t("alone.failed"));
        }
        return read.opened;
    }

    #ask(order: (id: number) => Order): Promise<Read> {
        if (typeof WebAssembly === "undefined") {
            return Promise.reject(new Refused(t("alone.noWebAssembly")));
        }
        if (this.#reader === null) {
            this.#reader = this.#begun();
            this.#reader.postMessage({ kind: "program", bytes: decoded(this.#brought.program) } satisfies Order);
            this.#reader.onmessage = ({ data }: MessageEvent<Read>) => this.#hear(data);
            this.#reader.onerror = () => this.#lose();
        }
        this.#last_id += 1;
        const id = this.#last_id;
        this.#reader.postMessage(order(id));
        return new Promise((take, fail) => this.#waiting.set(id, { take, fail }));
    }

    #hear(read: Read): void {
        this.#waiting.get(read.id)?.take(read);
        this.#waiting.delete(read.id);
    }

    /** The reader has ended; the next file begins another one. */
    #lose(): void {
        this.#reader?.terminate();
        this.#reader = null;
        this.#waiting.forEach(({ fail }) => fail(new Refused(t("alone.failed"))));
        this.#waiting.clear();
    }

    #begun(): Worker {
        return new Worker(URL.createObjectURL(new Blob([this.#brought.worker], { type: "text/javascript" })));
    }
}

/** Why a file does not serve this unit. */
function whyNot(found: NoMill | NoMachine): string {
    if ("key" in found) {
        return troubleOf(found, t);
    }
    const { motor, wanted } = found;
    return motor === null ? t("alone.noPart") : t("alone.noScale", { motor, axis: AXES[motor - 1] ?? "", wanted });
}

const decoded = (text: string): Uint8Array<ArrayBuffer> => Uint8Array.from(atob(text), (character) => character.charCodeAt(0));

/** Null: a service does the work. */
export const alone: Alone | null = (() => {
    const brought = document.getElementById("alone")?.textContent;
    return brought ? new Alone(JSON.parse(brought) as Brought) : null;
})();

import { make } from "./dom";
import { t } from "./i18n";
import { isMachine, judged, type MachineContent, type NoMachine } from "./machine_file";
import type { Part, Value } from "./machine_parts";
import { ruleOf } from "./machine_words";

/** What a field is made of, beside its part. */
export interface Look {
    id: string;
    type: "text" | "number";
    label: () => string;
    /** Beside the field: what its value is in the unit of the machine. */
    beside?: (value: number) => string;
}

/**
 * A field of a machine. What is entered counts when it is whole, since its beginning may be another value; what is wrong
 * is told beside the field and changes nothing.
 */
export class MachineField {
    readonly box: HTMLElement;
    readonly input: HTMLInputElement;
    readonly #part: Part;
    readonly #look: Look;
    readonly #label: HTMLElement;
    readonly #trouble: HTMLElement;
    readonly #beside = make("small", { class: "hint" });
    /** null: it is to be taken again. */
    #kept: string | null = "";
    #no: NoMachine | null = null;

    constructor(part: Part, look: Look, onEntered: () => void, ...more: HTMLElement[]) {
        this.#part = part;
        this.#look = look;
        const { id, type } = look;
        const step = type === "number" ? { step: "any" } : {};
        this.input = make("input", { id, type, "aria-describedby": `${id}-trouble`, autocomplete: "off", ...step });
        this.#label = make("label", { for: id });
        this.#trouble = make("small", { id: `${id}-trouble`, class: "beside", role: "alert" });
        const line = make("span", { class: "joined" }, this.input, ...more);
        this.box = make("div", { class: "field" }, this.#label, line, this.#beside, this.#trouble);
        this.input.addEventListener("input", () => this.#showBeside());
        for (const event of ["change", "blur"]) {
            this.input.addEventListener(event, onEntered);
        }
    }

    /** Shows what the machine has. */
    show(machine: MachineContent | null): void {
        this.input.value = String((machine && this.#part.read(machine)) ?? "");
        this.taken();
    }

    /** Whether something else stands in it than what was taken last. */
    get isOther(): boolean {
        return this.#typed !== this.#kept;
    }

    /** The machine with what stands here, if that is right. */
    judge(machine: MachineContent): MachineContent | null {
        const found = judged(this.#part.written(machine, this.#value));
        if (isMachine(found)) {
            return found;
        }
        this.#no = found;
        this.translate();
        return null;
    }

    taken(): void {
        this.#kept = this.#typed;
        this.#no = null;
        this.translate();
    }

    /** What stands beside the input belongs to its value, and has changed. */
    retake(): void {
        this.#kept = this.#typed === "" ? "" : null;
    }

    /** What is wrong with it, in words; empty: nothing. */
    get trouble(): string {
        return this.#no === null ? "" : `${this.#look.label()}: ${ruleOf(this.#no, t)}`;
    }

    translate(): void {
        const words = this.#no === null ? "" : ruleOf(this.#no, t);
        this.#label.textContent = this.#look.label();
        if (this.#trouble.textContent !== words) {
            this.#trouble.textContent = words;
        }
        this.input.setAttribute("aria-invalid", String(this.#no !== null));
        this.#showBeside();
    }

    #showBeside(): void {
        this.#beside.textContent = this.#look.beside?.(this.input.valueAsNumber) ?? "";
    }

    /** A text that a browser takes for no number is not handed over by it. */
    get #typed(): string {
        return this.input.validity.badInput ? "?" : this.input.value;
    }

    get #value(): Value {
        const text = this.#typed.trim();
        return text === "" ? undefined : this.#look.type === "number" ? this.input.valueAsNumber : text;
    }
}

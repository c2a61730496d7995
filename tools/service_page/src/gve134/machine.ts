import { byId, make } from "../dom";
import { Refused, fetchMachine, openFile } from "./api";
import { t } from "./i18n";
import { isOpen } from "./job";
import type { Unit } from "./unit";

/** The machine file as it is written, in the place of the program. What was written is kept until it is taken over or saved. */
export class MachineEditor {
    readonly #unit: Unit;
    readonly #text = byId("machine-text", HTMLTextAreaElement);
    readonly #trouble = byId("machine-trouble", HTMLElement);
    #name = "";
    #isWanted = false;
    /** As it was opened, taken over or saved last. */
    #kept = "";

    constructor(unit: Unit) {
        this.#unit = unit;
        const on = (id: string, act: () => void | Promise<void>): void =>
            byId(id, HTMLButtonElement).addEventListener("click", () => void this.#try(act));
        on("machine-edit", () => this.#open());
        on("machine-take", () => this.#take());
        on("machine-save", () => this.#save());
        on("machine-close", () => this.#close());
        window.addEventListener("beforeunload", (event) => this.#text.value !== this.#kept && event.preventDefault());
        unit.watch(() => this.#show());
    }

    #show(): void {
        const { machine = null, job = null } = this.#unit.state.value ?? {};
        const isShown = this.#isWanted && !isOpen(job);
        byId("machine-edit", HTMLButtonElement).disabled = machine === null || isOpen(job);
        byId("machine-editor", HTMLElement).hidden = !isShown;
        byId("program", HTMLElement).hidden = isShown;
    }

    async #open(): Promise<void> {
        this.#isWanted = true;
        this.#show();
        if (this.#text.value === this.#kept) {
            const { name, text } = await fetchMachine();
            [this.#name, this.#text.value] = [name, text];
            this.#kept = this.#text.value;
        }
        this.#text.focus();
        this.#text.setSelectionRange(0, 0);
    }

    async #take(): Promise<void> {
        const text = this.#text.value;
        await openFile("machine", new File([text], this.#name));
        this.#kept = text;
    }

    #save(): void {
        this.#kept = this.#text.value;
        const href = URL.createObjectURL(new Blob([this.#kept]));
        make("a", { href, download: this.#name }).click();
        window.setTimeout(() => URL.revokeObjectURL(href), 1000);
    }

    #close(): void {
        this.#isWanted = false;
        this.#show();
    }

    async #try(act: () => void | Promise<void>): Promise<void> {
        this.#say("");
        try {
            await act();
        } catch (error) {
            this.#say(error instanceof Refused ? error.message : t("state.notSent"));
        }
    }

    #say(words: string): void {
        this.#trouble.textContent = words;
        this.#trouble.hidden = words === "";
    }
}

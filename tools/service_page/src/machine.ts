import { byId } from "./dom";
import { saveBytes } from "./files";
import { motorForm } from "./drafts";
import type { FileForm } from "./file_form";
import { language, numberText, t } from "./i18n";
import {
    isMachine,
    judged,
    newMachine,
    parseMachine,
    programOf,
    toText,
    withPrograms,
    type MachineContent,
} from "./machine_file";
import { MachineFields } from "./machine_fields";
import { MACHINE_BYTES_MAX, troubleOf } from "./machine_words";
import { MOTORS } from "./protocol";
import { Cell } from "./signal";
import { keep, recall } from "./storage";

const SUFFIX = ".rkm";
const TYPES = [{ description: "RKM04", accept: { "application/json": [SUFFIX] } }];

/** What the machine has beside its name and notes belongs to other parts of the page. */
export interface MachineParts {
    programs: () => { text: string; form: FileForm }[];
    inputs: () => string;
    open: (programs: { text: string; form: FileForm }[], inputs: string) => void;
}

/** The machine that is open: its file, its name and notes, and what its parts are called. */
export class Machine {
    /** Its programs are those of the last file; null: none is open. */
    readonly content = new Cell<MachineContent | null>(null);
    readonly #parts: MachineParts;
    readonly #name = byId("machine-name", HTMLInputElement);
    readonly #notes = byId("machine-notes", HTMLTextAreaElement);
    readonly #fields = new MachineFields(() => this.#now(), (machine) => this.#set(machine));

    constructor(parts: MachineParts) {
        this.#parts = parts;
        const file = byId("machine-file", HTMLInputElement);
        byId("machine-open", HTMLButtonElement).addEventListener("click", () => file.click());
        byId("machine-save", HTMLButtonElement).addEventListener("click", () => void this.#save());
        file.addEventListener("change", () => void this.#open(file));
        for (const field of [this.#name, this.#notes]) {
            field.addEventListener("input", () => this.#edited());
        }
        const kept = judged(recall<unknown>("machine", null));
        this.content.set(isMachine(kept) ? kept : null);
        this.#showFields();
        language.watch(() => this.#show());
    }

    async #open(input: HTMLInputElement): Promise<void> {
        const file = input.files?.[0];
        const found = file === undefined ? null : await this.read(file);
        if (found !== null) {
            this.#take(found);
        }
        input.value = "";
    }

    /** The machine of a file; null: it is none, which is told. */
    async read(file: File): Promise<MachineContent | null> {
        const isTooLarge = file.size > MACHINE_BYTES_MAX;
        const found = isTooLarge ? null : parseMachine(new Uint8Array(await file.arrayBuffer()));
        if (found !== null && isMachine(found)) {
            this.#say("");
            return found;
        }
        const tooLarge = t("machine.tooLarge", { name: file.name, bytes: numberText(MACHINE_BYTES_MAX) });
        this.#say(found === null ? tooLarge : `${file.name}: ${troubleOf(found, t)}; ${t("machine.notOpened")}`);
        return null;
    }

    /** All that is here, as it would be saved. */
    whole(): MachineContent {
        const named = { ...this.#now(), name: this.#name.value.trim() || t("machine.unnamed") };
        return withPrograms(named, this.#parts.programs(), this.#parts.inputs());
    }

    #take(machine: MachineContent): void {
        const programs = MOTORS.map((motor) => programOf(machine, motor, motorForm(motor).name));
        this.#set(machine);
        this.#showFields();
        this.#parts.open(programs, machine.inputs ?? "");
    }

    async #save(): Promise<void> {
        const found = judged(this.whole());
        const trouble = this.#fields.trouble || (isMachine(found) ? "" : troubleOf(found, t));
        if (!isMachine(found) || trouble !== "") {
            this.#say(`${t("machine.notSaved")}: ${trouble}`);
            return;
        }
        const bytes = new TextEncoder().encode(toText(found));
        const fileName = `${found.name.replace(/[^\p{L}\p{N}._ -]/gu, "_")}${SUFFIX}`;
        if ((await saveBytes(fileName, bytes, TYPES)) !== null) {
            this.#say("");
            this.#set(found);
            this.#showFields();
        }
    }

    #now(): MachineContent {
        return this.content.value ?? newMachine(t("machine.unnamed"));
    }

    /** A name that is not there yet is asked for when the machine is saved. */
    #edited(): void {
        const name = this.#name.value.trim() || t("machine.unnamed");
        this.#set({ ...this.#now(), name, notes: this.#notes.value });
    }

    #set(machine: MachineContent): void {
        keep("machine", machine);
        this.content.set(machine);
        this.#show();
    }

    #showFields(): void {
        this.#name.value = this.content.value?.name ?? "";
        this.#notes.value = this.content.value?.notes ?? "";
        this.#fields.show(this.content.value);
    }

    #show(): void {
        byId("machine-shown", HTMLElement).textContent = this.content.value?.name ?? t("machine.none");
    }

    #say(words: string): void {
        const place = byId("machine-trouble", HTMLElement);
        place.textContent = words;
        place.hidden = words === "";
    }
}

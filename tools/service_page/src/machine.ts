import { byId, make } from "./dom";
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
    type MachineMotor,
} from "./machine_file";
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
    readonly #facts = byId("machine-facts", HTMLElement);

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
        if (file) {
            const isTooLarge = file.size > MACHINE_BYTES_MAX;
            const found = isTooLarge ? null : parseMachine(new Uint8Array(await file.arrayBuffer()));
            if (found === null) {
                this.#say(t("machine.tooLarge", { name: file.name, bytes: numberText(MACHINE_BYTES_MAX) }));
            } else if (isMachine(found)) {
                this.#take(found);
            } else {
                this.#say(`${file.name}: ${troubleOf(found, t)}; ${t("machine.notOpened")}`);
            }
        }
        input.value = "";
    }

    #take(machine: MachineContent): void {
        const programs = MOTORS.map((motor) => programOf(machine, motor, motorForm(motor).name));
        this.#say("");
        this.#set(machine);
        this.#showFields();
        this.#parts.open(programs, machine.inputs ?? "");
    }

    async #save(): Promise<void> {
        const named = { ...this.#now(), name: this.#name.value.trim() || t("machine.unnamed") };
        const found = judged(withPrograms(named, this.#parts.programs(), this.#parts.inputs()));
        if (!isMachine(found)) {
            this.#say(`${t("machine.notSaved")}: ${troubleOf(found, t)}`);
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
        return this.content.value ?? newMachine("");
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
    }

    #show(): void {
        const machine = this.content.value;
        byId("machine-shown", HTMLElement).textContent = machine?.name ?? t("machine.none");
        this.#facts.replaceChildren(...(machine === null ? [] : factsOf(machine)).map((fact) => make("li", {}, fact)));
    }

    #say(words: string): void {
        const place = byId("machine-trouble", HTMLElement);
        place.textContent = words;
        place.hidden = words === "";
    }
}

/** What is wired where, how far a step goes, and what is not to be exceeded. */
export function factsOf(machine: MachineContent): string[] {
    const named = (key: "live.input" | "live.output", names: Record<string, string> = {}): string[] =>
        Object.entries(names).map(([number, name]) => `${t(key, { number })}: ${name}`);
    return [
        ...machine.motors.flatMap((motor, index) => motorFacts(motor, index + 1)),
        ...named("live.input", machine.input_names),
        ...named("live.output", machine.output_names),
    ];
}

function motorFacts({ name, steps_per_mm: mm, steps_per_degree: degree, limits = {} }: MachineMotor, motor: number): string[] {
    const { position_min_steps: low, position_max_steps: high, speed_max_steps_per_s: speed } = limits;
    const facts = [
        name ?? "",
        mm === undefined ? "" : t("machine.perMm", { steps: numberText(mm, 6) }),
        degree === undefined ? "" : t("machine.perDegree", { steps: numberText(degree, 6) }),
        low === undefined ? "" : t("machine.lowest", { steps: numberText(low) }),
        high === undefined ? "" : t("machine.highest", { steps: numberText(high) }),
        speed === undefined ? "" : t("machine.fastest", { steps: numberText(speed) }),
    ].filter((fact) => fact !== "");
    return facts.length === 0 ? [] : [`${t("motor.one", { motor })}: ${facts.join(", ")}`];
}

import { byId, make } from "./dom";
import { language, t, type Key } from "./i18n";
import { MachineField, type Look } from "./machine_field";
import type { MachineContent } from "./machine_file";
import { limitPart, namePart, scalePart, unitOf, wiringPart, type Part, type Unit } from "./machine_parts";
import { LINES, MOTORS } from "./protocol";
import { besideWords, onScale } from "./scale";

/** Names, scales and limits of the motors, and what is wired to inputs and outputs, in fields. */
export class MachineFields {
    readonly #root = byId("machine-fields", HTMLElement);
    readonly #machine: () => MachineContent;
    readonly #take: (machine: MachineContent) => void;
    readonly #fields: { title: () => string; field: MachineField }[] = [];
    readonly #units: HTMLSelectElement[] = [];
    readonly #titles: { place: HTMLElement; words: () => string }[] = [];

    /** `take` gets the machine with what was entered and is right. */
    constructor(machine: () => MachineContent, take: (machine: MachineContent) => void) {
        this.#machine = machine;
        this.#take = take;
        MOTORS.forEach((motor, index) => this.#addMotor(motor, index));
        this.#addNames("input", "live.inputs", "live.input");
        this.#addNames("output", "live.outputs", "live.output");
        language.watch(() => this.#translate());
        onScale(() => this.#fields.forEach(({ field }) => field.translate()));
    }

    show(machine: MachineContent | null): void {
        this.#units.forEach((unit, index) => (unit.value = machine === null ? "mm" : unitOf(machine, index)));
        this.#fields.forEach(({ field }) => field.show(machine));
    }

    /** The first field that is wrong, in words; empty: none is. */
    get trouble(): string {
        const found = this.#fields.find(({ field }) => field.trouble !== "");
        return found === undefined ? "" : `${found.title()}, ${found.field.trouble}`;
    }

    /** One value can make another one right, as the other limit of a position does. */
    #entered(): void {
        let isTaken = true;
        while (isTaken) {
            isTaken = this.#fields.some(({ field }) => field.isOther && this.#takeOf(field));
        }
        this.#fields.filter(({ field }) => !field.isOther).forEach(({ field }) => field.taken());
    }

    #takeOf(field: MachineField): boolean {
        const found = field.judge(this.#machine());
        if (found !== null) {
            field.taken();
            this.#take(found);
        }
        return found !== null;
    }

    #addMotor(motor: number, index: number): void {
        const title = (): string => t("motor.one", { motor });
        const add = (part: Part, look: Look): MachineField => this.#field(title, part, look);
        this.#group(title, [
            add(namePart(index), { id: `machine-${motor}-name`, type: "text", label: () => t("machine.name") }),
            this.#scale(title, motor),
            add(limitPart(index, "position_min_steps"), limitLook(motor, "lowest", "")),
            add(limitPart(index, "position_max_steps"), limitLook(motor, "highest", "")),
            add(limitPart(index, "speed_max_steps_per_s"), limitLook(motor, "fastest", "/s")),
        ]);
    }

    #scale(title: () => string, motor: number): MachineField {
        const unit = this.#unit(motor);
        const part = scalePart(motor - 1, () => unit.value as Unit);
        const look: Look = { id: `machine-${motor}-scale`, type: "number", label: () => t("machine.scale") };
        const field = this.#field(title, part, look, unit);
        unit.addEventListener("change", () => {
            field.retake();
            this.#entered();
        });
        return field;
    }

    #unit(motor: number): HTMLSelectElement {
        const options = [make("option", { value: "mm" }, "mm"), make("option", { value: "degree" }, "°")];
        const unit = make("select", { id: `machine-${motor}-unit` }, ...options);
        this.#units.push(unit);
        return unit;
    }

    #addNames(kind: "input" | "output", titleKey: Key, key: Key): void {
        const title = (): string => t(titleKey);
        const fields = LINES.map((number) => {
            const look: Look = { id: `machine-${kind}-${number}`, type: "text", label: () => t(key, { number }) };
            return this.#field(title, wiringPart(`${kind}_names`, number), look);
        });
        this.#group(title, fields);
    }

    #field(title: () => string, part: Part, look: Look, ...more: HTMLElement[]): MachineField {
        const field = new MachineField(part, look, () => this.#entered(), ...more);
        this.#fields.push({ title, field });
        return field;
    }

    #group(words: () => string, fields: MachineField[]): void {
        const place = make("legend");
        this.#titles.push({ place, words });
        this.#root.append(make("fieldset", {}, place, ...fields.map(({ box }) => box)));
    }

    #translate(): void {
        this.#titles.forEach(({ place, words }) => (place.textContent = words()));
        this.#units.forEach((unit) => unit.setAttribute("aria-label", t("machine.unit")));
        this.#fields.forEach(({ field }) => field.translate());
    }
}

/** Limits stay in steps, as the file has them. */
const limitLook = (motor: number, limit: "lowest" | "highest" | "fastest", per: "" | "/s"): Look => ({
    id: `machine-${motor}-${limit}`,
    type: "number",
    label: () => t(`machine.${limit}Field`),
    beside: (value) => besideWords(motor, value, per),
});

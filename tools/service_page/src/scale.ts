import type { ChartData } from "./chart";
import { byId } from "./dom";
import { language, numberText, t } from "./i18n";
import type { MachineContent } from "./machine_file";
import { MOTORS } from "./protocol";
import { Cell } from "./signal";
import { keepPreference, recallPreference } from "./storage";

/** How far steps go: so many of them are one of a unit. */
interface Scale {
    steps: number;
    unit: "mm" | "°";
}

const DIGITS = 3;

/** The scales in which motors are shown, by number; none: all are shown in steps. */
const scales = new Cell<ReadonlyMap<number, Scale>>(new Map());

/** Calls the listener when motors are shown in other units. */
export const onScale = (listener: () => void): void => scales.onChange(listener);

/** Whether motors are shown in mm or degrees. */
export const isScaled = (): boolean => scales.value.size > 0;

/** A speed in words. */
export function speedWords(motor: number, steps_per_s: number): string {
    const scale = scales.value.get(motor);
    return scale === undefined
        ? t("live.speed", { speed: numberText(steps_per_s) })
        : `${numberText(steps_per_s / scale.steps, DIGITS)} ${scale.unit}/s`;
}

/** What the field of a value of a motor says beside it in the unit of the machine; empty: the motor has none, or it is no number. */
export function besideWords(motor: number, value: number, per: "" | "/s" | "/s²"): string {
    const scale = scales.value.get(motor);
    return scale === undefined || Number.isNaN(value) ? "" : `= ${numberText(value / scale.steps, DIGITS)} ${scale.unit}${per}`;
}

/** A position as a number, with its unit if that is not the step. */
export function positionNumber(motor: number, steps: number): string {
    const scale = scales.value.get(motor);
    return scale === undefined ? numberText(steps) : `${numberText(steps / scale.steps, DIGITS)} ${scale.unit}`;
}

/** A position in words. */
export function positionWords(motor: number, steps: number): string {
    return scales.value.has(motor) ? positionNumber(motor, steps) : t("plan.steps", { steps: numberText(steps) });
}

/** Steps as they are to be drawn; a motor without a scale is left out where others have one. */
export function inUnits([xs, ...lines]: ChartData): ChartData {
    if (!isScaled()) {
        return [xs, ...lines];
    }
    const scaled = lines.map((line, index) => {
        const scale = scales.value.get(MOTORS[index] ?? 0);
        return line.map((value) => (value === null || scale === undefined ? null : value / scale.steps));
    });
    return [xs, ...scaled];
}

/** Whether a motor is left out of the curves, as it has no scale. */
export const isLeftOut = (motor: number): boolean => isScaled() && !scales.value.has(motor);

/** The switch between steps and the units that the machine has. */
export class ScaleSwitch {
    readonly #box = byId("scaled", HTMLInputElement);
    readonly #speed = byId("speed", HTMLInputElement);
    readonly #motor: Cell<number>;
    #known = new Map<number, Scale>();

    /** `motor` is that to which a speed is sent; 0: all. */
    constructor(motor: Cell<number>) {
        this.#motor = motor;
        this.#box.checked = recallPreference("scaled") === "yes";
        this.#box.addEventListener("change", () => {
            keepPreference("scaled", this.#box.checked ? "yes" : "no");
            this.#set();
        });
        this.#speed.addEventListener("input", () => this.#show());
        motor.onChange(() => this.#show());
        language.watch(() => this.#show());
    }

    /** Takes over what a machine says. */
    setMachine(machine: MachineContent | null): void {
        this.#known = new Map(
            (machine?.motors ?? []).flatMap(({ steps_per_mm: mm, steps_per_degree: degree }, index) => {
                const steps = mm ?? degree;
                return steps === undefined ? [] : [[index + 1, { steps, unit: mm === undefined ? "°" : "mm" }] as const];
            }),
        );
        this.#set();
    }

    #set(): void {
        scales.set(this.#box.checked ? this.#known : new Map());
        this.#show();
    }

    #show(): void {
        this.#box.closest("label")?.toggleAttribute("hidden", this.#known.size === 0);
        const units = [...new Set([...scales.value.values()].map(({ unit }) => unit))];
        const headings = [
            ["plan.speed", "scale.speeds", units.map((unit) => `${unit}/s`)],
            ["plan.position", "scale.positions", units],
        ] as const;
        for (const [steps, scaled, names] of headings) {
            const words = isScaled() ? t(scaled, { units: names.join(", ") }) : t(steps);
            document.querySelectorAll(`h3[data-t="${steps}"]`).forEach((heading) => (heading.textContent = words));
        }
        const words = besideWords(this.#motor.value, this.#speed.valueAsNumber, "/s");
        byId("speed-scaled", HTMLElement).textContent = words;
    }
}

import { showLamp } from "../common/lamp";
import { byId, make } from "../dom";
import { clockText, numberText } from "../language";
import { language, named, t } from "./i18n";
import { CONDITION, INPUTS, type Live } from "./protocol";
import type { Unit } from "./unit";

const TROUBLES = ["broken", "crc", "length", "pauses", "exceptions", "unsent", "silences"] as const;

/** Inputs of the unit, and what it tells of itself and of its line. */
export class Facts {
    readonly #unit: Unit;
    readonly #lamps = INPUTS.map((input) => this.#lamp(input));

    constructor(unit: Unit) {
        this.#unit = unit;
        unit.watch(() => this.#show());
        language.onChange(() => this.#show());
    }

    #show(): void {
        const now = this.#unit.now;
        this.#lamps.forEach((lamp, index) => {
            const level = now?.unit.inputs[index];
            lamp.disabled = this.#unit.state.value?.virtual !== true || level === undefined;
            const words = level === undefined ? t("live.unknown") : String(level);
            showLamp(lamp, `BI${index + 1}`, level === undefined ? null : level === 1, words + (lamp.disabled ? "" : `; ${t("live.toggle")}`));
        });
        const facts = now === null ? [] : factsOf(now);
        const shown = facts.map(({ words, isBad }) => make("span", isBad ? { class: "is-bad" } : {}, words));
        const list = byId("facts", HTMLElement);
        if (shown.map((fact) => fact.outerHTML).join("") !== list.innerHTML) {
            list.replaceChildren(...shown);
        }
    }

    #lamp(input: number): HTMLButtonElement {
        const lamp = make("button", { type: "button", class: "lamp" });
        lamp.addEventListener("click", () => {
            const level = this.#unit.now?.unit.inputs[input - 1];
            if (level !== undefined) {
                this.#unit.link.send({ type: "input", input, level: level === 1 ? 0 : 1 });
            }
        });
        byId("inputs", HTMLElement).append(lamp);
        return lamp;
    }
}

interface Fact {
    words: string;
    isBad?: boolean;
}

function factsOf({ unit }: Live): Fact[] {
    const of = (name: string): number => unit[name] ?? 0;
    const found: Fact[] = [
        { words: t("fact.since", { time: clockText(of("uptime") / 1000), cause: named("cause", of("start_cause")) }), isBad: of("start_cause") > 1 },
        { words: t("fact.frames", { count: numberText(of("frames")) }) },
    ];
    TROUBLES.filter((name) => of(name) > 0).forEach((name) => found.push({ words: `${named("line", name)} ${numberText(of(name))}` }));
    if (of("late_steps") > 0) {
        found.push({ words: t("fact.late", { count: numberText(of("late_steps")) }), isBad: true });
    }
    if ((unit.others ?? 0) > 0) {
        found.push({ words: t("fact.others", { rate: numberText(unit.others ?? 0, 1) }), isBad: true });
    }
    if (of("stood_s") >= 1) {
        found.push({ words: t("fact.stood", { seconds: numberText(of("stood_s")) }) });
    }
    if (of("condition") & CONDITION.notStored) {
        found.push({ words: t("fact.notStored") });
    }
    return found;
}

import { showLamp } from "../common/lamp";
import { byId, make } from "../dom";
import { language, numberText, t } from "./i18n";
import { INPUTS, OUTPUTS } from "./protocol";
import type { Unit } from "./unit";

const ALL_OFF = 0xff;

/** Inputs, outputs and spindle. The unit does not tell its outputs: what was not sent from here is not known. */
export class Switches {
    readonly #unit: Unit;
    readonly #inputs = INPUTS.map((_, index) => this.#lamp("inputs", () => this.#toggleInput(index)));
    readonly #outputs = OUTPUTS.map((_, bit) => this.#lamp("outputs", () => this.#toggleOutput(bit)));
    readonly #off = byId("outputs-off", HTMLButtonElement);
    readonly #spindle = byId("spindle", HTMLInputElement);
    /** Inputs of the virtual unit that were set in a reference run, in which it tells none. */
    readonly #set = new Map<number, 0 | 1>();

    constructor(unit: Unit) {
        this.#unit = unit;
        this.#off.addEventListener("click", () => this.#output(ALL_OFF));
        byId("spindle-form", HTMLFormElement).addEventListener("submit", (event) => {
            event.preventDefault();
            const permille = Math.round(10 * Number(this.#spindle.value));
            unit.link.send({ type: "spindle", id: unit.link.nextId(), permille });
        });
        unit.watch(() => this.#show());
        language.onChange(() => this.#show());
    }

    /** A unit that is not heard may have lost what it was told. */
    get #isThere(): boolean {
        return this.#unit.doing !== "unknown";
    }

    get #port(): number | null {
        return this.#isThere ? (this.#unit.state.value?.known.port ?? null) : null;
    }

    #show(): void {
        const state = this.#unit.state.value;
        const now = this.#unit.now;
        const isConnected = now !== null;
        if (this.#unit.doing !== "reference") {
            this.#set.clear();
        }
        this.#inputs.forEach((lamp, index) => {
            const level = now?.inputs[index] ?? this.#set.get(index);
            const [, name] = INPUTS[index] ?? INPUTS[0];
            lamp.disabled = state?.virtual !== true || this.#level(index) === undefined;
            const words = t(level === undefined ? "live.unknown" : level === 0 ? "live.closed" : "live.open");
            const more = lamp.disabled ? "" : `; ${t("live.toggle")}`;
            showLamp(lamp, t(`input.${name}`), level === undefined ? null : level === 0, `${words}${more}`);
        });
        const port = this.#port;
        this.#outputs.forEach((lamp, bit) => {
            const isOn = port === null ? null : ((port >> bit) & 1) === 0;
            lamp.disabled = port === null || !isConnected;
            showLamp(lamp, t(`output.${OUTPUTS[bit] ?? "spindle"}`), isOn, t(isOn === null ? "live.unknown" : isOn ? "live.on" : "live.off"));
        });
        this.#off.disabled = !isConnected;
        const spindle = this.#isThere ? (state?.known.spindle ?? null) : null;
        byId("spindle-now", HTMLElement).textContent = spindle === null ? "–" : `${numberText(spindle / 10, 1)} %`;
    }

    /** What an input is toggled from; undefined: that is not known. */
    #level(index: number): number | undefined {
        const before = this.#unit.doing === "reference" ? this.#unit.last.value?.inputs[index] : undefined;
        return this.#set.get(index) ?? this.#unit.now?.inputs[index] ?? before;
    }

    #toggleInput(index: number): void {
        const before = this.#level(index);
        const [input] = INPUTS[index] ?? INPUTS[0];
        if (before === undefined) {
            return;
        }
        const level = before === 1 ? 0 : 1;
        if (this.#unit.link.send({ type: "input", input, level }) && this.#unit.doing === "reference") {
            this.#set.set(index, level);
            this.#show();
        }
    }

    #toggleOutput(bit: number): void {
        if (this.#port !== null) {
            this.#output(this.#port ^ (1 << bit));
        }
    }

    #output(port: number): void {
        this.#unit.link.send({ type: "output", id: this.#unit.link.nextId(), port });
    }

    #lamp(host: string, act: () => void): HTMLButtonElement {
        const lamp = make("button", { type: "button", class: "lamp" });
        lamp.addEventListener("click", act);
        byId(host, HTMLElement).append(lamp);
        return lamp;
    }
}

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
        this.#inputs.forEach((lamp, index) => {
            const level = now?.inputs[index];
            const [, name] = INPUTS[index] ?? INPUTS[0];
            lamp.disabled = state?.virtual !== true || level === undefined;
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

    #toggleInput(index: number): void {
        const level = this.#unit.now?.inputs[index];
        const [input] = INPUTS[index] ?? INPUTS[0];
        if (level !== undefined) {
            this.#unit.link.send({ type: "input", input, level: level === 1 ? 0 : 1 });
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

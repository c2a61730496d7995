import { Chart, type ChartData, type Range } from "./chart";
import type { Quantity } from "./curve";
import { byId, make } from "./dom";
import { language, numberText, t } from "./i18n";
import type { Link } from "./link";
import { MOTORS, type Live, type UnitState } from "./protocol";

const SHOWN_SECONDS = 30;
const LINES = [1, 2, 3, 4, 5, 6, 7, 8] as const;

interface Card {
    root: HTMLElement;
    position: HTMLElement;
    speed: HTMLElement;
    state: HTMLElement;
}

/** What the unit does now: positions, speeds, inputs and outputs, and the last half minute of them. */
export class LiveView {
    readonly #link: Link;
    readonly #cards = MOTORS.map((motor) => this.#card(motor));
    readonly #inputs = LINES.map((line) => this.#lamp("button", "live-inputs", line));
    readonly #outputs = LINES.map((line) => this.#lamp("span", "live-outputs", line));
    readonly #charts: [speed: Chart, position: Chart];
    #samples: Live[] = [];
    #state: UnitState | null = null;

    constructor(link: Link) {
        this.#link = link;
        const range = (): Range => [-SHOWN_SECONDS, 0];
        const chart = (quantity: Quantity): Chart =>
            new Chart({ host: byId(`live-${quantity}`, HTMLElement), quantity, group: "live", range, showsTime: true });
        this.#charts = [chart("speed"), chart("position")];
        for (const [index, button] of this.#inputs.entries()) {
            button.addEventListener("click", () => this.#toggle(index));
        }
        link.on("live", (live) => this.#add(live));
        link.on("state", (state) => this.#setState(state));
        language.watch(() => this.#show());
    }

    get #last(): Live | undefined {
        return this.#samples.at(-1);
    }

    #add(live: Live): void {
        const last = this.#last;
        if (last && live.time_s < last.time_s) {
            this.#samples = [];
        }
        this.#samples.push(live);
        while ((this.#samples[0]?.time_s ?? live.time_s) < live.time_s - SHOWN_SECONDS) {
            this.#samples.shift();
        }
        this.#show();
    }

    #setState(state: UnitState): void {
        const isOther = state.port !== this.#state?.port || state.node !== this.#state.node;
        if (!state.connected || isOther) {
            this.#samples = [];
        }
        this.#state = state;
        this.#show();
    }

    #show(): void {
        const last = this.#last;
        this.#cards.forEach((card, index) => {
            const motor = last?.motors[index];
            const isMoving = motor !== undefined && (motor.speed !== 0 || !motor.idle);
            card.root.dataset.moving = String(isMoving);
            card.position.textContent = motor ? numberText(motor.position) : "–";
            card.speed.textContent = motor ? t("live.speed", { speed: numberText(motor.speed) }) : " ";
            card.state.textContent = motor ? t(isMoving ? "live.moves" : "live.idle") : "";
        });
        this.#showLamps(last);
        this.#charts[0].setData(this.#series("speed"));
        this.#charts[1].setData(this.#series("position"));
    }

    #showLamps(last: Live | undefined): void {
        for (const [lamps, levels] of [[this.#inputs, last?.inputs], [this.#outputs, last?.outputs]] as const) {
            lamps.forEach((lamp, index) => {
                const level = levels?.[index];
                lamp.dataset.level = level === undefined ? "unknown" : String(level);
                lamp.setAttribute("aria-pressed", String(level === 1));
            });
        }
        for (const [index, button] of this.#inputs.entries()) {
            const enabled = this.#state?.virtual === true && last?.inputs != null;
            (button as HTMLButtonElement).disabled = !enabled;
            const label = t(enabled ? "live.inputToggle" : "live.input", { number: index + 1 });
            button.setAttribute("aria-label", label);
            button.title = label;
        }
        for (const [index, lamp] of this.#outputs.entries()) {
            lamp.title = t("live.output", { number: index + 1 });
        }
        byId("live-hint", HTMLElement).hidden = last === undefined || last.inputs !== null;
    }

    #series(quantity: "speed" | "position"): ChartData {
        const now = this.#last?.time_s ?? 0;
        const times = this.#samples.map((sample) => sample.time_s - now);
        const values = (index: number): (number | null)[] =>
            this.#samples.map((sample) => sample.motors[index]?.[quantity] ?? null);
        return [times, ...MOTORS.map((_, index) => values(index))];
    }

    #toggle(index: number): void {
        const level = this.#last?.inputs?.[index];
        if (level !== undefined) {
            this.#link.send({ type: "input", input: index + 1, level: level === 1 ? 0 : 1 });
        }
    }

    #card(motor: number): Card {
        const position = make("output", { class: "card-position", id: `position-${motor}` }, "–");
        const speed = make("span", { class: "card-speed" });
        const state = make("span", { class: "card-state" });
        const name = make("span", { class: "card-name" }, make("i", { class: "led" }), `M${motor}`);
        const style = `--c: var(--motor-${motor})`;
        const head = make("div", { class: "card-head" }, name, state);
        const root = make("div", { class: "card", style }, head, position, speed);
        byId("live-cards", HTMLElement).append(root);
        return { root, position, speed, state };
    }

    #lamp(tag: "button" | "span", host: string, line: number): HTMLElement {
        const kind: Record<string, string> = tag === "button" ? { type: "button" } : { role: "img" };
        const lamp = make(tag, { class: "lamp", ...kind }, `${line}`);
        byId(host, HTMLElement).append(lamp);
        return lamp;
    }
}

import { Chart, type ChartData, type Range } from "./chart";
import type { Quantity } from "./curve";
import { byId, make } from "./dom";
import { language, numberText, t } from "./i18n";
import type { Link } from "./link";
import { lineCounts, lineWords, motorState, unitFacts } from "./live_words";
import { Pace } from "./pace";
import type { Presence } from "./presence";
import { GOES_ON, LINES, MOTORS, type Live, type MotorLive, type UnitState } from "./protocol";
import { inUnits, isScaled, onScale, positionNumber, speedWords } from "./scale";

const SHOWN_SECONDS = 30;
/** Looks further apart have no line between them. */
const GAP_SECONDS = 1;
const NOT_KNOWN = "–";

interface Card {
    root: HTMLElement;
    position: HTMLElement;
    speed: HTMLElement;
    state: HTMLElement;
}

/** What is wired to inputs or outputs, by number. */
type Names = Record<string, string>;

type Sample = Pick<Live, "time_s" | "motors">;

/**
 * What the unit does now: motors, inputs and outputs, and the last half minute of them. What was not told within
 * the last second is not known.
 */
export class LiveView {
    readonly #link: Link;
    readonly #presence: Presence;
    readonly #root = byId("live", HTMLElement);
    readonly #hint = byId("live-hint", HTMLElement);
    readonly #facts = byId("live-facts", HTMLElement);
    readonly #line = byId("live-line", HTMLElement);
    readonly #cards = MOTORS.map((motor) => this.#card(motor));
    readonly #inputs = LINES.map((line) => this.#lamp("button", "live-inputs", line));
    readonly #outputs = LINES.map((line) => this.#lamp("span", "live-outputs", line));
    readonly #charts: [speed: Chart, position: Chart];
    readonly #pace = new Pace(...GOES_ON);
    #samples: Sample[] = [];
    #last: Live | null = null;
    #came_ms = 0;
    #state: UnitState | null = null;
    #names: { inputs: Names; outputs: Names } = { inputs: {}, outputs: {} };

    constructor(link: Link, presence: Presence) {
        this.#link = link;
        this.#presence = presence;
        const range = (): Range => [-SHOWN_SECONDS, 0];
        const chart = (quantity: Quantity): Chart =>
            new Chart({
                host: byId(`live-${quantity}`, HTMLElement), quantity, group: "live", range, showsTime: true, isFine: isScaled,
            });
        this.#charts = [chart("speed"), chart("position")];
        for (const [index, button] of this.#inputs.entries()) {
            button.addEventListener("click", () => this.#toggle(index));
        }
        link.on("live", (live) => this.#add(live));
        link.on("state", (state) => this.#setState(state));
        presence.isFresh.onChange(() => this.#show());
        presence.seconds.onChange(() => this.#show());
        language.watch(() => this.#show());
        onScale(() => this.#show());
    }

    /** Says what is wired to inputs and outputs. */
    setNames(inputs: Names = {}, outputs: Names = {}): void {
        this.#names = { inputs, outputs };
        for (const [lamps, names] of [[this.#inputs, inputs], [this.#outputs, outputs]] as const) {
            lamps[0]?.closest(".lamps")?.classList.toggle("has-names", Object.keys(names).length > 0);
            lamps.forEach((lamp, index) => {
                const name = names[index + 1];
                lamp.classList.toggle("is-named", name !== undefined);
                lamp.replaceChildren(`${index + 1}`, ...(name === undefined ? [] : [" ", make("span", {}, name)]));
            });
        }
        this.#show();
    }

    /** What is known now. */
    get #known(): Live | null {
        return this.#presence.isFresh.value ? this.#last : null;
    }

    #add(live: Live): void {
        if (live.node !== this.#state?.node) {
            return;
        }
        const before = this.#samples.at(-1)?.time_s;
        if (before !== undefined && live.time_s < before) {
            this.#samples = [];
        } else if (before !== undefined && live.time_s > before + GAP_SECONDS) {
            this.#samples.push({ time_s: before, motors: [] });
        }
        this.#samples.push(live);
        while ((this.#samples[0]?.time_s ?? live.time_s) < live.time_s - SHOWN_SECONDS) {
            this.#samples.shift();
        }
        this.#last = live;
        this.#came_ms = performance.now();
        if (this.#pace.isDue(live)) {
            this.#show();
        }
    }

    #setState(state: UnitState): void {
        if (state.port !== this.#state?.port || state.node !== this.#state.node) {
            this.#samples = [];
            this.#last = null;
        }
        this.#state = state;
        this.#show();
    }

    #show(): void {
        const known = this.#known;
        this.#root.dataset.fresh = String(known !== null);
        this.#cards.forEach((card, index) => {
            const motor = known?.motors[index];
            if (motor) {
                this.#showMotor(card, motor, index + 1);
            } else {
                this.#showUnknown(card, this.#last?.motors[index], index + 1);
            }
        });
        this.#showLamps(known);
        this.#showHint(known);
        this.#showFacts(known);
        this.#charts[0].setData(this.#series("speed"));
        this.#charts[1].setData(this.#series("position"));
    }

    #showMotor(card: Card, motor: MotorLive, number: number): void {
        const [kind, words] = motorState(motor);
        card.root.dataset.state = kind;
        card.root.dataset.moving = String(motor.moving === true);
        card.position.textContent = positionNumber(number, motor.position);
        card.speed.textContent = motor.speed === null ? NOT_KNOWN : speedWords(number, motor.speed);
        card.state.textContent = words;
    }

    /** What a motor was like is told as a thing of the past. */
    #showUnknown(card: Card, last: MotorLive | undefined, number: number): void {
        card.root.dataset.state = "unknown";
        card.root.dataset.moving = "false";
        card.position.textContent = NOT_KNOWN;
        card.speed.textContent = "";
        const words = last ? t("live.lastPosition", { position: positionNumber(number, last.position) }) : t("live.unknown");
        card.state.textContent = words;
    }

    #showHint(known: Live | null): void {
        const seconds = this.#presence.seconds.value;
        const seen = seconds === null ? t("state.neverSeen") : t("state.seen", { seconds: numberText(seconds) });
        const isAsked = this.#state !== null && (this.#state.connected || this.#state.away || this.#last !== null);
        const words = known === null ? (isAsked ? t("live.silent", { seen }) : "") : known.unit ? "" : t("live.hint");
        if (this.#hint.textContent !== words) {
            this.#hint.textContent = words;
        }
        this.#hint.hidden = words === "";
    }

    #showFacts(known: Live | null): void {
        const unit = known?.unit;
        this.#facts.hidden = !unit;
        if (!unit) {
            return;
        }
        const facts = unitFacts(unit).map(({ words, isBad }) => make("span", isBad ? { class: "is-bad" } : {}, words));
        const isNews = facts.map((fact) => fact.outerHTML).join("") !== this.#line.previousElementSibling?.innerHTML;
        if (isNews) {
            this.#line.previousElementSibling?.replaceChildren(...facts);
        }
        this.#line.querySelector("summary")?.replaceChildren(lineWords(unit));
        this.#line.querySelector("p")?.replaceChildren(lineCounts(unit));
    }

    #showLamps(known: Live | null): void {
        for (const [lamps, levels] of [[this.#inputs, known?.inputs], [this.#outputs, known?.outputs]] as const) {
            lamps.forEach((lamp, index) => {
                const level = levels?.[index];
                lamp.dataset.level = level === undefined ? "unknown" : String(level);
                if (lamp instanceof HTMLButtonElement) {
                    lamp.setAttribute("aria-pressed", String(level === 1));
                }
            });
        }
        for (const [index, button] of this.#inputs.entries()) {
            const enabled = this.#state?.virtual === true && known?.inputs != null;
            (button as HTMLButtonElement).disabled = !enabled;
            const label = named(t(enabled ? "live.inputToggle" : "live.input", { number: index + 1 }), index + 1, this.#names.inputs);
            button.setAttribute("aria-label", label);
            button.title = label;
        }
        for (const [index, lamp] of this.#outputs.entries()) {
            lamp.title = named(t("live.output", { number: index + 1 }), index + 1, this.#names.outputs);
        }
    }

    /** Time goes on while nothing is told. */
    #series(quantity: "speed" | "position"): ChartData {
        const now_s = (this.#last?.time_s ?? 0) + (performance.now() - this.#came_ms) / 1000;
        const times = this.#samples.map((sample) => sample.time_s - now_s);
        const values = (index: number): (number | null)[] =>
            this.#samples.map((sample) => sample.motors[index]?.[quantity] ?? null);
        return inUnits([times, ...MOTORS.map((_, index) => values(index))]);
    }

    #toggle(index: number): void {
        const level = this.#known?.inputs?.[index];
        if (level !== undefined) {
            this.#link.send({ type: "input", input: index + 1, level: level === 1 ? 0 : 1 });
        }
    }

    #card(motor: number): Card {
        const position = make("output", { class: "card-position", id: `position-${motor}` }, NOT_KNOWN);
        const speed = make("span", { class: "card-speed", id: `speed-${motor}` });
        const state = make("span", { class: "card-state", id: `state-${motor}` });
        const name = make("span", { class: "card-name" }, make("i", { class: "led" }), `M${motor}`);
        const style = `--c: var(--motor-${motor})`;
        const head = make("div", { class: "card-head" }, name, speed);
        const root = make("div", { class: "card", style }, head, position, state);
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

/** What a lamp is, beginning with what stands on it. */
const named = (words: string, number: number, names: Names): string =>
    names[number] === undefined ? words : `${number} ${names[number]}: ${words}`;

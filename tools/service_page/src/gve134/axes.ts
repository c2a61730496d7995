import type { Danger } from "../danger";
import { byId, make } from "../dom";
import { fixedText } from "../language";
import { language, numberText, t, told } from "./i18n";
import { isOpen } from "./job";
import { AXES, FLAG, type Live, type MachineAxis } from "./protocol";
import { Reach } from "./reach";
import type { Unit } from "./unit";

const NOT_KNOWN = "–";
const STEPS = { machine: [0.01, 0.1, 1, 10, 50], pulses: [1, 10, 100, 1000, 10_000] };
const FIRST = { machine: { step: 1, speed: 600 }, pulses: { step: 100, speed: 1000 } };
const SPEED_MIN = 10;
const SPEED_MAX = 200_000;
const SECONDS_A_MINUTE = 60;
const BAD = ["fault", "crystal", "unknown"];
const WARN = ["waits", "stopped", "brakes", "reference"];

interface Card {
    root: HTMLElement;
    position: HTMLElement;
    speed: HTMLElement;
    steps: HTMLElement;
    bar: HTMLElement;
    jogs: HTMLButtonElement[];
    zero: HTMLButtonElement;
    home: HTMLButtonElement;
}

/** Where the axes are, how fast, and how they are moved by hand; `refuse` tells why that was not done. */
export class Axes {
    readonly #unit: Unit;
    readonly #danger: Danger;
    readonly #refuse: (words: string) => void;
    readonly #reach: Reach;
    readonly #cards = AXES.map((_, axis) => this.#card(axis));
    readonly #step = byId("jog-step", HTMLSelectElement);
    readonly #speed = byId("jog-speed", HTMLInputElement);
    readonly #homeAll = byId("home-all", HTMLButtonElement);
    #kind: keyof typeof STEPS | null = null;

    constructor(unit: Unit, danger: Danger, refuse: (words: string) => void) {
        this.#unit = unit;
        this.#danger = danger;
        this.#refuse = refuse;
        this.#reach = new Reach(unit);
        this.#homeAll.addEventListener("click", () => this.#home(null));
        unit.watch(() => this.#show());
        danger.isConfirmed.onChange(() => this.#show());
        language.onChange(() => {
            this.#kind = null;
            this.#cards.forEach((card, axis) => this.#name(card, axis));
            this.#show();
        });
    }

    #machineAxis(axis: number): MachineAxis | null {
        return this.#unit.state.value?.machine?.axes[axis] ?? null;
    }

    #show(): void {
        this.#showTools();
        const now = this.#unit.now;
        byId("live", HTMLElement).dataset.fresh = String(now !== null);
        const { doing, last } = this.#unit;
        const state = byId("live-state", HTMLElement);
        state.textContent = t(`is.${doing}`);
        state.dataset.kind = BAD.includes(doing) ? "bad" : WARN.includes(doing) ? "warn" : "good";
        byId("live-more", HTMLElement).textContent = now === null ? "" : moreOf(now);
        const mayChange = doing === "rest" && !isOpen(this.#unit.state.value?.job ?? null);
        const mayMove = mayChange && this.#danger.isConfirmed.value;
        this.#homeAll.disabled = !mayMove || !AXES.some((_, axis) => this.#machineAxis(axis)?.homes === true);
        this.#cards.forEach((card, axis) => {
            this.#showCard(card, axis, now, last.value);
            const isThere = !this.#unit.state.value?.machine || this.#machineAxis(axis) !== null;
            card.jogs.forEach((jog) => (jog.disabled = !mayMove || !isThere));
            card.zero.disabled = !mayChange || !isThere;
            card.home.hidden = this.#machineAxis(axis)?.homes !== true;
            card.home.disabled = !mayMove;
        });
    }

    #showTools(): void {
        const kind = this.#unit.state.value?.machine ? "machine" : "pulses";
        if (kind === this.#kind) {
            return;
        }
        const unit = kind === "machine" ? "mm" : t("jog.pulses");
        const isOther = this.#step.options.length === 0 || !STEPS[kind].includes(Number(this.#step.value));
        const chosen = isOther ? FIRST[kind].step : Number(this.#step.value);
        this.#kind = kind;
        this.#step.replaceChildren(
            ...STEPS[kind].map((step) => make("option", { value: String(step) }, `${numberText(step, 2)} ${unit}`)),
        );
        this.#step.value = String(chosen);
        this.#speed.value = isOther ? String(FIRST[kind].speed) : this.#speed.value;
        // What is more than a machine's axis may do is made less for each axis.
        [this.#speed.min, this.#speed.max] = kind === "machine" ? ["1", ""] : [String(SPEED_MIN), String(SPEED_MAX)];
        const label = this.#speed.previousElementSibling;
        if (label !== null) {
            label.textContent = t(kind === "machine" ? "jog.speed" : "jog.speedSteps");
        }
    }

    #showCard(card: Card, axis: number, now: Live | null, last: Live | null): void {
        const at = now?.positions[axis] ?? null;
        const speed = now?.speeds[axis] ?? null;
        const of = this.#machineAxis(axis);
        const unit = of === null ? t("jog.pulses") : of.unit === "mm" ? "mm" : "°";
        const [per, digits] = [of?.steps_per_unit ?? 1, of === null ? 0 : 3];
        const was = last?.positions[axis];
        const before = was === undefined ? "" : t("live.was", { steps: numberText(was) });
        card.root.dataset.state = at === null ? "unknown" : "known";
        card.root.dataset.moving = String(speed !== null && speed !== 0);
        card.position.textContent = at === null ? NOT_KNOWN : `${fixedText(at / per, digits)} ${of === null ? "" : unit}`;
        card.steps.textContent = at === null ? before : t("live.steps", { steps: numberText(at) });
        const shown = speed === null ? NOT_KNOWN : numberText(speed / per, of === null ? 0 : 1);
        card.speed.textContent = at === null ? "" : t("live.speed", { speed: shown, unit });
        const most = of?.speed ?? SPEED_MAX;
        card.bar.style.width = `${Math.min(100, (100 * Math.abs(speed ?? 0)) / most)}%`;
    }

    #jog(axis: number, sign: number): void {
        if (!this.#speed.reportValidity()) {
            return;
        }
        const of = this.#machineAxis(axis);
        const step = Math.max(1, Math.round(Number(this.#step.value) * (of?.steps_per_unit ?? 1)));
        const wanted = of === null ? Number(this.#speed.value) : (Number(this.#speed.value) / SECONDS_A_MINUTE) * of.steps_per_unit;
        const speed = Math.round(Math.min(Math.max(wanted, SPEED_MIN), of?.speed ?? SPEED_MAX));
        const parts = AXES.map((_, index) => (index === axis ? sign * step : 0));
        const obstacle = this.#reach.obstacle(axis, sign * step, of);
        if (obstacle !== null) {
            this.#refuse(obstacle);
            return;
        }
        const id = this.#unit.link.nextId();
        if (this.#unit.link.send({ type: "jog", id, parts, speed })) {
            this.#reach.note(id, axis, sign * step);
        }
    }

    #home(axis: string | null): void {
        this.#unit.link.send({ type: "home", id: this.#unit.link.nextId(), axis });
    }

    #card(axis: number): Card {
        const name = AXES[axis] ?? "";
        const part = <K extends keyof HTMLElementTagNameMap>(tag: K, kind: string): HTMLElementTagNameMap[K] =>
            make(tag, { class: kind, id: `${kind.slice(5)}-${name}` });
        const [position, speed, steps] = [part("output", "card-position"), part("span", "card-speed"), part("span", "card-steps")];
        const bar = make("i", {});
        const button = (act: () => void): HTMLButtonElement => {
            const made = make("button", { type: "button" });
            made.addEventListener("click", act);
            return made;
        };
        const setZero = (): void => {
            this.#unit.link.send({ type: "typed", id: this.#unit.link.nextId(), text: `N${name}0` });
        };
        const jogs = [button(() => this.#jog(axis, -1)), button(() => this.#jog(axis, 1))];
        const zero = button(setZero);
        const home = button(() => this.#home(name));
        const head = make("div", { class: "card-head" }, make("span", { class: "card-name" }, make("i", { class: "led" }), name), speed);
        const root = make(
            "div", { class: "card", style: `--c: var(--motor-${axis + 1})` },
            head, position, steps, make("span", { class: "card-bar" }, bar), make("div", { class: "card-acts" }, ...jogs, zero, home),
        );
        byId("axes", HTMLElement).append(root);
        const card = { root, position, speed, steps, bar, jogs, zero, home };
        this.#name(card, axis);
        return card;
    }

    #name(card: Card, axis: number): void {
        const name = AXES[axis] ?? "";
        const texts = [`${name}−`, `${name}+`, t("jog.zero"), t("jog.home")];
        const labels = [t("jog.minus", { axis: name }), t("jog.plus", { axis: name }), t("jog.zeroLabel", { axis: name }), `${name}: ${t("jog.homeLabel")}`];
        [...card.jogs, card.zero, card.home].forEach((button, index) => {
            button.textContent = texts[index] ?? "";
            button.title = labels[index] ?? "";
            button.setAttribute("aria-label", `${texts[index]} ${labels[index]}`);
        });
    }
}

function moreOf({ causes, flags, late, stood_s = 0 }: Live): string {
    const found = [
        causes.length > 0 ? t("live.stoppedBy", { causes: causes.map(told).join(", ") }) : "",
        flags & FLAG.full ? t("live.full") : "",
        late ? t("live.late", { count: late }) : "",
        stood_s >= 1 ? t("live.stood", { seconds: numberText(stood_s) }) : "",
    ];
    return found.filter((words) => words !== "").join(" · ");
}

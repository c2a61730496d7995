import type { Danger } from "../danger";
import { make } from "../dom";
import { numberText } from "../language";
import { FeedField } from "./feed";
import { language, named, t, type Key } from "./i18n";
import { mmText } from "./numbers";
import { FAULTS, FEED_PER_MM_MIN, FLAG, STATUS, UM_PER_MM, type AxisLive, type Method } from "./protocol";
import { isUnderWay, moves, type Unit } from "./unit";

const NOT_KNOWN = "–";
const STEPS_TOP = 200_000;
const SECONDS_A_MINUTE = 60;
const BITS = ["JEDE", "SMER", "POL", "DISP", "PROG", "ERR"] as const;
const FLAGS = ["REFERENCED", "HOMING", "ARMED", "LIMIT_MINUS", "LIMIT_PLUS", "REFERENCE", "CAPTURE"] as const;
const ALWAYS = ["REFERENCED"];
const WITH_FEED = ["WAITING", "READY", "MOVING", "REACHED"];
const STANDS_WITH_ROOM = ["TAKEN", "READY", "REACHED"];

type Acts = "hold" | "go" | "take" | "release" | "move" | "measure" | "home" | "capture";

/** An axis: what it does, and what may be done with it. */
export class Card {
    readonly #unit: Unit;
    readonly #danger: Danger;
    readonly #axis: number;
    readonly #parts: Record<"name" | "state" | "position" | "steps" | "target" | "speed" | "asked" | "bits" | "trouble" | "captured", HTMLElement>;
    readonly #acts: Record<Acts, HTMLButtonElement>;
    readonly #feed: FeedField;
    readonly #way: HTMLInputElement;
    readonly #accel: HTMLInputElement;
    readonly #kind: HTMLSelectElement;
    readonly #method: HTMLSelectElement;
    readonly #reference: HTMLInputElement;
    readonly #more: HTMLElement;
    #look = "";
    readonly root: HTMLElement;

    constructor(unit: Unit, danger: Danger, axis: number) {
        this.#unit = unit;
        this.#danger = danger;
        this.#axis = axis;
        const part = (tag: "span" | "output" | "p" | "div", name: string): HTMLElement => make(tag, { class: `card-${name}`, id: `${name}-${axis}` });
        this.#parts = {
            name: make("span", {}), state: part("span", "state"), position: part("output", "position"), steps: part("span", "steps"),
            target: part("p", "target"), speed: part("span", "speed"), asked: part("span", "asked"), bits: part("div", "bits"),
            trouble: part("p", "trouble"), captured: part("span", "captured"),
        };
        this.#acts = {
            hold: this.#button("hold", () => unit.askAxis("hold", axis)), go: this.#button("go", () => this.#go()),
            take: this.#button("take", () => unit.askAxis("take", axis)), release: this.#button("release", () => unit.askAxis("release", axis)),
            move: this.#button("move", () => this.#measure(true)), measure: this.#button("measure", () => this.#measure(false)),
            home: this.#button("home", () => this.#home()), capture: this.#button("capture", () => unit.askAxis("capture", axis)),
        };
        this.#feed = new FeedField(axis, (feed) => this.#setFeed(feed));
        this.#way = number(`way-${axis}`, "10", { step: "0.001", min: "-2147483.647", max: "2147483.647" });
        this.#accel = number(`accel-${axis}`, "500", { step: "1", min: "1", max: "65535" });
        this.#kind = make("select", { id: `kind-${axis}` }, make("option", { value: "way" }), make("option", { value: "position" }));
        this.#method = make("select", { id: `method-${axis}` }, ...[21, 19, 37].map((method) => make("option", { value: String(method) })));
        this.#reference = number(`reference-${axis}`, "0", { step: "0.001", min: "-2147483.647", max: "2147483.647" });
        this.#more = make("summary", {});
        this.root = this.#build();
        this.name();
    }

    /** Its words in the chosen language. */
    name(): void {
        const axis = this.#axis;
        this.#parts.name.textContent = t("axis.name", { axis });
        for (const name of ["hold", "go", "release", "move", "measure", "home", "capture"] as const) {
            label(this.#acts[name], `axis.${name}`, axis);
        }
        this.#feed.name(axis);
        const fields = [[this.#way, "axis.way"], [this.#accel, "axis.accel"], [this.#kind, "axis.kind"], [this.#method, "axis.method"], [this.#reference, "axis.reference"]] as const;
        for (const [field, key] of fields) {
            field.setAttribute("aria-label", t(key, { axis }));
            field.title = t(key, { axis });
        }
        [...this.#kind.options].forEach((option) => (option.textContent = named("kind", option.value)));
        [...this.#method.options].forEach((option) => (option.textContent = named("method", option.value)));
        this.#more.textContent = t("axis.more");
    }

    show(): void {
        const live = this.#unit.axis(this.#axis);
        const last = this.#unit.last.value?.axes[this.#axis - 1] ?? null;
        this.root.dataset.state = live === null ? "unknown" : stateKind(live);
        this.root.dataset.moving = String(live !== null && moves(live));
        this.#showWay(live, last);
        this.#showBits(live);
        this.#showTrouble(live);
        this.#showActs(live);
        const { STEPS: steps, MICROMETRES: um, HIGHEST_FEED: highest } = this.#settings ?? {};
        if (steps !== undefined && um !== undefined && highest !== undefined) {
            this.#feed.setTop(Math.min(highest / FEED_PER_MM_MIN, (STEPS_TOP * SECONDS_A_MINUTE * um) / steps / UM_PER_MM));
        }
        if (live !== null) {
            this.#feed.take(live.feed);
        }
    }

    get #settings(): Record<string, number> | null {
        return this.#unit.settings.value.values?.[`axis${this.#axis}` as "axis1"] ?? null;
    }

    #showWay(live: AxisLive | null, last: AxisLive | null): void {
        const { state, position, steps, target, speed, asked } = this.#parts;
        state.textContent = live === null ? t("live.unknown") : `${live.state} · ${named("is", live.state)}`;
        position.textContent = live === null ? NOT_KNOWN : `${mmText(live.position_um)} mm`;
        steps.textContent = live !== null ? t("axis.steps", { steps: numberText(live.position_steps) }) : last === null ? "" : t("axis.was", { mm: mmText(last.position_um) });
        target.textContent = live === null ? "" : this.#targetText(live);
        speed.textContent = live === null ? "" : t("axis.speed", { speed: numberText(live.speed / FEED_PER_MM_MIN, 1) });
        const feed = live === null ? "" : numberText(live.feed / FEED_PER_MM_MIN, 1);
        asked.textContent = live === null ? "" : t(live.permitted ? "axis.asked" : "axis.askedHeld", { feed });
        this.#parts.captured.textContent = live === null || live.captures === 0 ? "" : t("axis.captured", { mm: mmText(live.captured_um), count: live.captures });
    }

    #targetText(live: AxisLive): string {
        const hasTarget = isUnderWay(live) && (live.flags & FLAG.HOMING) === 0;
        if (!hasTarget) {
            return t("axis.noTarget");
        }
        const { STEPS: steps, MICROMETRES: um } = this.#settings ?? {};
        const whole = steps === undefined || um === undefined ? NOT_KNOWN : numberText(live.position_steps + Math.round((live.way_left_um * steps) / um));
        return t("axis.target", { mm: mmText(live.position_um + live.way_left_um), steps: whole, left: mmText(live.way_left_um) });
    }

    #showBits(live: AxisLive | null): void {
        const has = (value: number | undefined, bit: number): boolean | null => (value === undefined ? null : (value & bit) !== 0);
        const bits: [name: string, isOn: boolean | null][] = [
            ...BITS.map((name): [string, boolean | null] => [name, has(live?.status, STATUS[name])]), ["MP", live?.permitted ?? null],
            ...FLAGS.map((name): [string, boolean | null] => [name, has(live?.flags, FLAG[name])]).filter(([name, isOn]) => ALWAYS.includes(name) || isOn),
        ];
        const look = `${language.value} ${bits.join(" ")}`;
        if (look !== this.#look) {
            this.#look = look;
            this.#parts.bits.replaceChildren(...bits.map(([name, isOn]) => chip(name, isOn)));
        }
    }

    #showTrouble(live: AxisLive | null): void {
        const words = [];
        if (live !== null && live.error !== 0) {
            words.push(t("axis.error", { number: live.error, words: named("error", live.error) }), t(FAULTS.includes(live.error) ? "axis.fault" : "axis.refused"));
        }
        if (live?.by_other) {
            words.push(t("axis.byOther"));
        }
        const text = words.join(" ");
        if (this.#parts.trouble.textContent !== text) {
            this.#parts.trouble.textContent = text;
        }
    }

    #showActs(live: AxisLive | null): void {
        const { hold, go, take, release, move, measure, home, capture } = this.#acts;
        const isFree = live?.state === "FREE";
        const hasRoom = live !== null && STANDS_WITH_ROOM.includes(live.state) && !moves(live);
        const canMove = hasRoom || (isFree && live !== null && !moves(live));
        const isNoted = this.#unit.state.value?.restarted !== true;
        hold.disabled = !this.#unit.link.isOpen.value || isFree;
        const mayMove = isNoted && this.#danger.isConfirmed.value;
        go.disabled = live === null || !mayMove || !["WAITING", "READY", "MOVING"].includes(live.state);
        take.disabled = live === null || !isNoted;
        release.disabled = live === null || isFree;
        move.disabled = home.disabled = !canMove || !mayMove;
        measure.disabled = !hasRoom || !mayMove;
        capture.disabled = live === null;
        const kind = live === null || !(live.status & STATUS.DISP) ? "take" : live.status & STATUS.ERR ? "clear" : isUnderWay(live) ? "drop" : "take";
        label(take, `axis.${kind}`, this.#axis);
        take.classList.toggle("danger", kind === "clear");
    }

    /**
     * In other states the unit takes no feed: it goes with the next motion. So does one that speeds an axis up before the danger
     * was confirmed; a lower one is sent at once.
     */
    #setFeed(feed: number): void {
        const live = this.#unit.axis(this.#axis);
        if (live !== null && WITH_FEED.includes(live.state) && (this.#danger.isConfirmed.value || feed < live.feed)) {
            this.#unit.link.send({ type: "control", id: this.#unit.link.nextId(), axis: this.#axis, feed });
        }
    }

    #go(): void {
        if (this.#feed.isValid()) {
            this.#unit.link.send({ type: "control", id: this.#unit.link.nextId(), axis: this.#axis, feed: this.#feed.feed, permitted: true });
        }
    }

    #measure(isMove: boolean): void {
        if (!this.#way.reportValidity() || !this.#accel.reportValidity() || !this.#feed.isValid()) {
            return;
        }
        this.#unit.link.send({
            type: "measure", id: this.#unit.link.nextId(), axis: this.#axis, um: umOf(this.#way), accel: Number(this.#accel.value),
            absolute: this.#kind.value === "position", ...(isMove ? { feed: this.#feed.feed } : {}),
        });
    }

    #home(): void {
        if (!this.#reference.reportValidity() || !this.#accel.reportValidity() || !this.#feed.isValid()) {
            return;
        }
        this.#unit.link.send({
            type: "home", id: this.#unit.link.nextId(), axis: this.#axis, method: Number(this.#method.value) as Method,
            um: umOf(this.#reference), accel: Number(this.#accel.value), feed: this.#feed.feed,
        });
    }

    #button(name: string, act: () => void): HTMLButtonElement {
        const made = make("button", { type: "button", id: `${name}-${this.#axis}` });
        made.addEventListener("click", act);
        return made;
    }

    #build(): HTMLElement {
        const { name, state, position, steps, target, speed, asked, bits, trouble, captured } = this.#parts;
        const { hold, go, take, release, move, measure, home, capture } = this.#acts;
        hold.classList.add("hold");
        move.classList.add("primary");
        const row = (kind: string, ...children: (Node | string)[]): HTMLElement => make("div", { class: `row tight ${kind}` }, ...children);
        const unit = (text: string): HTMLElement => make("span", { class: "hint" }, text);
        return make(
            "section", { class: "card", id: `axis-${this.#axis}`, style: `--c: var(--motor-${this.#axis})` },
            make("h3", { class: "card-head" }, make("span", { class: "card-name" }, make("i", { class: "led" }), name), speed), state,
            row("where", position, steps), target,
            row("first", hold, go), asked, this.#feed.root,
            row("fields", this.#kind, this.#way, unit("mm"), this.#accel, unit("mm/s²")), row("", move, measure),
            make("details", {}, this.#more, row("fields", this.#method, this.#reference, unit("mm"), home), row("fields", capture, captured)),
            row("owner", take, release),
            bits, trouble, // below the buttons, which so stay where they are
        );
    }
}

function chip(name: string, isOn: boolean | null): HTMLElement {
    const words = `${named("bit", name)}: ${t(isOn === null ? "live.unknown" : isOn ? "bit.is1" : "bit.is0")}`;
    const level = isOn === null ? "unknown" : isOn ? "1" : "0";
    return make("span", { class: "bit", "data-level": level, title: words, role: "img", "aria-label": `${name}: ${words}` }, name);
}

const number = (id: string, value: string, limits: Record<string, string>): HTMLInputElement =>
    make("input", { type: "number", class: "number", id, value, required: "", ...limits });

const umOf = (field: HTMLInputElement): number => Math.round(Number(field.value) * UM_PER_MM);

/** A button begins its name with what stands on it. */
function label(button: HTMLButtonElement, key: string, axis: number): void {
    const text = t(key as Key);
    const words = t(`${key}Label` as Key, { axis });
    button.textContent = text;
    button.title = words;
    button.setAttribute("aria-label", `${text}: ${words}`);
}

function stateKind(live: AxisLive): string {
    if (live.error !== 0) {
        return "failed";
    }
    return live.state === "READY" && !live.permitted ? "stopped" : live.state.toLowerCase();
}

import { Refused, checkProgram } from "./api";
import { goTo, homingOf, moveOf, runOf, settingsOf, type Settings } from "./commission_programs";
import { Danger } from "./danger";
import { byId, debounced, make } from "./dom";
import { HoldButton } from "./hold_button";
import { language, numberText, t } from "./i18n";
import { Jog } from "./jog";
import { onLimits, speedLimit } from "./limits";
import type { Link } from "./link";
import { Pace } from "./pace";
import type { Presence } from "./presence";
import { GOES_ON, MOTORS, type Live, type MotorLive, type UnitState } from "./protocol";
import { told } from "./common/told";
import { NotPossible, computeRamp, type Ramp } from "./ramp";
import { besideWords, onScale, positionNumber } from "./scale";
import type { Cell } from "./signal";
import { keep, recall } from "./storage";

const TYPING_MS = 150;
const FIELDS = ["start", "speed", "ramp", "trial", "farthest", "step", "input", "search", "away"] as const;

type Field = (typeof FIELDS)[number];

/** Fields of steps, and what they are steps of. */
const SCALED: readonly (readonly [Field, "" | "/s" | "/s²"])[] = [
    ["start", "/s"], ["speed", "/s"], ["ramp", "/s²"], ["trial", ""], ["farthest", ""], ["step", ""], ["search", "/s"], ["away", ""],
];

/** What this panel needs of the others. */
export interface Around {
    /** Motor whose program is shown, and which is meant here. */
    motor: Cell<number>;
    /** Puts a text at the cursor of its program. */
    insert: (text: string) => void;
    stop: () => void;
}

/**
 * Bringing a machine to life: running a motor by hand, S, V and A, teaching positions, searching a switch. Nothing moves
 * before the user has confirmed to have read what is dangerous, once for each unit and opening of the page.
 */
export class Commission {
    readonly #link: Link;
    readonly #presence: Presence;
    readonly #around: Around;
    readonly #jog: Jog;
    readonly #buttons: HoldButton[];
    readonly #danger = new Danger("commission-confirm");
    readonly #why = byId("commission-why", HTMLElement);
    readonly #motor = byId("commission-motor", HTMLSelectElement);
    readonly #weighSoon = debounced(TYPING_MS, () => void this.#weigh());
    readonly #pace = new Pace(...GOES_ON);
    #live: Live | null = null;
    #state: UnitState | null = null;
    #ramp: Ramp | NotPossible | null = null;
    /** A step whose motor was not looked at since: its number until it is answered, then true. */
    #begun: number | boolean = false;

    constructor(link: Link, presence: Presence, around: Around) {
        this.#link = link;
        this.#presence = presence;
        this.#around = around;
        this.#jog = new Jog(link, presence.isFresh, around.stop);
        this.#buttons = this.#holdButtons();
        this.#recallFields();
        this.#addUnits();
        this.#listen();
        around.motor.watch((motor) => this.#motorChanged(motor));
        link.on("live", (live) => this.#see(live));
        link.on("state", (state) => this.#setState(state));
        link.on("answer", ({ id, from }) => {
            if (id === this.#begun && (from ?? link.client) === link.client) {
                this.#begun = true;
            }
        });
        link.isOpen.onChange(() => (this.#begun = false));
        for (const cell of [presence.isFresh, this.#jog.phase, this.#jog.left, this.#danger.isConfirmed]) {
            cell.onChange(() => this.#show());
        }
        language.watch(() => this.#translate());
        onScale(() => this.#show());
        onLimits(() => this.#show());
        this.#weighSoon();
    }

    /** All motors were told to stop. */
    stopped(): void {
        this.#jog.stopped();
    }

    #field(name: Field): HTMLInputElement {
        return byId(`commission-${name}`, HTMLInputElement);
    }

    get #settings(): Settings {
        const [start, speed, ramp] = (["start", "speed", "ramp"] as const).map((name) => this.#field(name).value.trim());
        return { start: start ?? "", speed: speed ?? "", ramp: ramp ?? "" };
    }

    /** What is known of the motor now. */
    get #known(): MotorLive | null {
        return (this.#presence.isFresh.value && this.#live?.motors[this.#around.motor.value - 1]) || null;
    }

    #holdButtons(): HoldButton[] {
        const within = byId("commission-jog", HTMLElement);
        const button = (id: string, key: string, direction: 1 | -1): HoldButton =>
            new HoldButton(byId(id, HTMLButtonElement), within, key, {
                press: () => this.#press(direction),
                release: () => this.#jog.release(),
            });
        return [button("jog-back", "ArrowLeft", -1), button("jog-forth", "ArrowRight", 1)];
    }

    #listen(): void {
        const click = (id: string, action: () => void): void =>
            byId(id, HTMLButtonElement).addEventListener("click", action);
        click("step-back", () => this.#step(-1));
        click("step-forth", () => this.#step(1));
        click("commission-zero", () => this.#send("\\C100"));
        click("commission-teach", () => this.#teach());
        click("commission-settings", () => this.#around.insert(settingsOf(this.#settings)));
        byId("homing-form", HTMLFormElement).addEventListener("submit", (event) => {
            event.preventDefault();
            this.#insertHoming();
        });
        byId("ramp-form", HTMLFormElement).addEventListener("submit", (event) => event.preventDefault());
        this.#motor.addEventListener("change", () => this.#around.motor.set(Number(this.#motor.value)));
        for (const name of FIELDS) {
            this.#field(name).addEventListener("input", () => {
                keep("commission", Object.fromEntries(FIELDS.map((each) => [each, this.#field(each).value])));
                this.#weighSoon();
                this.#show();
            });
        }
    }

    /** Beside each field, what it is in mm or degrees. */
    #addUnits(): void {
        for (const [name] of SCALED) {
            this.#field(name).after(make("small", { id: `commission-${name}-scaled`, class: "hint" }));
        }
    }

    #showUnits(): void {
        for (const [name, per] of SCALED) {
            this.#say(`commission-${name}-scaled`, besideWords(this.#around.motor.value, this.#field(name).valueAsNumber, per));
        }
    }

    #recallFields(): void {
        const kept = recall<Partial<Record<Field, string>>>("commission", {});
        for (const name of FIELDS) {
            this.#field(name).value = String(kept[name] ?? this.#field(name).value);
        }
    }

    #motorChanged(motor: number): void {
        this.#buttons.forEach((button) => button.release());
        this.#motor.value = String(motor);
        this.#show();
    }

    #see(live: Live): void {
        this.#live = live;
        const isNews = this.#pace.isDue(live) || this.#begun === true;
        this.#begun = this.#begun === true ? false : this.#begun;
        if (isNews) {
            this.#show();
        }
    }

    /** Another unit is another machine. */
    #setState(state: UnitState): void {
        if (this.#danger.setPlace(state)) {
            this.#live = null;
            this.#jog.left.set(null);
        }
        this.#state = state;
        this.#show();
    }

    #number(name: Field): number {
        const field = this.#field(name);
        return field.validity.valid && field.value !== "" ? field.valueAsNumber : 0;
    }

    #press(direction: 1 | -1): void {
        if (this.#obstacle() === null && this.#field("farthest").reportValidity()) {
            const text = runOf(this.#settings, direction, this.#number("farthest"));
            this.#jog.press(this.#around.motor.value, text);
        }
    }

    #step(direction: 1 | -1): void {
        if (this.#obstacle() === null && this.#field("step").reportValidity()) {
            this.#send(moveOf(this.#settings, direction * this.#number("step")));
        }
    }

    #send(text: string): void {
        const [motor, id] = [this.#around.motor.value, this.#link.nextId()];
        if (this.#begun === false && this.#link.send({ type: "request", id, message: "send", motor, text })) {
            this.#begun = id;
            this.#show();
        }
    }

    /** Why the motor may not be moved from here now, in words; null: it may. */
    #obstacle(): string | null {
        const motor = this.#known;
        if (motor === null) {
            return t("commission.notKnown");
        }
        if (motor.moving === null) {
            return t("commission.original");
        }
        if ((this.#state?.stop ?? null) !== null) {
            return t("commission.stopOpen");
        }
        if (motor.moving || (motor.running === true && motor.stopped !== true)) {
            return t("commission.runs");
        }
        const limit = speedLimit(this.#around.motor.value);
        if (Math.max(this.#number("start"), this.#number("speed")) > limit) {
            return t("limits.hand", { limit: numberText(limit) });
        }
        return this.#ramp instanceof NotPossible ? this.#ramp.message : null;
    }

    #show(): void {
        const isIdle = this.#jog.phase.value === "rest";
        const why = isIdle ? this.#obstacle() : null;
        const isReady = this.#danger.isConfirmed.value && why === null && this.#begun === false;
        for (const id of ["jog-back", "jog-forth"]) {
            byId(id, HTMLButtonElement).disabled = !isReady;
        }
        for (const id of ["step-back", "step-forth", "commission-zero"]) {
            byId(id, HTMLButtonElement).disabled = !(isReady && isIdle);
        }
        this.#motor.disabled = !isIdle;
        const motor = this.#known;
        const canTeach = motor !== null && motor.moving === false;
        byId("commission-teach", HTMLButtonElement).disabled = !canTeach;
        const place = motor === null ? t("commission.unknown") : positionNumber(this.#around.motor.value, motor.position);
        byId("commission-position", HTMLElement).textContent = place;
        const left = this.#jog.left.value;
        const rest = isIdle && left !== null ? t("commission.left", { motor: left }) : "";
        const words = this.#danger.isConfirmed.value ? [why ?? "", rest].filter((part) => part !== "").join(" ") : "";
        if (this.#why.textContent !== words) {
            this.#why.textContent = words;
        }
        this.#why.hidden = words === "";
        this.#showReach();
        this.#showUnits();
    }

    /** What happens where nothing can stop the motor. */
    #showReach(): void {
        const steps = this.#number("farthest");
        const key = steps > 0 ? "commission.reach" : "commission.noReach";
        byId("commission-reach", HTMLElement).textContent = t(key, { steps: numberText(steps) });
    }

    #teach(): void {
        const motor = this.#known;
        if (motor === null || motor.moving !== false) {
            return;
        }
        const command = goTo(motor.position);
        this.#say("teach-words", command === null ? t("commission.negative") : t("commission.taught", { command }));
        if (command !== null) {
            this.#around.insert(command);
        }
    }

    #say(id: string, words: string): void {
        byId(id, HTMLElement).textContent = words;
    }

    #insertHoming(): void {
        const homing = {
            run: byId("homing-run", HTMLSelectElement).value === "(" ? ("(" as const) : (")" as const),
            input: this.#field("input").value,
            speed: this.#field("search").value,
            away: this.#field("away").value,
            twice: byId("homing-twice", HTMLInputElement).checked,
        };
        const side = t(homing.run === "(" ? "commission.backward" : "commission.forward");
        const text = homingOf(homing, this.#settings, {
            speed: t("homing.speed"),
            search: t("homing.search", { side, input: homing.input }),
            leave: t("homing.leave"),
            again: t("homing.again"),
            here: t("homing.here"),
            zero: t("homing.zero"),
        });
        void this.#insertChecked(text);
    }

    /** Only what the parser takes goes into the program. */
    async #insertChecked(text: string): Promise<void> {
        try {
            const error = (await checkProgram(text)).problems.find(({ severity }) => severity === "error");
            this.#say("homing-words", error ? told(error.message) : t("homing.done"));
            if (error === undefined) {
                this.#around.insert(text);
            }
        } catch (error) {
            this.#say("homing-words", error instanceof Refused ? error.message : t("verdict.unknown"));
        }
    }

    async #weigh(): Promise<void> {
        try {
            const steps = this.#number("trial");
            this.#ramp = steps > 0 ? ((await computeRamp(this.#settings, steps)) ?? this.#ramp) : null;
        } catch (error) {
            this.#ramp = error instanceof NotPossible ? error : null;
        }
        this.#showRamp();
        this.#show();
    }

    #showRamp(): void {
        const ramp = this.#ramp;
        if (ramp === null || ramp instanceof NotPossible) {
            this.#say("ramp-words", ramp === null ? t("ramp.unknown") : ramp.message);
            return;
        }
        const { start, speed } = this.#settings;
        const words = {
            start, speed: numberText(ramp.peak), seconds: secondsText(ramp.seconds), steps: numberText(ramp.steps),
            trial: numberText(this.#number("trial")), whole: secondsText(ramp.whole_seconds ?? 0),
        };
        const parts = [t(ramp.peak >= Number(speed) ? "ramp.reached" : "ramp.lower", words)];
        parts.push(t(ramp.whole_seconds === null ? "ramp.long" : "ramp.whole", words), ramp.remark);
        this.#say("ramp-words", parts.filter((part) => part !== "").join(" "));
    }

    #translate(): void {
        for (const motor of MOTORS) {
            byId(`commission-motor-${motor}`, HTMLOptionElement).textContent = t("motor.one", { motor });
        }
        this.#say("teach-words", "");
        this.#say("homing-words", "");
        this.#showRamp();
        this.#weighSoon();
        this.#show();
    }
}

const secondsText = (seconds: number): string => numberText(seconds, 3);

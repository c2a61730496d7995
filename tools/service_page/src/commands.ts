import { byId, make } from "./dom";
import { language, t } from "./i18n";
import type { Link } from "./link";
import { ALL_MOTORS, MOTORS, type MessageName, type RequestParts } from "./protocol";
import { Cell } from "./signal";

const MESSAGES: MessageName[] = ["version", "send", "store", "position", "program", "table", "progress"];
const TO_ALL_UNITS: MessageName[] = ["send", "store"];
const RESET_ASKS_MS = 4000;
/** A second press sooner than this belongs to the first, as in a double click. */
const RESET_SETTLES_MS = 400;

export interface ShownProgram {
    motor: number;
    text: string;
}

/** Has texts sent to motors by `send`, or says why it does not. */
export type Guard = (programs: [motor: number, text: string][], send: () => void) => void;

/** What goes to the unit when the user says so: messages, resume, reset and speed. STOP is in stop.ts. */
export class Commands {
    readonly motor = new Cell<number>(MOTORS[0]);
    readonly #link: Link;
    readonly #program: () => ShownProgram;
    readonly #guard: Guard;
    readonly #message = byId("message", HTMLSelectElement);
    readonly #units = byId("units", HTMLSelectElement);
    readonly #send = byId("send", HTMLButtonElement);
    readonly #reset = byId("reset", HTMLButtonElement);
    readonly #progress = byId("progress", HTMLProgressElement);
    #asksReset = 0;
    #asked_ms = 0;
    /** Number of the request whose progress is shown. */
    #asked: number | null = null;

    /** `guard` sees programs and speeds before they are sent. */
    constructor(link: Link, program: () => ShownProgram, guard: Guard) {
        this.#link = link;
        this.#program = program;
        this.#guard = guard;
        this.#addMotors();
        this.#listen();
        link.on("progress", ({ id, from, value }) => this.#showProgress(id, from, value));
        link.on("answer", ({ id, from }) => {
            if (id === this.#asked && this.#isMine(from)) {
                this.#endProgress();
            }
        });
        link.isOpen.onChange(() => {
            this.#endProgress();
            this.forgetReset();
            this.#forgetUnits();
        });
        language.watch(() => this.#translate());
        this.motor.onChange(() => this.describe());
    }

    /** Words of the button: what is going to be sent, and where to. */
    describe(): void {
        const motor = this.motor.value;
        for (const radio of document.querySelectorAll<HTMLInputElement>("input[name=motor]")) {
            radio.checked = Number(radio.value) === motor;
        }
        const words = { program: this.#program().motor, motor };
        const message = this.#message.value as MessageName;
        const send = t(motor === ALL_MOTORS ? "send.toAll" : "send.toOne", words);
        const about = message === "send" ? send : t(`about.${message}`);
        const isPossible = !this.#isEverywhere || TO_ALL_UNITS.includes(message);
        const units = t(isPossible ? "units.sends" : "units.asks");
        byId("send-hint", HTMLElement).textContent = this.#isEverywhere ? units : about;
        this.#send.textContent = t(this.#isEverywhere ? "units.submit" : "message.submit");
        this.#send.classList.toggle("danger", this.#isEverywhere);
        this.#send.disabled = !isPossible;
    }

    /** Asks the unit for something; its progress is shown. */
    request(message: MessageName, motor: number, parts: RequestParts = {}): void {
        const id = this.#link.nextId();
        this.#asked = id;
        this.#link.send({ type: "request", id, message, motor, ...parts });
    }

    /** Asks the unit to take programs, by motor, if the machine allows them. */
    sendPrograms(programs: [motor: number, text: string][], message: MessageName, motor: number, parts: RequestParts): void {
        this.#guard(programs, () => this.request(message, motor, parts));
    }

    /** Whether the next message goes to all units of the line. */
    get #isEverywhere(): boolean {
        return this.#units.value !== "";
    }

    /** All units are meant once only: what follows goes to one again. */
    #forgetUnits(): void {
        this.#units.value = "";
        this.describe();
    }

    #listen(): void {
        const click = (id: string, action: () => void): void =>
            byId(id, HTMLButtonElement).addEventListener("click", action);
        click("resume", () => this.#link.send({ type: "resume", id: this.#link.nextId() }));
        click("reset", () => this.#askReset());
        byId("speed-form", HTMLFormElement).addEventListener("submit", (event) => {
            event.preventDefault();
            const value = byId("speed", HTMLInputElement).valueAsNumber;
            const motor = this.motor.value;
            const send = (): void => void this.#link.send({ type: "speed", id: this.#link.nextId(), motor, value });
            this.#guard(motorsOf(motor).map((each) => [each, `V${value}`]), send);
        });
        byId("message-form", HTMLFormElement).addEventListener("submit", (event) => {
            event.preventDefault();
            this.#submit();
        });
        this.#message.addEventListener("change", () => this.describe());
        this.#units.addEventListener("change", () => this.describe());
    }

    #submit(): void {
        const message = this.#message.value as MessageName;
        const everywhere = this.#isEverywhere ? { everywhere: true } : {};
        const motor = this.motor.value;
        if (message === "send") {
            const { text } = this.#program();
            this.sendPrograms(motorsOf(motor).map((each) => [each, text]), message, motor, { text, ...everywhere });
        } else {
            this.request(message, motor, everywhere);
        }
        this.#forgetUnits();
    }

    /** The first press asks, the second one within a few seconds resets. */
    #askReset(): void {
        if (this.#asksReset !== 0) {
            if (performance.now() - this.#asked_ms > RESET_SETTLES_MS) {
                this.forgetReset();
                this.#link.send({ type: "reset", id: this.#link.nextId() });
            }
            return;
        }
        this.#asked_ms = performance.now();
        this.#reset.textContent = t("reset.sure");
        this.#reset.classList.add("danger");
        this.#asksReset = window.setTimeout(() => this.forgetReset(), RESET_ASKS_MS);
    }

    /** A reset that was asked for and not confirmed is not meant any more. */
    forgetReset(): void {
        window.clearTimeout(this.#asksReset);
        this.#asksReset = 0;
        this.#reset.textContent = t("reset.name");
        this.#reset.classList.remove("danger");
    }

    #isMine(from: number | null | undefined): boolean {
        return from === undefined || from === this.#link.client;
    }

    #showProgress(id: number, from: number | null | undefined, value: number): void {
        if (id === this.#asked && this.#isMine(from)) {
            this.#progress.hidden = false;
            this.#progress.value = value;
        }
    }

    #endProgress(): void {
        this.#asked = null;
        this.#progress.hidden = true;
    }

    #addMotors(): void {
        const host = byId("motors", HTMLElement);
        for (const motor of [ALL_MOTORS, ...MOTORS]) {
            const radio = make("input", { type: "radio", name: "motor", value: String(motor) });
            radio.addEventListener("change", () => this.motor.set(motor));
            host.append(make("label", {}, radio, make("span", { id: `motor-name-${motor}` }, String(motor))));
        }
    }

    #translate(): void {
        const chosen = this.#message.value || "send";
        this.#message.replaceChildren(
            ...MESSAGES.map((name) => {
                const words = `${t(`message.${name}`)} – ${t(`about.${name}`)}`;
                return make("option", { value: name }, words);
            }),
        );
        this.#message.value = chosen;
        byId("motor-name-0", HTMLElement).textContent = t("motor.allShort");
        this.forgetReset();
        this.describe();
    }
}

const motorsOf = (motor: number): number[] => (motor === ALL_MOTORS ? [...MOTORS] : [motor]);

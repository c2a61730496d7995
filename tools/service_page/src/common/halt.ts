import { byId } from "../dom";
import { language } from "../language";
import type { Left } from "../left";
import { listenForStop } from "../stop_press";
import { keep, recall } from "../storage";
import type { Answer, CommonState, Known } from "./known";
import { told } from "./told";
import type { CommonKey, CommonWords } from "./words";

const DONE_MS = 4000;

/** What of it differs from unit to unit. */
export interface HaltOptions {
    /** Whether something moves, of which it is not said any more that it stands. */
    moves: () => boolean;
    /** The axis that alone was to be held, where that can be; empty: all were to be stopped. */
    part?: () => string;
    /** Under which the browser keeps the units of which none is confirmed: a service that is started anew knows nothing of it. */
    name?: string;
}

/**
 * The stop: its button, the Escape key, and the line that says that it is not confirmed. That stays until one is
 * confirmed, also when port or service are lost. None is, as long as a unit that moved is out of reach.
 */
export class Halt {
    readonly #unit: Known;
    readonly #t: CommonWords;
    readonly #left: Left;
    readonly #options: HaltOptions;
    readonly #kept: Set<string>;
    /** The unit that is connected, or was when the service was there; null: there is none, or nothing is kept of it. */
    #place: string | null = null;
    #isNew = true;
    readonly #alarm = byId("alarm", HTMLElement);
    /** Whether a halt of this page has no good answer yet; "asked": it may still come. */
    #own: "asked" | "failed" | null = null;
    #done = "";
    #isDoneOfPart = false;
    #forget = 0;

    constructor(unit: Known, t: CommonWords, left: Left, options: HaltOptions) {
        this.#options = options;
        this.#kept = new Set(options.name === undefined ? [] : recall<string[]>(options.name, []));
        this.#unit = unit;
        this.#t = t;
        this.#left = left;
        left.onChange(() => this.#show());
        listenForStop(byId("stop", HTMLButtonElement), () => this.#press());
        unit.link.on("answer", (answer: Answer) => this.#hear(answer));
        unit.link.isOpen.onChange((isOpen) => {
            if (!isOpen && (this.#own === "asked" || this.#last !== null)) {
                this.#own = "failed";
            }
            this.#show();
        });
        unit.watch(() => {
            const state = unit.state.value;
            this.#last = state === null ? this.#last : state.halt;
            this.#recall(state);
            this.#done = options.moves() ? "" : this.#done;
            this.#show();
        });
        language.onChange(() => this.#show());
    }

    /** What the service has said of the last halt. */
    #last: "asked" | "failed" | null = null;

    #recall(state: CommonState | null): void {
        if (state !== null && this.#options.name !== undefined) {
            const place = state.port === null || state.virtual ? null : `${state.node} ${state.port}`;
            const isOther = this.#isNew || place !== this.#place;
            this.#place = place;
            if (isOther && place !== null && state.halt === null && this.#kept.has(place)) {
                this.#own ??= "failed";
            }
        }
        this.#isNew = state === null;
    }

    #keep(isFailed: boolean): void {
        const { name } = this.#options;
        if (name !== undefined && this.#place !== null && this.#kept.has(this.#place) !== isFailed) {
            this.#kept[isFailed ? "add" : "delete"](this.#place);
            keep(name, [...this.#kept]);
        }
    }

    #press(): void {
        this.#own = "asked";
        this.#done = "";
        this.#own = this.#unit.ask("halt") ? "asked" : "failed";
        this.#show();
    }

    #hear({ message, from, text, error }: Answer): void {
        const isPart = message === "hold";
        if (message !== "halt" && !isPart) {
            return;
        }
        if (error === null && this.#left.names === "") {
            this.#own = isPart ? this.#own : null;
            this.#isDoneOfPart = isPart;
            this.#done = text;
            window.clearTimeout(this.#forget);
            this.#forget = window.setTimeout(() => {
                this.#done = "";
                this.#show();
            }, DONE_MS);
        } else if (!isPart && (error === null || from === this.#unit.link.client)) {
            this.#own = "failed";
        }
        this.#show();
    }

    #show(): void {
        const open = this.#own === "asked" || this.#last === "asked" ? "asked" : this.#own ?? this.#last;
        const left = this.#left.names;
        const kind = open ?? (this.#done === "" || left !== "" ? "none" : "done");
        const names = kind === "failed" && left !== "" ? ` (${left})` : "";
        if (open !== "asked") {
            this.#keep(open === "failed");
        }
        const axis = this.#options.part?.() ?? "";
        const isPart = kind === "done" ? this.#isDoneOfPart : this.#own === null && axis !== "";
        const key = `${isPart ? "hold" : "halt"}.${kind}` as CommonKey;
        const words = kind === "none" ? "" : this.#t(key, { words: told(this.#done), axis }) + names;
        this.#alarm.dataset.kind = kind;
        this.#alarm.hidden = kind === "none";
        if (this.#alarm.textContent !== words) {
            this.#alarm.textContent = words;
        }
    }
}

import { byId } from "../dom";
import { language } from "../language";
import type { Left } from "../left";
import { listenForStop } from "../stop_press";
import type { Answer, Known } from "./known";
import { told } from "./told";
import type { CommonKey, CommonWords } from "./words";

const DONE_MS = 4000;

/**
 * The stop: its button, the Escape key, and the line that says that it is not confirmed. That stays until one is
 * confirmed, also when port or service are lost. None is, as long as a unit that moved is out of reach.
 */
export class Halt {
    readonly #unit: Known;
    readonly #t: CommonWords;
    readonly #left: Left;
    readonly #part: () => string;
    readonly #alarm = byId("alarm", HTMLElement);
    /** Whether a halt of this page has no good answer yet; "asked": it may still come. */
    #own: "asked" | "failed" | null = null;
    #done = "";
    #isDoneOfPart = false;
    #forget = 0;

    /**
     * `moves`: whether something moves, of which it is not said any more that it stands. `part`: the axis that alone was to be
     * held, where that can be; empty: all were to be stopped.
     */
    constructor(unit: Known, t: CommonWords, left: Left, moves: () => boolean, part = () => "") {
        this.#part = part;
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
            this.#done = moves() ? "" : this.#done;
            this.#show();
        });
        language.onChange(() => this.#show());
    }

    /** What the service has said of the last halt. */
    #last: "asked" | "failed" | null = null;

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
        const axis = this.#part();
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

import { byId } from "../dom";
import { listenForStop } from "../stop_press";
import { language, t } from "./i18n";
import type { Answer } from "./protocol";
import type { Unit } from "./unit";

const DONE_MS = 4000;

/**
 * HALT: the button, the Escape key, and the line that says that it is not confirmed. That stays until one is
 * confirmed, also when port or service are lost.
 */
export class Halt {
    readonly #unit: Unit;
    readonly #alarm = byId("alarm", HTMLElement);
    /** Whether a halt of this page has no good answer yet; "asked": it may still come. */
    #own: "asked" | "failed" | null = null;
    #done = "";
    #forget = 0;

    constructor(unit: Unit) {
        this.#unit = unit;
        listenForStop(byId("stop", HTMLButtonElement), () => this.#press());
        unit.link.on("answer", (answer) => this.#hear(answer));
        unit.link.isOpen.onChange((isOpen) => {
            if (!isOpen && (this.#own === "asked" || this.#last !== null)) {
                this.#own = "failed";
            }
            this.#show();
        });
        unit.state.onChange((state) => {
            this.#last = state === null ? this.#last : state.halt;
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
        if (message !== "halt") {
            return;
        }
        if (error === null) {
            this.#own = null;
            this.#done = text;
            window.clearTimeout(this.#forget);
            this.#forget = window.setTimeout(() => {
                this.#done = "";
                this.#show();
            }, DONE_MS);
        } else if (from === this.#unit.link.client) {
            this.#own = "failed";
        }
        this.#show();
    }

    #show(): void {
        const open = this.#own === "asked" || this.#last === "asked" ? "asked" : this.#own ?? this.#last;
        const kind = open ?? (this.#done === "" ? "none" : "done");
        const words = kind === "none" ? "" : t(`halt.${kind}`, { words: this.#done });
        this.#alarm.dataset.kind = kind;
        this.#alarm.hidden = kind === "none";
        if (this.#alarm.textContent !== words) {
            this.#alarm.textContent = words;
        }
    }
}

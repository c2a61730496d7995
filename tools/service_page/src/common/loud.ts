import { byId, make } from "../dom";
import { language } from "../language";
import type { Known } from "./known";
import type { CommonWords } from "./words";

/** After so long without a word from the unit it is said in large letters. */
const SILENT_MS = 2000;
const LOOK_MS = 250;

/** What of it differs from unit to unit; a text is a headline and, after a line feed, what else is to be said. */
export interface LoudOptions {
    /** Whether the unit moved when it was last seen, or may have begun to. */
    didMove: () => boolean;
    /** Whether it is known what the unit does. */
    isTold: () => boolean;
    restarted: () => string;
    /** What else must not be overlooked; empty: nothing. */
    more: () => string;
}

/** What must not be overlooked: a unit that is silent, has restarted, or may not move. */
export class Loud {
    readonly #unit: Known;
    readonly #t: CommonWords;
    readonly #options: LoudOptions;
    readonly #box = byId("loud", HTMLElement);
    readonly #seen = byId("seen", HTMLButtonElement);
    #fresh_ms = performance.now();
    #shown = "";

    constructor(unit: Known, t: CommonWords, options: LoudOptions) {
        this.#unit = unit;
        this.#t = t;
        this.#options = options;
        this.#seen.addEventListener("click", () => unit.ask("seen"));
        unit.watch(() => this.#show());
        language.onChange(() => this.#show());
        window.setInterval(() => this.#show(), LOOK_MS);
    }

    #show(): void {
        const words = this.#find();
        this.#seen.hidden = this.#unit.state.value?.restarted !== true;
        if (words === this.#shown) {
            return;
        }
        this.#shown = words;
        this.#box.hidden = words === "";
        const [head = "", rest = ""] = words.split("\n");
        this.#box.querySelector("span")?.replaceChildren(head, ...(rest === "" ? [] : [make("small", {}, rest)]));
    }

    #find(): string {
        const state = this.#unit.state.value;
        const isTold = this.#options.isTold() || state?.busy === "connect" || state === null;
        if (isTold || !(state.connected || state.away)) {
            this.#fresh_ms = performance.now();
        }
        if (state?.restarted) {
            return `${this.#t("loud.restarted")}\n${this.#options.restarted()}`;
        }
        const didMove = this.#options.didMove();
        const moving = didMove ? `\n${this.#t("loud.moving")}` : "";
        if (state?.error && !state.connected && (state.away || didMove)) {
            return this.#t("loud.lost") + moving;
        }
        const isCut = didMove && !this.#unit.link.isOpen.value;
        if (isCut || (state?.connected && (performance.now() - this.#fresh_ms > SILENT_MS || state.error !== null))) {
            return this.#t("loud.silent") + moving;
        }
        return this.#options.more();
    }
}

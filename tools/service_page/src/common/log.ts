import { byId, make } from "../dom";
import { language } from "../language";
import type { Trouble } from "../protocol";
import type { Answer, Known } from "./known";
import { told, troubleText } from "./told";
import type { CommonWords } from "./words";

const KEPT_MAX = 200;

interface Entry {
    at: Date;
    message: string;
    words: () => string;
    isBad: boolean;
}

/** All answers, the youngest on top; `titleOf` names what was asked for. */
export class Log {
    readonly #list = byId("log", HTMLElement);
    readonly #t: CommonWords;
    readonly #titleOf: (message: string) => string;
    #entries: Entry[] = [];

    constructor(unit: Known, t: CommonWords, titleOf: (message: string) => string) {
        this.#t = t;
        this.#titleOf = titleOf;
        unit.link.on("answer", (answer: Answer) => this.#add(answer));
        unit.link.on("error", ({ error }: { error: Trouble }) => this.say("error", error));
        unit.link.onRefused(({ type }) => type !== "ports" && this.say(type, { cause: t("state.notSent"), next: "" }));
        byId("log-clear", HTMLButtonElement).addEventListener("click", () => {
            this.#entries = [];
            this.#showAll();
        });
        language.watch(() => this.#showAll());
    }

    /** Something that the page itself has to say, beside the answers. */
    say(message: string, trouble: Trouble): void {
        this.#add({ id: null, from: null, message, text: null, error: trouble });
    }

    #add({ message, text, error }: Answer): void {
        const entry = { at: new Date(), message, words: () => (error === null ? told(text) : troubleText(error)), isBad: error !== null };
        this.#entries.unshift(entry);
        this.#entries.length = Math.min(this.#entries.length, KEPT_MAX);
        this.#showAll();
        byId("spoken", HTMLElement).textContent = `${this.#titleOf(message)}: ${entry.words()}`;
    }

    #showAll(): void {
        const empty = make("li", { class: "log-empty" }, this.#t("log.empty"));
        const shown = this.#entries.map(({ at, message, words, isBad }) => {
            const time = make("time", {}, at.toLocaleTimeString(language.value, { hour12: false }));
            const head = make("div", { class: "log-head" }, time, make("b", {}, this.#titleOf(message)));
            const item = make("li", { class: "log-item", "data-message": message }, head, make("div", { class: "log-words" }, words()));
            item.classList.toggle("is-bad", isBad);
            return item;
        });
        this.#list.replaceChildren(...(shown.length > 0 ? shown : [empty]));
    }
}

import { byId, make } from "../dom";
import { isKey, language, t, troubleText } from "./i18n";
import type { Answer, Trouble } from "./protocol";
import type { Unit } from "./unit";

const KEPT_MAX = 200;

interface Entry {
    at: Date;
    message: string;
    words: string;
    isBad: boolean;
}

/** The console: commands as they are typed, and all answers, the youngest on top. */
export class Log {
    readonly #list = byId("log", HTMLElement);
    #entries: Entry[] = [];

    constructor(unit: Unit) {
        unit.link.on("answer", (answer) => this.#add(answer));
        unit.link.on("error", ({ error }) => this.say("error", error));
        unit.link.onRefused(({ type }) => type !== "ports" && this.say(type, { cause: t("state.notSent"), next: "" }));
        byId("log-clear", HTMLButtonElement).addEventListener("click", () => {
            this.#entries = [];
            this.#showAll();
        });
        const typed = byId("typed", HTMLInputElement);
        byId("console", HTMLFormElement).addEventListener("submit", (event) => {
            event.preventDefault();
            if (unit.link.send({ type: "typed", id: unit.link.nextId(), text: typed.value })) {
                typed.value = "";
            }
        });
        language.watch(() => this.#showAll());
    }

    /** Something that the page itself has to say, beside the answers. */
    say(message: string, trouble: Trouble): void {
        this.#add({ id: null, from: null, message, text: null, error: trouble });
    }

    #add({ message, text, error }: Answer): void {
        const entry = { at: new Date(), message, words: error === null ? text : troubleText(error), isBad: error !== null };
        this.#entries.unshift(entry);
        this.#entries.length = Math.min(this.#entries.length, KEPT_MAX);
        this.#showAll();
        byId("spoken", HTMLElement).textContent = `${title(message)}: ${entry.words}`;
    }

    #showAll(): void {
        const empty = make("li", { class: "log-empty" }, t("log.empty"));
        const shown = this.#entries.map(({ at, message, words, isBad }) => {
            const time = make("time", {}, at.toLocaleTimeString(language.value, { hour12: false }));
            const head = make("div", { class: "log-head" }, time, make("b", {}, title(message)));
            const item = make("li", { class: "log-item", "data-message": message }, head, make("div", { class: "log-words" }, words));
            item.classList.toggle("is-bad", isBad);
            return item;
        });
        this.#list.replaceChildren(...(shown.length > 0 ? shown : [empty]));
    }
}

function title(message: string): string {
    const key = `message.${message}`;
    return isKey(key) ? t(key) : message;
}

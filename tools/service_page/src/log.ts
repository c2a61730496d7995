import { answerWords } from "./answer_words";
import { byId, make } from "./dom";
import { isKey, language, t } from "./i18n";
import type { Link } from "./link";
import type { Answer, Trouble } from "./protocol";

const KEPT_MAX = 200;

/** Characters that are shown of words and of bytes before the rest has to be asked for. */
const WORDS_MAX = 400;
const BYTES_MAX = 300;
const FOLDED = 90;

function foldedIfLong(text: string, longest: number): HTMLElement | string {
    return text.length <= longest
        ? text
        : make("details", {}, make("summary", {}, `${text.slice(0, FOLDED)} …`), text);
}

interface Entry {
    at: Date;
    answer: Answer;
}

/** All answers of the unit, the youngest on top: in words, and as the bytes that were on the line. */
export class Log {
    readonly #list = byId("log", HTMLElement);
    readonly #spoken = byId("spoken", HTMLElement);
    readonly #toEditor: (motor: number, text: string) => void;
    #entries: Entry[] = [];

    constructor(link: Link, toEditor: (motor: number, text: string) => void) {
        this.#toEditor = toEditor;
        link.on("answer", (answer) => this.#add(answer));
        link.on("error", ({ error }) => this.say("error", error));
        const bytes = byId("log-bytes", HTMLInputElement);
        bytes.addEventListener("change", () => (this.#list.dataset.bytes = String(bytes.checked)));
        byId("log-clear", HTMLButtonElement).addEventListener("click", () => {
            this.#entries = [];
            this.#showAll();
        });
        language.watch(() => this.#showAll());
    }

    /** Something that the page itself has to say, beside the answers. */
    say(message: string, trouble: Trouble): void {
        const bytes = { request_bytes: null, answer_bytes: null };
        this.#add({ id: null, message, node: 0, motor: null, ...bytes, text: null, error: trouble });
    }

    #add(answer: Answer): void {
        const entry = { at: new Date(), answer };
        this.#entries.unshift(entry);
        this.#entries.length = Math.min(this.#entries.length, KEPT_MAX);
        this.#list.querySelector(".log-empty")?.remove();
        this.#list.prepend(this.#show(entry));
        while (this.#list.childElementCount > KEPT_MAX) {
            this.#list.lastElementChild?.remove();
        }
        this.#spoken.textContent = `${this.#title(answer)}: ${answerWords(answer)}`;
    }

    #showAll(): void {
        const empty = make("li", { class: "log-empty" }, t("log.empty"));
        const shown = this.#entries.map((entry) => this.#show(entry));
        this.#list.replaceChildren(...(shown.length > 0 ? shown : [empty]));
    }

    #title(answer: Answer): string {
        const key = `message.${answer.message}`;
        return isKey(key) ? t(key) : answer.message;
    }

    #show({ at, answer }: Entry): HTMLElement {
        const time = make("time", {}, at.toLocaleTimeString(language.value, { hour12: false }));
        const title = make("b", {}, this.#title(answer));
        const head = make("div", { class: "log-head" }, time, title);
        if (answer.motor !== null && answer.message !== "scan") {
            head.append(make("span", { class: "log-who" }, this.#who(answer)));
        }
        const words = make("div", { class: "log-words" }, foldedIfLong(answerWords(answer), WORDS_MAX));
        const item = make("li", { class: "log-item", "data-message": answer.message }, head, words);
        item.classList.toggle("is-bad", answer.error !== null);
        if (answer.message === "program" && answer.text && answer.motor) {
            head.append(this.#editorButton(answer.motor, answer.text));
        }
        this.#addBytes(item, answer);
        return item;
    }

    #who(answer: Answer): string {
        const node = answer.node === 0 ? t("units.everyone") : t("log.node", { node: answer.node });
        const motor = answer.motor === 0 ? t("motor.all") : t("motor.one", { motor: answer.motor ?? 0 });
        return `${node} · ${motor}`;
    }

    #addBytes(item: HTMLElement, answer: Answer): void {
        const rows = [
            ["→", "log.request", answer.request_message, answer.request_bytes],
            ["←", "log.answer", answer.answer_message, answer.answer_bytes],
        ] as const;
        for (const [arrow, label, message, frame] of rows) {
            if (message || frame) {
                const name = make("i", { title: t(label), "aria-label": t(label), role: "img" }, arrow);
                const framed = frame ? [this.#code("log.frame", frame)] : [];
                const parts = [this.#code("log.message", message ?? ""), ...framed];
                item.append(make("div", { class: "log-bytes" }, name, ...parts));
            }
        }
    }

    #code(name: "log.message" | "log.frame", bytes: string): HTMLElement {
        const code = make("code", {}, foldedIfLong(bytes, BYTES_MAX));
        return make("span", { class: name.replace(".", "-") }, make("small", {}, t(name)), code);
    }

    #editorButton(motor: number, text: string): HTMLElement {
        const button = make("button", { type: "button", class: "link" }, t("log.toEditor"));
        button.addEventListener("click", () => this.#toEditor(motor, text));
        return button;
    }
}

import { byId, make } from "./dom";
import { language, t, type Key } from "./i18n";
import type { Link } from "./link";
import { Memories, type Found } from "./memories";
import { foundWords } from "./memory_words";

const AGREES: readonly string[] = ["same", "none"];

/**
 * Stores what the motors hold, all at once. It is read before: where it is not what is shown here, or not known,
 * the user has to confirm.
 */
export class StoreAll {
    readonly #memories: Memories;
    readonly #texts: () => Record<string, string>;
    readonly #store: () => void;
    readonly #box = byId("store-ask", HTMLElement);
    readonly #confirm = byId("store-confirm", HTMLInputElement);
    #phase: "rests" | "reads" | "asks" = "rests";
    #words: Key | null = null;

    constructor(link: Link, texts: () => Record<string, string>, store: () => void) {
        this.#memories = new Memories(link);
        this.#texts = texts;
        this.#store = store;
        const click = (id: string, act: () => void): void => byId(id, HTMLButtonElement).addEventListener("click", act);
        click("store-all", () => this.#phase !== "reads" && this.#ask());
        click("store-anyway", () => this.#confirm.checked && this.#end(null, store));
        click("store-not", () => this.#end("store.nothing"));
        this.#confirm.addEventListener("change", () => this.#allow());
        this.#memories.found.onChange(() => this.#see());
        language.watch(() => this.#show());
    }

    /** What is shown here has changed. */
    forget(): void {
        this.#memories.forget();
    }

    #ask(): void {
        this.#phase = "reads";
        this.#words = "store.reads";
        this.#confirm.checked = false;
        this.#memories.ask(this.#texts());
    }

    #see(): void {
        const found = [...this.#memories.found.value.values()];
        if (this.#phase === "rests") {
            return;
        }
        if (found.length === 0) {
            this.#end("store.changed");
        } else if (this.#phase === "reads" && found.every((each) => each !== null)) {
            this.#judge(found);
        }
        this.#show();
    }

    #judge(found: Found[]): void {
        if (found.every(({ kind }) => AGREES.includes(kind))) {
            this.#end(null, this.#store);
        } else {
            this.#phase = "asks";
            this.#words = null;
        }
    }

    #end(words: Key | null, act: () => void = () => undefined): void {
        this.#phase = "rests";
        this.#words = words;
        this.#memories.forget();
        this.#show();
        act();
    }

    #allow(): void {
        byId("store-anyway", HTMLButtonElement).disabled = !this.#confirm.checked;
    }

    #show(): void {
        const isAsking = this.#phase === "asks";
        const others = [...this.#memories.found.value].filter(([, each]) => each !== null && !AGREES.includes(each.kind));
        const items = isAsking ? others.map(([motor, each]) => make("li", {}, foundWords(motor, each))) : [];
        byId("store-others", HTMLElement).replaceChildren(...items);
        this.#allow();
        byId("store-words", HTMLElement).textContent = this.#words === null ? "" : t(this.#words);
        this.#box.hidden = !isAsking;
    }
}

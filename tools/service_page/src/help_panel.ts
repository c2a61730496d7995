import { commands, pages } from "help-pages";
import { fetchExamples } from "./api";
import { byId, debounced, make } from "./dom";
import { meaningOf, syntaxOf } from "./help";
import { language, numberText, t } from "./i18n";
import type { Example } from "./protocol";

const TYPING_MS = 100;

/** Words without accents and capitals. */
const plain = (text: string): string => text.normalize("NFD").replace(/\p{M}/gu, "").toLowerCase();

/** The project's documents, its commands and examples, to be searched and tried. */
export class HelpPanel {
    readonly #try: (example: Example) => void;
    readonly #panel = byId("help", HTMLDetailsElement);
    readonly #search = byId("help-search", HTMLInputElement);
    readonly #list = byId("help-list", HTMLElement);
    readonly #none = byId("help-none", HTMLElement);
    readonly #places = byId("help-places", HTMLElement);
    #examples: Example[] = [];

    /** `take` puts an example into the editor, which simulates it. */
    constructor(take: (example: Example) => void) {
        this.#try = take;
        this.#panel.addEventListener("toggle", () => this.#panel.open && void this.#fill());
        this.#search.addEventListener("input", debounced(TYPING_MS, () => this.#filter()));
        this.#list.addEventListener("click", (event) => this.#follow(event));
        byId("help-open", HTMLButtonElement).addEventListener("click", () => this.#open());
        language.onChange(() => this.#panel.open && this.#write());
    }

    #open(): void {
        this.#panel.open = true;
        this.#panel.scrollIntoView({ block: "start" });
        this.#search.focus();
    }

    async #fill(): Promise<void> {
        if (this.#list.childElementCount === 0) {
            this.#examples = await fetchExamples().catch(() => []);
            this.#write();
        }
    }

    #write(): void {
        const shown = pages.map(({ id, texts }) => {
            const text = texts[language.value];
            return text ? { id, lang: language.value, ...text } : { id, lang: "en", ...texts.en };
        });
        const documents = shown.map(({ id, lang, sections }) => {
            const parts = sections.map((html) => {
                const part = make("section", { class: "help-section" });
                part.innerHTML = html;
                part.querySelectorAll(".program").forEach((program) => this.#addTry(program));
                return part;
            });
            return make("div", { class: "help-page", lang, "data-page": id }, ...parts);
        });
        this.#list.replaceChildren(this.#commands(), this.#exampleList(), ...documents);
        this.#places.replaceChildren(
            ...[["help-commands", t("help.commands")], ["help-examples", t("help.examples")]].map(([id, title]) =>
                make("a", { href: `#${id}` }, title ?? ""),
            ),
            ...shown.map(({ id, lang, title }) => make("a", { href: `#${id}`, lang }, title)),
        );
        this.#filter();
    }

    #commands(): HTMLElement {
        const rows = commands.map((row) => {
            const { form, min, max } = row;
            const hasRange = form === "NUMBER" || form === "IO" || form === "SIGNED";
            const range = !hasRange ? "" : min === max ? `${min}` : `${numberText(min)}–${numberText(max)}`;
            const code = make("code", {}, syntaxOf(row));
            return make("tr", { class: "help-section" }, make("th", { scope: "row" }, code), make("td", {}, range),
                make("td", {}, meaningOf(row)));
        });
        const heads = ["help.command", "help.range", "help.meaning"] as const;
        const head = make("tr", {}, ...heads.map((key) => make("th", { scope: "col" }, t(key))));
        const table = make("table", {}, make("thead", {}, head), make("tbody", {}, ...rows));
        return make("div", { class: "help-page" }, make("h3", { id: "help-commands" }, t("help.commands")), table);
    }

    #exampleList(): HTMLElement {
        const parts = this.#examples.map((example) => {
            const program = make("div", { class: "program" }, make("pre", {}, make("code", {}, example.text)));
            this.#addTry(program, example);
            return make("section", { class: "help-section" }, make("h4", {}, example.name), program);
        });
        const title = make("h3", { id: "help-examples" }, t("help.examples"));
        return make("div", { class: "help-page" }, title, ...parts);
    }

    #addTry(program: Element, example?: Example): void {
        const text = program.querySelector("code")?.textContent ?? "";
        const button = make("button", { type: "button", lang: language.value }, t("help.try"));
        button.addEventListener("click", () => this.#try(example ?? { name: t("help.name"), text: `${text}\n` }));
        program.append(button);
    }

    /** Shows the sections that have all the words. */
    #filter(): void {
        const words = plain(this.#search.value).split(/\s+/).filter((word) => word !== "");
        let found = 0;
        for (const section of this.#list.querySelectorAll<HTMLElement>(".help-section")) {
            const text = plain(section.textContent ?? "");
            section.hidden = !words.every((word) => text.includes(word));
            found += section.hidden ? 0 : 1;
        }
        for (const page of this.#list.querySelectorAll<HTMLElement>(".help-page")) {
            page.hidden = page.querySelector(".help-section:not([hidden])") === null;
        }
        this.#none.textContent = found === 0 ? t("help.none") : words.length === 0 ? "" : t("help.found", { found });
    }

    /** A link leads to what a search may have hidden. */
    #follow(event: Event): void {
        const link = event.target instanceof Element ? event.target.closest("a[href^='#']") : null;
        if (link !== null && this.#search.value !== "") {
            this.#search.value = "";
            this.#filter();
        }
    }
}

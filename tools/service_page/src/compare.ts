import { byId, make } from "./dom";
import { language, t } from "./i18n";
import type { Link } from "./link";
import { differences, shownDifference } from "./machine_diff";
import type { MachineContent } from "./machine_file";
import { Memories } from "./memories";
import { foundWords } from "./memory_words";

/** What this part needs of the others. */
export interface Compared {
    /** Texts of the motors that have a program. */
    texts: () => Record<string, string>;
    /** All that is here, as it would be saved. */
    machine: () => MachineContent;
    /** A machine of a file; null: it is none, which was told. */
    read: (file: File) => Promise<MachineContent | null>;
}

/** Compares what is here with the memories of the unit, which are only read, or with another machine file. */
export class Compare {
    readonly #memories: Memories;
    readonly #parts: Compared;
    readonly #with = byId("compare-with", HTMLSelectElement);
    readonly #input = byId("compare-file", HTMLInputElement);
    readonly #list = byId("compared", HTMLElement);
    readonly #differences = byId("differences", HTMLElement);
    #file: { name: string; here: MachineContent; there: MachineContent } | null = null;

    constructor(link: Link, parts: Compared) {
        this.#memories = new Memories(link);
        this.#parts = parts;
        byId("machine-compare", HTMLButtonElement).addEventListener("click", () => this.#ask());
        this.#input.addEventListener("change", () => void this.#read());
        this.#memories.found.onChange(() => this.#show());
        language.onChange(() => this.#show());
    }

    /** What was found is not so any more. */
    forget(): void {
        this.#file = null;
        this.#memories.forget();
        this.#show();
    }

    #ask(): void {
        this.forget();
        if (this.#with.value === "file") {
            this.#input.click();
        } else {
            this.#memories.ask(this.#parts.texts());
        }
    }

    async #read(): Promise<void> {
        const file = this.#input.files?.[0];
        const there = file === undefined ? null : await this.#parts.read(file);
        this.#input.value = "";
        if (file !== undefined && there !== null) {
            this.forget();
            this.#file = { name: file.name, here: this.#parts.machine(), there };
            this.#show();
        }
    }

    #show(): void {
        const found = this.#file === null ? [] : differences(this.#file.here, this.#file.there);
        const unit = [...this.#memories.found.value].map(([motor, each]) => foundWords(motor, each));
        const words = this.#file === null ? unit : fileWords(this.#file.name, found.map(({ title }) => title));
        this.#list.replaceChildren(...words.map((each) => make("li", {}, each)));
        this.#list.hidden = words.length === 0;
        this.#differences.replaceChildren(...found.flatMap(shownDifference));
        this.#differences.hidden = found.length === 0;
    }
}

function fileWords(name: string, titles: string[]): string[] {
    const rest = titles.length === 0 ? [t("compare.sameFile", { name })] : [t("compare.rest"), t("compare.signs", { name })];
    return [...titles.map((title) => `${title}: ${t("compare.differs")}`), ...rest];
}

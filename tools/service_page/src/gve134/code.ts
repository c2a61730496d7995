import { asTold } from "../common/files";
import { byId, make } from "../dom";
import { fetchText } from "./api";
import { fileWords } from "./files";
import { isOpen } from "./job";
import { language, t } from "./i18n";
import type { FileText, Problem } from "./protocol";
import type { Unit } from "./unit";

const ROW_PX = 20;
/** A browser shows no element that is much higher; of longer files only the beginning. */
const ROWS_MAX = 500_000;
const MARGIN_ROWS = 8;
const LETTERS_MAX = 400;
const LINE_END = /\r\n|\n|\r/;

/** The lines of the file with their errors; only those in sight are elements. The one that is executed is marked. */
export class Code {
    readonly #unit: Unit;
    readonly #box = byId("code", HTMLElement);
    readonly #rows = byId("code-lines", HTMLElement);
    readonly #follow = byId("follow", HTMLInputElement);
    #number: number | null = null;
    /** What is wrong, as it is told outside. */
    #told: FileText | null = null;
    #lines: string[] = [];
    #problems = new Map<number, Problem>();
    #now: number | null = null;

    constructor(unit: Unit) {
        this.#unit = unit;
        this.#box.addEventListener("scroll", () => this.#draw());
        new ResizeObserver(() => this.#draw()).observe(this.#box);
        unit.watch(() => this.#show());
        language.onChange(() => {
            this.#showLine();
            void this.#showProblems();
        });
    }

    #show(): void {
        const { file = null, job = null } = this.#unit.state.value ?? {};
        if (file !== null && file.number !== this.#number) {
            this.#number = file.number;
            void this.#load(file.number);
        }
        const isOfFile = file !== null && isOpen(job) && job?.file === file.number;
        const line = isOfFile ? (this.#unit.now?.progress?.line ?? null) : null;
        if (line !== this.#now) {
            this.#now = line;
            this.#showLine();
        }
    }

    async #load(number: number): Promise<void> {
        const found = await fetchText(number).catch(() => null);
        if (found !== null && number === this.#number) {
            this.#lines = found.text.split(LINE_END).slice(0, ROWS_MAX);
            this.#told = found;
            this.#problems.clear();
            this.#rows.style.height = `${this.#lines.length * ROW_PX}px`;
            this.#box.scrollTop = 0;
            await this.#showProblems();
        }
    }

    async #showProblems(): Promise<void> {
        const [told, name] = [this.#told, language.value];
        const words = told === null || told.problems.length === 0 ? asTold : await fileWords();
        if (told === null || told !== this.#told || name !== language.value) {
            return;
        }
        const problems = told.problems.map((problem) => ({ ...problem, message: words(problem.message) }));
        this.#problems = new Map(problems.map((problem) => [problem.line, problem] as const).reverse());
        this.#listProblems(problems, told.more);
        this.#draw();
    }

    #listProblems(problems: readonly Problem[], more: number): void {
        const list = byId("problems", HTMLElement);
        const rows = problems.map(({ severity, line, column, message }) => {
            const button = make("button", { type: "button", "data-severity": severity }, `${line}:${column} ${message}`);
            button.addEventListener("click", () => this.#goTo(line));
            return make("li", {}, button);
        });
        list.replaceChildren(...rows, ...(more > 0 ? [make("li", {}, `… ${more}`)] : []));
        list.hidden = problems.length === 0;
    }

    #goTo(line: number): void {
        this.#box.scrollTop = (line - 1) * ROW_PX - this.#box.clientHeight / 2;
    }

    #showLine(): void {
        const line = this.#now;
        byId("code-line", HTMLElement).textContent = line === null ? "" : t("code.line", { line });
        if (line !== null && this.#follow.checked) {
            const top = (line - 1) * ROW_PX - this.#box.scrollTop;
            if (top < ROW_PX || top > this.#box.clientHeight - 3 * ROW_PX) {
                this.#goTo(line);
            }
        }
        this.#draw();
    }

    #draw(): void {
        const first = Math.max(0, Math.floor(this.#box.scrollTop / ROW_PX) - MARGIN_ROWS);
        const count = Math.ceil(this.#box.clientHeight / ROW_PX) + 2 * MARGIN_ROWS;
        const shown = this.#lines.slice(first, first + count).map((text, index) => this.#row(text, first + index + 1));
        this.#rows.replaceChildren(...shown);
    }

    #row(text: string, line: number): HTMLElement {
        const problem = this.#problems.get(line);
        const short = text.slice(0, LETTERS_MAX);
        const parts: (Node | string)[] = problem ? marked(short, problem) : [short];
        const row = make("div", { "data-now": String(line === this.#now) }, make("i", {}, String(line)), ...parts);
        row.style.top = `${(line - 1) * ROW_PX}px`;
        return row;
    }
}

/** The word of a line where a problem is. */
function marked(text: string, { column, severity, message }: Problem): (Node | string)[] {
    const letters = [...text];
    const begin = Math.min(column - 1, Math.max(letters.length - 1, 0));
    const rest = letters.slice(begin).join("");
    const word = /^\S\s*[-+.\w]*/.exec(rest)?.[0] ?? rest.slice(0, 1);
    const mark = make("mark", { "data-severity": severity, title: message }, word);
    return [letters.slice(0, begin).join(""), mark, rest.slice(word.length)];
}

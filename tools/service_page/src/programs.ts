import { checkProgram, fetchExamples } from "./api";
import { byId, debounced, make } from "./dom";
import { keepDrafts, recallDrafts, type Draft } from "./drafts";
import { Editor } from "./editor";
import { readProgram, saveProgram } from "./files";
import { language, numberText, t } from "./i18n";
import { MOTORS, type Example, type Problem, type Verdict } from "./protocol";
import { Cell } from "./signal";

const CHECK_MS = 100;
const NOTHING_FOUND: Verdict = { problems: [] };

interface Tab {
    button: HTMLButtonElement;
    name: HTMLElement;
    /** What the parser said of the text that it saw last. */
    verdict: Verdict;
    checked: string | null;
}

/** The programs of the four motors: one editor, four tabs, files, examples, and the verdict of the parser. */
export class Programs {
    /** Motor whose program is shown. */
    readonly shown = new Cell<number>(MOTORS[0]);
    readonly #drafts: Draft[] = recallDrafts();
    readonly #editor: Editor;
    readonly #tabs: Tab[];
    readonly #verdict = byId("verdict", HTMLElement);
    readonly #examples = byId("examples", HTMLSelectElement);
    readonly #checkSoon = debounced(CHECK_MS, () => void this.#checkAll());
    readonly #onEdit: () => void;
    readonly #onExample: (example: Example) => void;

    constructor(onEdit: () => void, onExample: (example: Example) => void) {
        this.#onEdit = onEdit;
        this.#onExample = onExample;
        this.#tabs = MOTORS.map((motor) => this.#tab(motor));
        const texts = this.#drafts.map((draft) => draft.text);
        const help = byId("command-help", HTMLElement);
        this.#editor = new Editor(byId("editor", HTMLElement), help, texts, () => this.#edited());
        this.#listen();
        void this.#loadExamples();
        this.shown.watch((motor) => this.#show(motor - 1));
        language.watch(() => this.#translate());
        this.#checkSoon();
    }

    /** Texts of the motors that have a program. */
    texts(): Record<string, string> {
        const texts = MOTORS.map((motor, index) => [String(motor), this.#editor.text(index)] as const);
        return Object.fromEntries(texts.filter(([, text]) => text.trim() !== ""));
    }

    text(motor: number): string {
        return this.#editor.text(motor - 1);
    }

    replace(motor: number, text: string): void {
        this.shown.set(motor);
        this.#editor.replace(motor - 1, text);
        this.#editor.focus();
    }

    goTo(line: number, column: number): void {
        this.#editor.goTo(line, column);
    }

    #listen(): void {
        const file = byId("file", HTMLInputElement);
        byId("open", HTMLButtonElement).addEventListener("click", () => file.click());
        file.addEventListener("change", () => void this.#open(file));
        byId("save", HTMLButtonElement).addEventListener("click", () => void this.#save());
        byId("find", HTMLButtonElement).addEventListener("click", () => this.#editor.find());
        this.#verdict.addEventListener("click", () => this.#goToProblem());
        window.addEventListener("keydown", (event) => {
            const isCommand = (event.ctrlKey || event.metaKey) && !event.altKey && !event.shiftKey;
            if (isCommand && event.key === "s") {
                event.preventDefault();
                void this.#save();
            } else if (isCommand && event.key === "o") {
                event.preventDefault();
                file.click();
            }
        });
        this.#examples.addEventListener("change", () => (this.#examples.selectedIndex = 0));
    }

    #edited(): void {
        this.#drafts.forEach((draft, index) => (draft.text = this.#editor.text(index)));
        keepDrafts(this.#drafts);
        this.#checkSoon();
        this.#onEdit();
    }

    async #checkAll(): Promise<void> {
        await Promise.all(this.#tabs.map((tab, index) => this.#check(tab, index)));
    }

    async #check(tab: Tab, index: number): Promise<void> {
        const text = this.#editor.text(index);
        if (text === tab.checked) {
            return;
        }
        try {
            const verdict = text.trim() === "" ? NOTHING_FOUND : await checkProgram(text);
            if (text === this.#editor.text(index)) {
                tab.checked = text;
                tab.verdict = verdict;
                this.#editor.mark(index, text, verdict.problems);
                this.#showVerdicts();
            }
        } catch {
            this.#verdict.textContent = t("verdict.unknown");
        }
    }

    #showVerdicts(): void {
        for (const { button, verdict } of this.#tabs) {
            button.dataset.verdict = verdictOf(verdict.problems);
        }
        const tab = this.#tabs[this.shown.value - 1];
        if (tab) {
            const { problems } = tab.verdict;
            const count = (severity: string): number => problems.filter((one) => one.severity === severity).length;
            const isEmpty = (tab.checked ?? "").trim() === "";
            const kind = verdictOf(tab.verdict.problems);
            const words = { errors: count("error"), warnings: count("warning") };
            this.#verdict.dataset.kind = isEmpty ? "empty" : kind;
            const commands = isEmpty ? null : (tab.verdict.commands ?? null);
            const counted = commands === null ? "" : t("verdict.commands", { commands: numberText(commands) });
            byId("command-count", HTMLElement).textContent = counted;
            this.#verdict.textContent = t(isEmpty ? "verdict.empty" : `verdict.${kind}`, words);
        }
    }

    #goToProblem(): void {
        const problem = this.#tabs[this.shown.value - 1]?.verdict.problems[0];
        if (problem) {
            this.goTo(problem.line, problem.column);
        }
    }

    #show(index: number): void {
        this.#editor.show(index);
        this.#tabs.forEach(({ button }, at) => {
            button.setAttribute("aria-selected", String(at === index));
            button.tabIndex = at === index ? 0 : -1;
        });
        const tab = this.#tabs[index];
        if (tab?.checked != null) {
            this.#editor.mark(index, tab.checked, tab.verdict.problems);
        }
        this.#showNames();
        this.#showVerdicts();
    }

    #showNames(): void {
        byId("file-name", HTMLElement).textContent = this.#drafts[this.shown.value - 1]?.name ?? "";
    }

    #translate(): void {
        MOTORS.forEach((motor, index) => {
            const tab = this.#tabs[index];
            if (tab) {
                tab.name.textContent = t("motor.one", { motor });
                this.#editor.mark(index, tab.checked ?? "", tab.verdict.problems);
            }
        });
        this.#showVerdicts();
    }

    async #open(input: HTMLInputElement): Promise<void> {
        const file = input.files?.[0];
        if (file) {
            this.#take(file.name, await readProgram(file));
        }
        input.value = "";
    }

    async #save(): Promise<void> {
        const draft = this.#drafts[this.shown.value - 1];
        if (draft) {
            draft.name = (await saveProgram(draft.name, draft.text)) ?? draft.name;
            keepDrafts(this.#drafts);
            this.#showNames();
        }
    }

    #take(name: string, text: string): void {
        const draft = this.#drafts[this.shown.value - 1];
        if (draft) {
            draft.name = name;
        }
        this.replace(this.shown.value, text);
        this.#showNames();
    }

    async #loadExamples(): Promise<void> {
        const examples = await fetchExamples().catch(() => []);
        this.#examples.append(...examples.map(({ name }, at) => make("option", { value: String(at) }, name)));
        this.#examples.addEventListener("input", () => {
            const example = examples[Number(this.#examples.value || -1)];
            if (example) {
                this.#take(example.name, example.text);
                this.#onExample(example);
            }
        });
    }

    #tab(motor: number): Tab {
        const name = make("span", {}, `${motor}`);
        const style = `--c: var(--motor-${motor})`;
        const attributes = { type: "button", role: "tab", style, id: `tab-${motor}`, "aria-controls": "editor" };
        const button = make("button", attributes, make("i", { class: "dot" }), name);
        button.addEventListener("click", () => this.shown.set(motor));
        button.addEventListener("keydown", (event) => this.#moveTab(event, motor));
        byId("tabs", HTMLElement).append(button);
        return { button, name, verdict: NOTHING_FOUND, checked: null };
    }

    #moveTab(event: KeyboardEvent, motor: number): void {
        const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key] ?? 0;
        if (step !== 0) {
            const next = ((motor - 1 + step + MOTORS.length) % MOTORS.length) + 1;
            this.shown.set(next);
            this.#tabs[next - 1]?.button.focus();
        }
    }
}

function verdictOf(problems: Problem[]): "good" | "warning" | "error" {
    if (problems.some((problem) => problem.severity === "error")) {
        return "error";
    }
    return problems.length > 0 ? "warning" : "good";
}

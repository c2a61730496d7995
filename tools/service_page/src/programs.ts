import { Refused, checkProgram, fetchExamples } from "./api";
import { byId, debounced, make } from "./dom";
import { keepDrafts, motorForm, recallDrafts } from "./drafts";
import { Editor } from "./editor";
import { newForm, type FileForm } from "./file_form";
import { FILE_BYTES_MAX, readProgram, saveProgram } from "./files";
import { language, numberText, t } from "./i18n";
import type { Marks } from "./line_marks";
import { MOTORS, type Example, type Problem, type Verdict } from "./protocol";
import { Cell } from "./signal";

const CHECK_MS = 100;
const NOTHING_FOUND: Verdict = { problems: [] };

const ENCODINGS = { "utf-8": "", "utf-8-bom": "UTF-8 BOM", "windows-1250": "ANSI (1250)" } as const;

export interface ProgramEvents {
    edit: () => void;
    /** The parser has seen a text. */
    check: () => void;
    /** Another program has taken the place of one. */
    replace: () => void;
    example: (example: Example) => void;
}

interface Tab {
    button: HTMLButtonElement;
    name: HTMLElement;
    /** What the parser said of the text that it saw last. */
    verdict: Verdict;
    checked: string | null;
    /** Why the text that is there now has not been checked; null if it has. */
    trouble: string | null;
}

/** The programs of the four motors: one editor, four tabs, files, examples, and the verdict of the parser. */
export class Programs {
    /** Motor whose program is shown. */
    readonly shown = new Cell<number>(MOTORS[0]);
    readonly #editor: Editor;
    readonly #tabs: Tab[];
    readonly #verdict = byId("verdict", HTMLElement);
    readonly #examples = byId("examples", HTMLSelectElement);
    readonly #checkSoon = debounced(CHECK_MS, () => void this.#checkAll());
    readonly #on: ProgramEvents;
    readonly #marks = new Map<number, Marks>();
    #names: string[] = [];

    constructor(on: ProgramEvents) {
        this.#on = on;
        this.#tabs = MOTORS.map((motor) => this.#tab(motor));
        const help = byId("command-help", HTMLElement);
        this.#editor = new Editor(byId("editor", HTMLElement), help, recallDrafts(), () => this.#edited());
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

    /** All four, as they would be saved. */
    all(): { text: string; form: FileForm }[] {
        return MOTORS.map((_, index) => ({ text: this.#editor.text(index), form: this.#editor.form(index) }));
    }

    /** Puts others in the place of all four; undo brings back each of the old ones. */
    replaceAll(programs: { text: string; form: FileForm }[]): void {
        programs.forEach(({ text, form }, index) => this.#editor.replace(index, text, form));
        this.#sayOfFile("");
        this.#on.replace();
    }

    /** What motors are called, by number; empty where there is no name. */
    setNames(names: string[]): void {
        this.#names = names;
        this.#translate();
    }

    /** Puts another program in the place of one; without a form, one that is of no file yet. */
    replace(motor: number, text: string, form: FileForm = motorForm(motor)): void {
        this.shown.set(motor);
        this.#editor.replace(motor - 1, text, form);
        this.#editor.focus();
        this.#on.replace();
    }

    /** What the parser says of the text that is there now; null: nothing yet. */
    verdict(motor: number): Verdict | null {
        const tab = this.#tabs[motor - 1];
        return tab === undefined || tab.trouble !== null || tab.checked !== this.text(motor) ? null : tab.verdict;
    }

    /** Marks the line that the unit runs; null: none. */
    markUnit(motor: number, line: number | null): void {
        this.#mark(motor, { unit: line });
    }

    /** Marks the line at which the simulation is; `scrolls`: brings it into sight. */
    markSimulated(motor: number, line: number | null, scrolls: boolean): void {
        const isNew = this.#marks.get(motor)?.simulated !== line;
        this.#mark(motor, { simulated: line });
        if (line !== null && isNew && scrolls) {
            this.#editor.bringIntoSight(line);
        }
    }

    /** Called with the line to which the cursor of the shown program was moved. */
    set onMove(handler: (line: number) => void) {
        this.#editor.onMove = handler;
    }

    /** The line of the cursor. */
    get line(): number {
        return this.#editor.line;
    }

    /** The lines of a program at which the simulation is to stop. */
    breaks(motor: number): number[] {
        return this.#editor.breaks(motor - 1);
    }

    #mark(motor: number, change: Partial<Marks>): void {
        const marks = { ...(this.#marks.get(motor) ?? { unit: null, simulated: null }), ...change };
        this.#marks.set(motor, marks);
        this.#editor.setMarks(motor - 1, marks);
    }

    /** To be called when the service may answer again. */
    check(): void {
        this.#checkSoon();
    }

    goTo(line: number, column: number): void {
        this.#editor.goTo(line, column);
    }

    /** Puts an example in the place of the shown program, and its inputs in that of others. */
    take(example: Example): void {
        this.#sayOfFile("");
        this.replace(this.shown.value, example.text, newForm(example.name));
        this.#on.example(example);
    }

    /** Puts a text at the cursor of the shown program. */
    insert(text: string): void {
        this.#editor.insert(text);
    }

    #listen(): void {
        const file = byId("file", HTMLInputElement);
        byId("open", HTMLButtonElement).addEventListener("click", () => file.click());
        file.addEventListener("change", () => void this.#open(file));
        byId("save", HTMLButtonElement).addEventListener("click", () => void this.#save());
        byId("commands", HTMLButtonElement).addEventListener("click", () => this.#editor.complete());
        byId("find", HTMLButtonElement).addEventListener("click", () => this.#editor.find());
        this.#verdict.addEventListener("click", () => this.#goToProblem());
        window.addEventListener("keydown", (event) => {
            const isCommand = (event.ctrlKey || event.metaKey) && !event.altKey && !event.shiftKey;
            if (isCommand && event.key === "s") {
                event.preventDefault();
                if (!event.repeat) {
                    void this.#save();
                }
            } else if (isCommand && event.key === "o") {
                event.preventDefault();
                if (!event.repeat) {
                    file.click();
                }
            }
        });
        this.#examples.addEventListener("change", () => (this.#examples.selectedIndex = 0));
    }

    #edited(): void {
        keepDrafts(MOTORS.map((_, index) => ({ ...this.#editor.form(index), text: this.#editor.text(index) })));
        this.#showFile();
        this.#checkSoon();
        this.#on.edit();
    }

    async #checkAll(): Promise<void> {
        await Promise.all(this.#tabs.map((tab, index) => this.#check(tab, index)));
    }

    async #check(tab: Tab, index: number): Promise<void> {
        const text = this.#editor.text(index);
        if (text === tab.checked) {
            return;
        }
        tab.trouble = null;
        try {
            const verdict = text.trim() === "" ? NOTHING_FOUND : await checkProgram(text);
            if (text === this.#editor.text(index)) {
                tab.checked = text;
                tab.verdict = verdict;
                this.#editor.mark(index, text, verdict.problems);
                this.#on.check();
            }
        } catch (error) {
            tab.trouble = error instanceof Refused ? `${t("verdict.refused")}: ${error.message}` : t("verdict.unknown");
        }
        this.#showVerdicts();
    }

    #showVerdicts(): void {
        for (const { button, verdict, trouble } of this.#tabs) {
            button.dataset.verdict = trouble === null ? verdictOf(verdict.problems) : "unknown";
        }
        const tab = this.#tabs[this.shown.value - 1];
        if (tab?.trouble != null) {
            this.#verdict.dataset.kind = "unknown";
            this.#verdict.textContent = tab.trouble;
            byId("command-count", HTMLElement).textContent = "";
        } else if (tab) {
            const { problems, more = 0 } = tab.verdict;
            const count = (severity: string): string => {
                const told = problems.filter((one) => one.severity === severity).length;
                return numberText(told === 0 ? 0 : told + more);
            };
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
        this.#showFile();
        this.#showVerdicts();
    }

    /** The name of the file; how it is written, where that is not as usual. */
    #showFile(): void {
        const { name, encoding, end, tail } = this.#editor.form(this.shown.value - 1);
        byId("file-name", HTMLElement).textContent = name;
        const parts = [ENCODINGS[encoding], { "\n": "", "\r\n": "CRLF", "\r": "CR" }[end], tail ? "1A" : ""];
        byId("file-form", HTMLElement).textContent = parts.filter((part) => part !== "").join(" · ");
    }

    #translate(): void {
        MOTORS.forEach((motor, index) => {
            const tab = this.#tabs[index];
            if (tab) {
                const name = this.#names[index] ?? "";
                tab.name.textContent = [t("motor.one", { motor }), name].filter((part) => part !== "").join(" · ");
                this.#editor.mark(index, tab.checked ?? "", tab.verdict.problems);
            }
        });
        this.#showVerdicts();
    }

    async #open(input: HTMLInputElement): Promise<void> {
        const file = input.files?.[0];
        const motor = this.shown.value;
        if (file) {
            const found = await readProgram(file);
            const isRead = typeof found === "object";
            const words = { name: file.name, bytes: numberText(FILE_BYTES_MAX) };
            this.#sayOfFile(isRead ? "" : t(`file.${found}`, words));
            if (isRead) {
                this.replace(motor, found.text, found.form);
            }
        }
        input.value = "";
    }

    async #save(): Promise<void> {
        const index = this.shown.value - 1;
        const before = this.#editor.form(index);
        const form = await saveProgram(before, this.#editor.text(index));
        if (form) {
            this.#editor.setForm(index, form);
            this.#sayOfFile(form.encoding === before.encoding ? "" : t("file.becameUtf8", { name: form.name }));
        }
    }

    #sayOfFile(words: string): void {
        const place = byId("file-trouble", HTMLElement);
        place.textContent = words;
        place.hidden = words === "";
    }

    async #loadExamples(): Promise<void> {
        const examples = await fetchExamples().catch(() => []);
        this.#examples.append(...examples.map(({ name }, at) => make("option", { value: String(at) }, name)));
        this.#examples.addEventListener("input", () => {
            const example = examples[Number(this.#examples.value || -1)];
            if (example) {
                this.take(example);
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
        return { button, name, verdict: NOTHING_FOUND, checked: null, trouble: null };
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

import { startCompletion } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, invertedEffects, isolateHistory } from "@codemirror/commands";
import { lintGutter, lintKeymap, linter, setDiagnostics } from "@codemirror/lint";
import { highlightSelectionMatches, openSearchPanel, search, searchKeymap } from "@codemirror/search";
import {
    Compartment,
    EditorState,
    StateEffect,
    StateField,
    Transaction,
    type Extension,
    type TransactionSpec,
} from "@codemirror/state";
import {
    EditorView,
    drawSelection,
    highlightActiveLine,
    highlightActiveLineGutter,
    keymap,
    lineNumbers,
} from "@codemirror/view";
import { completion } from "./completion";
import type { Draft } from "./drafts";
import { newForm, type FileForm } from "./file_form";
import { highlighting } from "./highlight";
import { explain } from "./help";
import { breakLines, hasMarks, hasNewBreaks, lineMarks, marksEffect, type Marks } from "./line_marks";
import { language, t } from "./i18n";
import { phrases } from "./phrases";
import type { Problem } from "./protocol";
import { toDiagnostic } from "./problems";

const setForm = StateEffect.define<FileForm>();

/** The file that a program is of. Undo brings it back with the text. */
const formField = StateField.define<FileForm>({
    create: () => newForm(""),
    update: (form, { effects }) => effects.reduce((last, effect) => (effect.is(setForm) ? effect.value : last), form),
});

const formHistory = invertedEffects.of(({ effects, startState }) =>
    effects.some((effect) => effect.is(setForm)) ? [setForm.of(startState.field(formField))] : [],
);

/**
 * One editor on the page, with a document, an undo history and a cursor for each of the programs. Programs are
 * counted from 0 here.
 */
export class Editor {
    readonly #view: EditorView;
    readonly #states: EditorState[];
    readonly #words = new Compartment();
    readonly #onEdit: () => void;
    readonly #help: HTMLElement;
    #shown = 0;
    /** Called when the cursor of the shown program was moved to a line, from 1, or break points have changed. */
    onMove: (line: number) => void = () => undefined;

    constructor(host: HTMLElement, help: HTMLElement, drafts: Draft[], onEdit: () => void) {
        this.#onEdit = onEdit;
        this.#help = help;
        this.#states = drafts.map((draft) => this.#newState(draft));
        this.#view = new EditorView({ parent: host, state: this.#stateAt(0) });
        language.onChange(() => this.#translate());
    }

    text(index: number): string {
        return this.#current(index).doc.toString();
    }

    /** What the file of a program is like. */
    form(index: number): FileForm {
        return this.#current(index).field(formField);
    }

    /** Replaces a program by one of another file; undo brings the old ones back. */
    replace(index: number, text: string, form: FileForm): void {
        const changes = { from: 0, to: this.#current(index).doc.length, insert: text };
        this.#change(index, { changes, effects: setForm.of(form), annotations: isolateHistory.of("full") });
    }

    /** A program has become one of another file; there is nothing to undo. */
    setForm(index: number, form: FileForm): void {
        this.#change(index, { effects: setForm.of(form), annotations: Transaction.addToHistory.of(false) });
    }

    #change(index: number, change: TransactionSpec): void {
        if (index === this.#shown) {
            this.#view.dispatch(change);
        } else {
            const before = this.#current(index);
            this.#states[index] = before.update(change).state;
            if (this.#current(index).doc !== before.doc || this.form(index) !== before.field(formField)) {
                this.#onEdit();
            }
        }
    }

    show(index: number): void {
        this.#states[this.#shown] = this.#view.state;
        this.#shown = index;
        this.#view.setState(this.#stateAt(index));
        this.#explain();
    }

    /** Underlines what the parser found, if it was found in the text that is here now. */
    mark(index: number, text: string, problems: Problem[]): void {
        const state = this.#current(index);
        if (state.doc.toString() !== text) {
            return;
        }
        const found = setDiagnostics(state, problems.map((problem) => toDiagnostic(state.doc, problem)));
        if (index === this.#shown) {
            this.#view.dispatch(found);
        } else {
            this.#states[index] = state.update(found).state;
        }
    }

    /** Marks lines of a program. */
    setMarks(index: number, marks: Marks): void {
        if (!hasMarks(this.#current(index), marks)) {
            this.#change(index, { effects: marksEffect(marks) });
        }
    }

    /** Scrolls to a line of the shown program; the cursor stays. */
    bringIntoSight(line: number): void {
        const { doc } = this.#view.state;
        if (line <= doc.lines) {
            this.#view.dispatch({ effects: EditorView.scrollIntoView(doc.line(line).from) });
        }
    }

    /** The lines of a program at which the simulation is to stop. */
    breaks(index: number): number[] {
        return breakLines(this.#current(index));
    }

    /** The line of the cursor, from 1. */
    get line(): number {
        const { doc, selection } = this.#view.state;
        return doc.lineAt(selection.main.head).number;
    }

    /** Puts the cursor at a line and column of the shown program; both count from 1. */
    goTo(line: number, column: number): void {
        const problem: Problem = { line, column, end_column: column, severity: "error", message: "" };
        const { from } = toDiagnostic(this.#view.state.doc, problem);
        this.#view.dispatch({ selection: { anchor: from }, scrollIntoView: true });
        this.#view.focus();
    }

    /** Puts a text at the cursor of the shown program, apart from what stands there. */
    insert(text: string): void {
        const { state } = this.#view;
        const { from, to } = state.selection.main;
        const before = state.sliceDoc(Math.max(0, from - 1), from);
        const after = state.sliceDoc(to, to + 1);
        const gap = (beside: string): string => (beside === "" || /\s/.test(beside) ? "" : " ");
        const insert = `${gap(before)}${text}${text.endsWith("\n") ? "" : gap(after)}`;
        this.#view.dispatch({
            changes: { from, to, insert }, selection: { anchor: from + insert.length },
            scrollIntoView: true, annotations: isolateHistory.of("full"),
        });
    }

    /** Offers the commands that can stand at the cursor. */
    complete(): void {
        this.#view.focus();
        startCompletion(this.#view);
    }

    find(): void {
        openSearchPanel(this.#view);
    }

    focus(): void {
        this.#view.focus();
    }

    /** Says below the editor what the command at the cursor means. */
    #explain(): void {
        const { doc, selection } = this.#view.state;
        this.#help.textContent = explain(doc.toString(), selection.main.head);
    }

    #stateAt(index: number): EditorState {
        const state = this.#states[index];
        if (state === undefined) {
            throw new Error(`there is no program ${index}`);
        }
        return state;
    }

    #current(index: number): EditorState {
        return index === this.#shown ? this.#view.state : this.#stateAt(index);
    }

    #newState({ text, ...form }: Draft): EditorState {
        return EditorState.create({
            doc: text,
            extensions: [
                formField.init(() => form),
                formHistory,
                lineMarks,
                lineNumbers(),
                highlightActiveLine(),
                highlightActiveLineGutter(),
                history(),
                drawSelection(),
                highlightSelectionMatches(),
                search({ top: true }),
                highlighting,
                completion,
                linter(null),
                lintGutter(),
                EditorView.lineWrapping,
                keymap.of([...defaultKeymap, ...historyKeymap, ...searchKeymap, ...lintKeymap]),
                EditorView.updateListener.of((update) => {
                    if (update.docChanged || update.startState.field(formField) !== update.state.field(formField)) {
                        this.#onEdit();
                    }
                    if (update.docChanged || update.selectionSet) {
                        this.#explain();
                    }
                    if (update.selectionSet || hasNewBreaks(update.startState, update.state)) {
                        this.onMove(this.line);
                    }
                }),
                this.#words.of(this.#translated()),
            ],
        });
    }

    #translated(): Extension {
        return [
            EditorState.phrases.of(phrases()),
            EditorView.contentAttributes.of({ "aria-label": t("editor.label"), spellcheck: "false" }),
        ];
    }

    #translate(): void {
        const effects = this.#words.reconfigure(this.#translated());
        this.#view.dispatch({ effects });
        this.#explain();
        this.#states.forEach((state, index) => {
            if (index !== this.#shown) {
                this.#states[index] = state.update({ effects }).state;
            }
        });
    }
}

import { RangeSet, StateEffect, StateField, type EditorState, type Extension } from "@codemirror/state";
import { Decoration, EditorView, GutterMarker, gutter, keymap, type DecorationSet } from "@codemirror/view";

/*
 * Lines of a program that have a mark: that which the unit runs, that at which the simulation is, and those at which
 * it is to stop.
 */

export interface Marks {
    /** Lines, from 1; null: none, or it is not known. */
    unit: number | null;
    simulated: number | null;
}

const NONE: Marks = { unit: null, simulated: null };

const setMarks = StateEffect.define<Marks>();
const setBreak = StateEffect.define<{ at: number; on: boolean }>();

/** A text that was edited is another program: its marks are gone until they are set again. */
const marksField = StateField.define<Marks>({
    create: () => NONE,
    update: (marks, { docChanged, effects }) =>
        effects.reduce((last, effect) => (effect.is(setMarks) ? effect.value : last), docChanged ? NONE : marks),
    provide: (field) => EditorView.decorations.from(field, (marks) => (view: EditorView) => decorated(view.state, marks)),
});

function decorated({ doc }: EditorState, { unit, simulated }: Marks): DecorationSet {
    const lines = [
        { line: unit, name: "cm-unit-line" },
        { line: simulated, name: "cm-simulated-line" },
    ];
    const found = lines.flatMap(({ line, name }) =>
        line !== null && line >= 1 && line <= doc.lines
            ? [Decoration.line({ class: name }).range(doc.line(line).from)]
            : [],
    );
    return Decoration.set(found, true);
}

const breakMarker = new (class extends GutterMarker {
    override toDOM(): Node {
        const dot = document.createElement("i");
        dot.className = "cm-break";
        return dot;
    }
})();

const breaksField = StateField.define<RangeSet<GutterMarker>>({
    create: () => RangeSet.empty,
    update: (breaks, { changes, effects }) =>
        effects.reduce(
            (last, effect) => (effect.is(setBreak) ? changed(last, effect.value) : last),
            breaks.map(changes),
        ),
});

function changed(breaks: RangeSet<GutterMarker>, { at, on }: { at: number; on: boolean }): RangeSet<GutterMarker> {
    return on ? breaks.update({ add: [breakMarker.range(at)] }) : breaks.update({ filter: (from) => from !== at });
}

function toggleBreak(view: EditorView, position: number): void {
    const at = view.state.doc.lineAt(position).from;
    const on = !breakLines(view.state).includes(view.state.doc.lineAt(at).number);
    view.dispatch({ effects: setBreak.of({ at, on }) });
}

/** The lines at which the simulation is to stop, from 1. */
export function breakLines(state: EditorState): number[] {
    const lines: number[] = [];
    state.field(breaksField).between(0, state.doc.length, (from) => {
        lines.push(state.doc.lineAt(from).number);
    });
    return [...new Set(lines)];
}

export const marksEffect = (marks: Marks): StateEffect<Marks> => setMarks.of(marks);

/** Whether an editor has these marks already. */
export function hasMarks(state: EditorState, { unit, simulated }: Marks): boolean {
    const now = state.field(marksField);
    return now.unit === unit && now.simulated === simulated;
}

export const hasNewBreaks = (before: EditorState, after: EditorState): boolean =>
    before.field(breaksField) !== after.field(breaksField);

/** The extension: a click beside a line, or F9 in it, sets a break point or takes it away. */
export const lineMarks: Extension = [
    marksField,
    breaksField,
    gutter({
        class: "cm-breaks",
        markers: (view) => view.state.field(breaksField),
        initialSpacer: () => breakMarker,
        domEventHandlers: {
            mousedown: (view, line) => {
                toggleBreak(view, line.from);
                return true;
            },
        },
    }),
    keymap.of([
        {
            key: "F9",
            run: (view) => {
                toggleBreak(view, view.state.selection.main.head);
                return true;
            },
        },
    ]),
];

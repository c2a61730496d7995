import { autocompletion, snippetCompletion, type Completion, type CompletionContext } from "@codemirror/autocomplete";
import type { Extension } from "@codemirror/state";
import { commands, type CommandRow } from "help-pages";
import { meaningOf, syntaxOf } from "./help";

/** A sample of a command, of which the numbers are to be typed over; null: it has none. */
function sampleOf({ letter, form, min }: CommandRow): string | null {
    switch (form) {
        case "NUMBER":
            return `${letter}#{1:${min}}`;
        case "IO":
            return `${letter}#{1:${String(min).padStart(2, "0")}}`;
        case "SIGNED":
            return `${letter}#{1:0}`;
        case "HIGH":
            return `${letter}#{1:01}H#{2:1}`;
        case "LOW":
            return `${letter}#{1:01}L#{2:1}`;
        default:
            return null;
    }
}

function optionOf(row: CommandRow): Completion {
    const option = { label: syntaxOf(row), detail: meaningOf(row) };
    const sample = sampleOf(row);
    return sample === null ? { ...option, apply: option.label } : snippetCompletion(sample, option);
}

/** The commands that begin with the sign before the cursor, or all of them; none in a comment. */
function complete({ state, pos }: CompletionContext): { from: number; options: Completion[]; filter: false } | null {
    const before = state.sliceDoc(0, pos);
    if (before.lastIndexOf("{") > before.lastIndexOf("}")) {
        return null;
    }
    const last = before.slice(-1);
    const begun = commands.filter(({ letter }) => letter === last);
    const rows = begun.length > 0 ? begun : commands;
    return { from: begun.length > 0 ? pos - 1 : pos, options: rows.map(optionOf), filter: false };
}

/** Commands are offered when they are asked for, as a letter that is typed is a whole command. */
export const completion: Extension = autocompletion({
    override: [complete], activateOnTyping: false, icons: false, maxRenderedOptions: commands.length,
});

import { HighlightStyle, StreamLanguage, type StringStream, syntaxHighlighting } from "@codemirror/language";
import type { Extension } from "@codemirror/state";
import { tags } from "@lezer/highlight";

/*
 * Colours only. What is right and what is wrong is said by the firmware's own parser (problems.ts), so this may
 * colour too much or too little, but never decides.
 */
const KINDS: readonly (readonly [token: string, letters: RegExp])[] = [
    ["setting", /[ASV=]/],
    ["motion", /[BFGHRYD()]/],
    ["flow", /[@EIJL'"`´’„.[\]]/],
    ["signal", /[CMNOTUWXZ]/],
    ["control", /[\\K]/],
];

interface State {
    inComment: boolean;
}

function token(stream: StringStream, state: State): string | null {
    if (state.inComment || stream.eat("{")) {
        state.inComment = !stream.skipTo("}");
        if (state.inComment) {
            stream.skipToEnd();
        } else {
            stream.next();
        }
        return "comment";
    }
    if (stream.eatSpace()) {
        return null;
    }
    if (stream.match(/^I\d*[HL]?/)) {
        return "flow";
    }
    if (stream.match(/^G[+-]/)) {
        return "motion";
    }
    if (stream.match(/^-?\d+/)) {
        return "number";
    }
    const letter = stream.next() ?? "";
    return KINDS.find(([, letters]) => letters.test(letter))?.[0] ?? null;
}

const rks = StreamLanguage.define<State>({
    name: "rks",
    startState: () => ({ inComment: false }),
    copyState: (state) => ({ ...state }),
    token,
    tokenTable: {
        comment: tags.blockComment,
        setting: tags.propertyName,
        motion: tags.keyword,
        flow: tags.controlKeyword,
        signal: tags.typeName,
        control: tags.processingInstruction,
        number: tags.number,
    },
    languageData: { commentTokens: { block: { open: "{", close: "}" } } },
});

const colours = HighlightStyle.define([
    { tag: tags.blockComment, color: "var(--code-comment)", fontStyle: "italic" },
    { tag: tags.propertyName, color: "var(--code-setting)" },
    { tag: tags.keyword, color: "var(--code-motion)", fontWeight: "600" },
    { tag: tags.controlKeyword, color: "var(--code-flow)", fontWeight: "600" },
    { tag: tags.typeName, color: "var(--code-signal)" },
    { tag: tags.processingInstruction, color: "var(--code-control)", fontWeight: "600" },
    { tag: tags.number, color: "var(--code-number)" },
]);

export const highlighting: Extension = [rks, syntaxHighlighting(colours)];

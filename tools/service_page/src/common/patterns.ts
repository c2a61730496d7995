/** Sentences in another language: $1 to $9, or #1 to #9 for whole numbers, stand for what differs, in this order in the English one. */
export type Sentences = readonly (readonly [english: string, other: string])[];

/** What differs does not reach beyond a sentence. */
const ANY = "((?:(?!; )[^])*)";
/** A log is shown anew with each answer. */
const KEPT_MAX = 1000;
const NUMBER = "(\\d+)";
const PLACES = /([$#])\d/;
const SIGNS = /[\\^$.*+?()[\]{}|]/g;

/**
 * Puts sentences that come from outside, each perhaps after its place and ": "; others stay. They are joined by
 * `separators`, of which the first divides most.
 */
export function translatorOf(sentences: Sentences, separators: readonly string[] = ["; "]): (text: string) => string {
    const rows = sentences.map(([english, other]) => {
        const parts = english.split(PLACES).map((part) => (part === "$" ? ANY : part === "#" ? NUMBER : part.replace(SIGNS, "\\$&")));
        return { pattern: new RegExp(`^${parts.join("")}$`), other, words: english.replace(PLACES, "").length };
    }).sort((one, two) => two.words - one.words); // what says most is meant first

    function known(text: string): string | null {
        for (const { pattern, other } of rows) {
            const found = pattern.exec(text);
            if (found !== null) {
                return other.replace(/[$#](\d)/g, (_, digit: string) => translated(found[Number(digit)] ?? ""));
            }
        }
        return null;
    }

    /** What follows a place. */
    function placed(text: string): string | null {
        const [first = ""] = text.split("; ");
        for (let at = first.indexOf(": "); at >= 0; at = first.indexOf(": ", at + 1)) {
            const told = known(text.slice(at + 2));
            if (told !== null) {
                return text.slice(0, at + 2) + told;
            }
        }
        return null;
    }

    /** Sentences of which each is known; in a list within a sentence none has a place of its own. */
    function listed(text: string, separator: string): string | null {
        const parts = text.includes(separator) ? text.split(separator).map(separator === separators[0] ? whole : known) : [null];
        return parts.includes(null) ? null : parts.join(separator);
    }

    const whole = (text: string): string | null =>
        separators.reduce<string | null>((told, each) => told ?? listed(text, each), null) ?? known(text) ?? placed(text);

    function translated(text: string, [separator, ...finer] = separators): string {
        const told = whole(text);
        if (told !== null || separator === undefined) {
            return told ?? text;
        }
        return text.split(separator).map((part) => translated(part, finer)).join(separator);
    }

    const kept = new Map<string, string>();
    return (text) => {
        const told = kept.get(text) ?? translated(text);
        if (kept.size > KEPT_MAX) {
            kept.clear();
        }
        kept.set(text, told);
        return told;
    };
}

/** The same where sentences are joined by "; ", and lists in them by ", ". */
export const listTranslatorOf = (sentences: Sentences): ((text: string) => string) => translatorOf(sentences, ["; ", ", "]);

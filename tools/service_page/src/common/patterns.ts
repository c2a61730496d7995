/** Sentences in another language: $1 to $9 stand for what differs, in this order in the English one. */
export type Sentences = readonly (readonly [english: string, other: string])[];

/** What differs does not reach beyond a sentence. */
const ANY = "((?:(?!; )[^])*)";
const SIGNS = /[\\^$.*+?()[\]{}|]/g;

/** Puts sentences that come from outside, joined by "; ", each perhaps after its place and ": "; others stay. */
export function translatorOf(sentences: Sentences): (text: string) => string {
    const rows = sentences.map(([english, other]) => {
        const parts = english.split(/\$\d/).map((part) => part.replace(SIGNS, "\\$&"));
        return { pattern: new RegExp(`^${parts.join(ANY)}$`), other };
    });

    function known(text: string): string | null {
        for (const { pattern, other } of rows) {
            const found = pattern.exec(text);
            if (found !== null) {
                const put = (part = ""): string => known(part) ?? part;
                return other.replace(/\$(\d)/g, (_, digit: string) => put(found[Number(digit)]));
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

    const whole = (text: string): string | null => known(text) ?? placed(text);
    return (text) => whole(text) ?? text.split("; ").map((part) => whole(part) ?? part).join("; ");
}

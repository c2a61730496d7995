import type { Trouble } from "../protocol";
import type { Translate } from "../language";
import type { en } from "./en";
import { troubleWords } from "./outside";

/** What the parts of all pages say; the page of a unit has all of these words, and more. */
export type CommonKey = keyof typeof en | "halt.asked" | "halt.failed" | "halt.done";
export type CommonWords = Translate<CommonKey>;

/** Cause and next step in the language of the page where it knows the kind, else as they were said. */
export function troubleText({ kind, cause, next }: Trouble): string {
    const words = troubleWords(kind);
    return words !== null ? `${words} (${cause})` : next ? `${cause}; ${next}` : cause;
}

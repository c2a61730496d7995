/** What units and services say, in languages other than the English in which they say it. */
import { language, type Language } from "../language";
import { listTranslatorOf, type Sentences } from "./patterns";

/** Sentences as build.mjs writes those of told/NAME.ts: lines, which take less of a page than pairs do. */
export type Columns = [english: string, other: string];

/** A page that no service serves brings its part of them along. */
interface Told {
    alone: Columns;
    service: Columns;
}

function paired([english, other]: Columns): Sentences {
    const others = other.split("\n");
    return english.split("\n").map((each, line) => [each, others[line] ?? each]);
}

const translators: Partial<Record<Language, (text: string) => string>> = {};

/** `brought`: those that a page without a service has; a service has the others in a file. */
export function bringWords(name: string, brought?: Columns): void {
    if (brought !== undefined) {
        translators.cs = listTranslatorOf(paired(brought));
    } else {
        language.watch(() => void loadWords(name));
    }
}

/** Loaded when they are needed; then all that is shown is shown anew. */
async function loadWords(name: string): Promise<void> {
    if (language.value === "en" || translators.cs !== undefined) {
        return;
    }
    try {
        const { alone, service } = (await (await fetch(`/static/told_${name}.json`)).json()) as Told;
        translators.cs = listTranslatorOf([...paired(alone), ...paired(service)]);
        language.set(language.value);
    } catch {
        // The service is gone: what it said stays English.
    }
}

/** In the language of the page; what is not known stays as it is said. */
export const told = (text: string): string => translators[language.value]?.(text) ?? text;

/** Why something was not done, and what to do. */
export const troubleText = ({ cause, next }: { cause: string; next: string }): string =>
    told(next ? `${cause}; ${next}` : cause);

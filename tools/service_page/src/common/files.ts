/** What is wrong in files, in the language of the page. */
import { language } from "../language";

export type Told = (text: string) => string;

/** Bundled from file_words.ts: no part of the page, as few see it. */
const SERVED: string = "/static/file_words.js";

export const asTold: Told = (text) => text;

/** Puts what a service says of files in the language of the page; what is not known stays as it is said. */
export async function servedWords(): Promise<Told> {
    const name = language.value;
    if (name === "en") {
        return asTold;
    }
    try {
        const { wordsOf } = (await import(SERVED)) as typeof import("../file_words");
        return (text) => wordsOf(text, name);
    } catch {
        return asTold; // the service is gone
    }
}

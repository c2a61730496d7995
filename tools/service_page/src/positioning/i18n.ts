import { setUpWords, translator } from "../language";
import { cs } from "./cs";
import { en } from "./en";

export { language, numberText } from "../language";

export type Key = keyof typeof en;
export type Dictionary = Record<Key, string>;

/** The text of a key in the chosen language. */
export const t = translator<Key>({ en, cs });

/** The text of a name from outside under a prefix, as of a message; the name itself where there is none. */
export function named(prefix: string, name: string | number): string {
    const key = `${prefix}.${name}`;
    return key in en ? t(key as Key) : String(name);
}

export const setUpLanguage = (chooser: HTMLSelectElement): void => setUpWords<Key>(chooser, t);

import { setUpWords, translator } from "../language";
import { cs } from "./cs";
import { en } from "./en";

export { clockText, language, numberText } from "../language";

export type Key = keyof typeof en;
export type Dictionary = Record<Key, string>;

/** The text of a key in the chosen language. */
export const t = translator<Key>({ en, cs });

/** Whether a text from outside is a key, for names that the service sends. */
export const isKey = (name: string): name is Key => name in en;

export const setUpLanguage = (chooser: HTMLSelectElement): void => setUpWords<Key>(chooser, t);

export { troubleText } from "../common/words";

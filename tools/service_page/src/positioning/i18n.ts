import { setUpWords, translator } from "../language";
import { aloneCs, aloneEn } from "../common/alone_words";
import { cs } from "./cs";
import { en } from "./en";

export { language, numberText } from "../language";

export type Key = keyof typeof en;
export type Dictionary = Record<Key, string>;

/** Whether the page needs no service; then some words are others. */
export const isAlone = document.getElementById("alone") !== null;

/** The text of a key in the chosen language. */
export const t = translator<Key>(isAlone ? { en: { ...en, ...aloneEn }, cs: { ...cs, ...aloneCs } } : { en, cs });

/** The text of a name from outside under a prefix, as of a message; the name itself where there is none. */
export function named(prefix: string, name: string | number): string {
    const key = `${prefix}.${name}`;
    return key in en ? t(key as Key) : String(name);
}

export const setUpLanguage = (chooser: HTMLSelectElement): void => setUpWords<Key>(chooser, t);

import { setUpWords, translator } from "../language";
import { aloneCs, aloneEn } from "../common/alone_words";
import { cs } from "./cs";
import { en } from "./en";

export { clockText, language, numberText } from "../language";

export type Key = keyof typeof en;
export type Dictionary = Record<Key, string>;

/** Whether the page needs no service; then some words are others. */
export const isAlone = document.getElementById("alone") !== null;

/** The text of a key in the chosen language. */
export const t = translator<Key>(isAlone ? { en: { ...en, ...aloneEn }, cs: { ...cs, ...aloneCs } } : { en, cs });

/** Whether a text from outside is a key, for names that the service sends. */
export const isKey = (name: string): name is Key => name in en;

export const setUpLanguage = (chooser: HTMLSelectElement): void => setUpWords<Key>(chooser, t);

export { told, troubleText } from "../common/told";

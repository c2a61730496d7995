import { cs } from "./cs";
import { en } from "./en";
import { Cell } from "./signal";
import { keepPreference, recallPreference } from "./storage";

export type Key = keyof typeof en;
export type Dictionary = Record<Key, string>;

/** To add a language: a dictionary beside cs.ts, a line here, an option in index.html. */
const DICTIONARIES = { en, cs } satisfies Record<string, Dictionary>;
export type Language = keyof typeof DICTIONARIES;

const isLanguage = (name: string | null): name is Language => name !== null && name in DICTIONARIES;

function firstLanguage(): Language {
    const kept = recallPreference("language");
    if (isLanguage(kept)) {
        return kept;
    }
    const wanted = navigator.languages.map((name) => name.slice(0, 2));
    return wanted.find(isLanguage) ?? "en";
}

export const language = new Cell<Language>(firstLanguage());

/** The text of a key in the chosen language, with `{name}` replaced. */
export function t(key: Key, values: Record<string, string | number> = {}): string {
    return DICTIONARIES[language.value][key].replace(/\{(\w+)\}/g, (whole, name: string) =>
        String(values[name] ?? whole),
    );
}

/** Whether a text from outside is a key, for names that the service sends. */
export const isKey = (name: string): name is Key => name in en;

/**
 * Words of the page itself: `data-t` is an element's text, `data-t-title` a hint about it, and `data-t-label`
 * is both name and hint of what has no text.
 */
function translatePage(): void {
    document.documentElement.lang = language.value;
    document.title = t("page.title");
    for (const element of document.querySelectorAll<HTMLElement>("[data-t]")) {
        element.textContent = t(element.dataset.t as Key);
    }
    for (const element of document.querySelectorAll<HTMLElement>("[data-t-title]")) {
        element.title = t(element.dataset.tTitle as Key);
    }
    for (const element of document.querySelectorAll<HTMLElement>("[data-t-label]")) {
        const text = t(element.dataset.tLabel as Key);
        element.setAttribute("aria-label", text);
        element.title = text;
    }
}

export function setUpLanguage(chooser: HTMLSelectElement): void {
    language.watch((name) => {
        chooser.value = name;
        translatePage();
    });
    chooser.addEventListener("change", () => {
        if (isLanguage(chooser.value)) {
            keepPreference("language", chooser.value);
            language.set(chooser.value);
        }
    });
}

const LOCALES: Record<Language, string> = { en: "en-GB", cs: "cs-CZ" };

/** A number as the language writes it, with at most `digits` decimal places. */
export function numberText(value: number, digits = 0): string {
    const text = value.toLocaleString(LOCALES[language.value], { maximumFractionDigits: digits });
    return text === "-0" ? "0" : text.replace("-", "−");
}

const PLAIN_BELOW = 10_000_000;

const DECIMALS_MAX = 9;

/** Decimal places that a number has, as 2.5 has one. */
function decimalsOf(value: number): number {
    let decimals = 0;
    while (decimals < DECIMALS_MAX && Math.abs(value * 10 ** decimals - Math.round(value * 10 ** decimals)) > 1e-6) {
        decimals += 1;
    }
    return decimals;
}

/** A number for an axis: short, but never the same as its neighbour, which is `distance` away. */
export function axisNumber(value: number, distance: number): string {
    const digits = Math.ceil(Math.log10(Math.abs(value) / distance)) + 1;
    const format: Intl.NumberFormatOptions =
        Math.abs(value) < PLAIN_BELOW
            ? { maximumFractionDigits: decimalsOf(distance) }
            : { notation: "compact", maximumSignificantDigits: Math.min(Math.max(digits, 4), 21) };
    return value.toLocaleString(LOCALES[language.value], format).replace("-", "−");
}

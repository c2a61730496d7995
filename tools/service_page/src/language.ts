import { readCommas } from "./common/comma";
import { Cell } from "./signal";
import { keepPreference, recallPreference } from "./storage";

/** To add a language: its name here and in LOCALES, a dictionary beside each cs.ts, an option in each page. */
const LANGUAGES = ["en", "cs"] as const;
export type Language = (typeof LANGUAGES)[number];

const isLanguage = (name: string | null): name is Language => LANGUAGES.some((each) => each === name);

function firstLanguage(): Language {
    const kept = recallPreference("language");
    if (isLanguage(kept)) {
        return kept;
    }
    const wanted = navigator.languages.map((name) => name.slice(0, 2));
    return wanted.find(isLanguage) ?? "en";
}

export const language = new Cell<Language>(firstLanguage());

/** Gives the text of a key in the chosen language, with `{name}` replaced. */
export type Translate<K extends string> = (key: K, values?: Record<string, string | number>) => string;

export function translator<K extends string>(dictionaries: Record<Language, Record<K, string>>): Translate<K> {
    return (key, values = {}) =>
        dictionaries[language.value][key].replace(/\{(\w+)\}/g, (whole, name: string) => String(values[name] ?? whole));
}

/**
 * Words of the page itself: `data-t` is an element's text, `data-t-title` a hint about it, and `data-t-label`
 * is both name and hint of what has no text.
 */
function translatePage<K extends string>(t: Translate<K | "page.title">): void {
    document.documentElement.lang = language.value;
    document.title = t("page.title");
    for (const element of document.querySelectorAll<HTMLElement>("[data-t]")) {
        element.textContent = t(element.dataset.t as K);
    }
    for (const element of document.querySelectorAll<HTMLElement>("[data-t-title]")) {
        element.title = t(element.dataset.tTitle as K);
    }
    for (const element of document.querySelectorAll<HTMLElement>("[data-t-label]")) {
        const text = t(element.dataset.tLabel as K);
        element.setAttribute("aria-label", text);
        element.title = text;
    }
}

export function setUpWords<K extends string>(chooser: HTMLSelectElement, t: Translate<K | "page.title">): void {
    readCommas();
    language.watch((name) => {
        chooser.value = name;
        translatePage(t);
    });
    chooser.addEventListener("change", () => {
        if (isLanguage(chooser.value)) {
            keepPreference("language", chooser.value);
            language.set(chooser.value);
        }
    });
}

const LOCALES: Record<Language, string> = { en: "en-GB", cs: "cs-CZ" };

/** Kept, as it takes long to make one: there are many numbers in a look, and ten looks a second. */
const formats = new Map<string, Intl.NumberFormat>();

/** A number as the language writes it, with a true minus. */
function formatted(value: number, options: Intl.NumberFormatOptions): string {
    const key = language.value + JSON.stringify(options);
    const format = formats.get(key) ?? new Intl.NumberFormat(LOCALES[language.value], options);
    formats.set(key, format);
    return format.format(value).replace("-", "−");
}

/** A number with at most `digits` decimal places. */
export function numberText(value: number, digits = 0): string {
    const text = formatted(value, { maximumFractionDigits: digits });
    return text === "−0" ? "0" : text;
}

/** A number with so many decimal places, no fewer. */
export const fixedText = (value: number, digits: number): string =>
    formatted(value, { minimumFractionDigits: digits, maximumFractionDigits: digits });

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
    return formatted(value, format);
}

const MINUTE = 60;

/** Seconds as people tell them. */
export function clockText(seconds: number): string {
    const whole = Math.round(seconds);
    const two = (value: number): string => String(value).padStart(2, "0");
    const [hours, minutes] = [Math.floor(whole / MINUTE / MINUTE), Math.floor(whole / MINUTE) % MINUTE];
    return hours > 0 ? `${hours}:${two(minutes)}:${two(whole % MINUTE)}` : `${minutes}:${two(whole % MINUTE)}`;
}

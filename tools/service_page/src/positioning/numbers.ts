import { language } from "./i18n";
import { FEED_PER_MM_MIN, UM_PER_MM } from "./protocol";

const DIGITS_MM = 3;
/** With so many places each feed of the unit is another number. */
const DIGITS_FEED = 6;

/** µm as mm, with all their digits. */
export function mmText(um: number): string {
    const form = { minimumFractionDigits: DIGITS_MM, maximumFractionDigits: DIGITS_MM };
    return (um / UM_PER_MM).toLocaleString(language.value === "cs" ? "cs-CZ" : "en-GB", form).replace("-", "−");
}

/** A feed of the unit as the value of a field, in mm/min. */
export const feedValue = (feed: number): string => String(Number((feed / FEED_PER_MM_MIN).toFixed(DIGITS_FEED)));

export const feedOf = (mm_min: number): number => Math.round(mm_min * FEED_PER_MM_MIN);

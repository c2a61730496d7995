import { fixedText } from "../language";
import { FEED_PER_MM_MIN, UM_PER_MM } from "./protocol";

const DIGITS_MM = 3;
/** With so many places each feed of the unit is another number. */
const DIGITS_FEED = 6;

/** µm as mm, with all their digits. */
export const mmText = (um: number): string => fixedText(um / UM_PER_MM, DIGITS_MM);

/** A feed of the unit as the value of a field, in mm/min. */
export const feedValue = (feed: number): string => String(Number((feed / FEED_PER_MM_MIN).toFixed(DIGITS_FEED)));

export const feedOf = (mm_min: number): number => Math.round(mm_min * FEED_PER_MM_MIN);

import type { Translate } from "../language";
import type { en } from "./en";

/** What the parts of all pages say; the page of a unit has all of these words, and more. */
export type CommonKey = keyof typeof en | "halt.asked" | "halt.failed" | "halt.done";
export type CommonWords = Translate<CommonKey>;

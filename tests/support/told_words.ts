/** What pages make of what units and services say: `isAlone` in those that no service serves. */
import { listTranslatorOf } from "../../tools/service_page/src/common/patterns";
import * as gve134 from "../../tools/service_page/src/told/gve134";
import * as positioning from "../../tools/service_page/src/told/positioning";
import * as rkm04 from "../../tools/service_page/src/told/rkm04";

const UNITS = { gve134, positioning, rkm04 };

export function wordsOf(unit: keyof typeof UNITS, isAlone: boolean, texts: string[]): string[] {
    const { ALONE, SERVICE } = UNITS[unit];
    const words = listTranslatorOf(isAlone ? ALONE : [...ALONE, ...SERVICE]);
    return texts.map(words);
}

import { t } from "./i18n";
import type { Found } from "./memories";

/** How the program of a motor here compares with that in the unit. */
export function foundWords(motor: number, found: Found | null): string {
    return `${t("motor.one", { motor })}: ${found === null ? t("compare.asked") : wordsOf(found)}`;
}

function wordsOf(found: Found): string {
    if (found.kind !== "other") {
        return t(`compare.${found.kind}`);
    }
    const { ordinal, line, here, there } = found;
    const nothing = t("compare.nothing");
    const place = line === null ? t("compare.command", { ordinal }) : t("compare.line", { ordinal, line });
    return t("compare.other", { place, here: here || nothing, there: there || nothing });
}

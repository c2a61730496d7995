import { isKey, t } from "./i18n";
import type { Trouble } from "./protocol";

/** Cause and next step in the language of the page where it knows the kind, else as the service says it. */
export function troubleText(trouble: Trouble): string {
    const key = `trouble.${trouble.kind ?? ""}`;
    const words = isKey(key) && t(key) !== "" ? t(key) : "";
    const original = trouble.next ? `${trouble.cause}; ${trouble.next}` : trouble.cause;
    return words ? `${words} (${trouble.cause})` : original;
}

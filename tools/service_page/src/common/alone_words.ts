import type { en } from "./en";

type Own = "state.noService" | "state.lost" | "state.notSent" | "port.virtual";

/** Words that are others in a page that needs no service. */
export const aloneEn: Pick<typeof en, Own> = {
    "port.virtual": "virtual unit in this page (no hardware)",
    "state.noService": "not reached",
    "state.lost":
        "The part of this page that speaks to the unit does not answer: this page cannot stop anything. Where a machine moves, use "
        + "the emergency stop; then load the page again. What is pressed now is not sent, and is not done later.",
    "state.notSent": "Not sent: the part of this page that speaks to the unit does not answer",
};

export const aloneCs: typeof aloneEn = {
    "port.virtual": "virtuální jednotka v této stránce (bez hardwaru)",
    "state.noService": "nedostupné",
    "state.lost":
        "Část této stránky, která mluví s jednotkou, neodpovídá: tato stránka nemůže nic zastavit. Pokud se stroj pohybuje, "
        + "použijte nouzové zastavení; pak načtěte stránku znovu. Co teď stisknete, se neodešle a nestane se ani později.",
    "state.notSent": "Neodesláno: část této stránky, která mluví s jednotkou, neodpovídá",
};

/** Words of units that were left while something moved, for the pages of all units. */
export const leftEn = {
    "left.title": "NOT CONNECTED: THIS PAGE CANNOT STOP {units}",
    "left.words":
        "Something moved there when it was seen last, or was told to, or a stop is not confirmed: WHETHER IT MOVES IS NOT "
        + "KNOWN. Connect to it again, or use its emergency stop.",
    "left.dealt": "Dealt with: nothing moves there",
};

export const leftCs: typeof leftEn = {
    "left.title": "NEPŘIPOJENO: TATO STRÁNKA NEMŮŽE ZASTAVIT {units}",
    "left.words":
        "Naposledy se tam něco pohybovalo, nebo to dostalo povel, nebo není potvrzeno zastavení: NENÍ ZNÁMO, ZDA SE TO "
        + "POHYBUJE. Připojte se tam znovu, nebo použijte nouzové zastavení.",
    "left.dealt": "Vyřízeno: nic se tam nepohybuje",
};

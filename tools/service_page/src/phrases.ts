import { language } from "./i18n";

const CZECH: Record<string, string> = {
    Find: "Najít",
    Replace: "Nahradit",
    next: "další",
    previous: "předchozí",
    all: "všechny",
    "match case": "velikost písmen",
    regexp: "regulární výraz",
    "by word": "celá slova",
    replace: "nahradit",
    "replace all": "nahradit vše",
    close: "zavřít",
    "current match": "nalezeno",
    "on line": "na řádku",
    "replaced match on line $": "nahrazeno na řádku $",
    "replaced $ matches": "nahrazeno: $",
    "Go to line": "Přejít na řádek",
    go: "přejít",
    Diagnostics: "Chyby a varování",
    "No diagnostics": "Bez chyb",
    Completions: "Příkazy",
};

/** The editor's own words (search, list of errors); the editor itself speaks English. */
export const phrases = (): Record<string, string> => (language.value === "cs" ? CZECH : {});

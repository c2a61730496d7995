import type { helpEn } from "./help_en";

/** The words of the help in Czech. */
export const helpCs: Record<keyof typeof helpEn, string> = {
    "help.title": "Nápověda",
    "help.open": "Nápověda",
    "help.openLabel": "Jazyk, jeho příkazy, příklady k vyzkoušení, zprávy, linka",
    "help.about": "jazyk, příkazy, příklady, zprávy",
    "help.english": "Příklady mají komentáře jen anglicky.",
    "help.search": "Hledat",
    "help.places": "Dokumenty",
    "help.commands": "Příkazy",
    "help.examples": "Příklady",
    "help.command": "Příkaz",
    "help.range": "n",
    "help.meaning": "Význam",
    "help.try": "Do editoru a simulovat",
    "help.name": "priklad.rks",
    "help.none": "Všechna tato slova nic nemá.",
    "help.found": "nalezeno oddílů: {found}",
    "help.replaces": "Příklad nahradí zobrazený program; Zpět (Ctrl+Z) ho vrátí. Nic se neodesílá.",
    "editor.commands": "Příkazy",
    "editor.commandsLabel": "Příkazy, které mohou být na místě kurzoru (Ctrl+mezerník)",
};

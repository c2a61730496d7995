/** Words of the danger before motion by hand, for the pages of all units; `stop` is what their red button is called. */
export const dangerEn = (stop: string) => ({
    "danger.title": "Danger: motors move from here.",
    "danger.words":
        "Nobody may be within reach of the machine. Have the emergency stop, the one that cuts the power, at hand: "
        + `${stop} on this page needs the computer, the cable and the unit.`,
    "danger.confirm": "I see the machine, nobody is within its reach, and I can reach its emergency stop",
});

export const dangerCs = (stop: string): ReturnType<typeof dangerEn> => ({
    "danger.title": "Nebezpečí: odtud se motory pohybují.",
    "danger.words":
        "V dosahu stroje nesmí nikdo být. Mějte po ruce nouzové tlačítko, které vypíná napájení: "
        + `${stop} na této stránce potřebuje počítač, kabel i jednotku.`,
    "danger.confirm": "Na stroj vidím, nikdo není v jeho dosahu a na jeho nouzové tlačítko dosáhnu",
});

/** Words that come from outside, in languages other than the English in which they come. */
import { language, type Language } from "../language";

type Words = Partial<Record<Language, Record<string, string>>>;

/** Why something was not done, by kind. */
const TROUBLES: Words = {
    cs: {
        PortMissing: "Port neexistuje, nebo na něm nikdo není. Zkontrolujte kabel a zvolte jiný port.",
        PortForbidden: "K portu nemáte oprávnění.",
        PortBusy: "Port používá jiný program. Ukončete jej.",
        PortLost: "Port zmizel za provozu. Zkontrolujte kabel a připojte se znovu.",
        NoAnswer: "Jednotka neodpovídá. Zkontrolujte napájení, kabel, adresu a rychlost linky.",
        GarbledAnswer: "Odpověď byla poškozená. Zkontrolujte kabel a rychlost linky.",
        UnitRestarted: "Jednotka byla restartována. Podívejte se na ni, než cokoli pošlete znovu.",
        Restarted: "Jednotka byla restartována. Podívejte se na ni, než cokoli pošlete znovu.",
        WrongUnit: "Odpovídá něco jiného než tato jednotka. Zvolte jiný port nebo adresu.",
        OtherDevice: "Odpovídá něco jiného než tato jednotka. Zvolte jiný port.",
        NotConnected: "Žádná jednotka není připojena. Připojte se nejdříve.",
        Stopped: "Zrušeno zastavením. Je-li to stále třeba, zopakujte to.",
        Late: "Přišlo to příliš pozdě, nic nebylo odesláno. Podívejte se na jednotku a zopakujte to.",
        Unsent: "Jednotka tehdy nebyla dosažitelná, nic nebylo odesláno. Podívejte se na ni a zopakujte to.",
        NotConfirmed: "Zastavení není potvrzeno. Použijte nouzové zastavení.",
    },
};

/** What units were told and do, piece by piece, with $1 … filled in; numbers, names and commands stay. */
const ANSWERS: Partial<Record<Language, readonly (readonly [pattern: RegExp, words: string])[]>> = {
    cs: [
        [/the unit HAS RESTARTED, its positions count anew/, "jednotka BYLA RESTARTOVÁNA, polohy se počítají znovu"],
        [/the axes stand at/, "osy stojí na"],
        [/stopped, the rest of the vectors waits \(Go on, or Delete\)/, "zastaveno, zbytek vektorů čeká (Pokračovat, nebo Smazat)"],
        [/stopped, nothing waits \(Delete clears it\)/, "zastaveno, nic nečeká (zruší to Smazat)"],
        [/no motion: its crystal does not run/, "nepohybuje se: krystal neběží"],
        [
            /no motion: restarted by its watchdog or a fault \(Delete clears it\)/,
            "nepohybuje se: restartována hlídačem nebo po poruše (zruší to Smazat)",
        ],
        [/; at rest(?=;|$)/, "; v klidu"],
        [/; braking(?=;|$)/, "; brzdí"],
        [/; moving(?=;|$)/, "; jedou"],
        [/confirmed by the unit/, "potvrzeno jednotkou"],
        [/^the axes move by/, "osy jedou o"],
        [/^the axes go on$/, "osy pokračují"],
        [/^the job goes on$/, "práce pokračuje"],
        [/^the queue is empty/, "fronta je prázdná"],
        [/: (\d+) vectors made/, ": vykonáno vektorů: $1"],
        [/^the port is closed; the unit is left as it is$/, "port je uzavřen; jednotka zůstává, jak je"],
        [/^the port is closed$/, "port je uzavřen"],
        [/^noted$/, "vzato na vědomí"],
        [/^the speed becomes (\d+ %)$/, "rychlost bude $1"],
        [/^port 0 is (\w+)$/, "port 0 je $1"],
        [/^the spindle is set to (.+ %)$/, "vřeteno je nastaveno na $1"],
        [/^spindle off$/, "vřeteno je vypnuto"],
        [/^all axes stand/, "všechny osy stojí"],
        [/^axes ([\d, ]+) stand/, "osy $1 stojí"],
        [/^axis (\d) stands at (\S+ mm)/, "osa $1 stojí na $2"],
        [/(\d) at (?=\S+ mm)/g, "$1 na "],
        [/^axis (\d): /, "osa $1: "],
        [
            /another master gave (.+?) the permission again, so the measure was ended there/,
            "jiný master dal znovu povolení ($1), proto tam byla míra ukončena",
        ],
        [/\(all axes\)/, "(všechny osy)"],
        [/\(ax[ie]s ([\d, ]+)\)/, "(osy $1)"],
        [/^written: (.+); not stored yet$/, "zapsáno: $1; zatím neuloženo"],
        [/^all of them were so$/, "všechna už taková byla"],
        [/^all settings were read$/, "všechna nastavení jsou načtena"],
        [/^all settings are stored$/, "všechna nastavení jsou uložena"],
        [/^the delivered settings are in force; not stored yet$/, "platí nastavení od výrobce; zatím neuloženo"],
    ],
};

/** What the table of registers says of a setting, by its name, and units. */
const SETTINGS: Words = {
    cs: {
        steps: "kroky",
        WATCHDOG: "po takové době bez rámce pro jednotku zasáhne; 0: nikdy",
        RATE: "platí od příštího startu",
        FORMAT: "platí od příštího startu",
        STEPS: "na dráze MICROMETRES",
        MICROMETRES: "STEPS / MICROMETRES je 1/10000 až 500",
        INVERT: "1: DIR je obrácen",
        HIGHEST_ACCEL: "větší platí jako toto",
        HIGHEST_FEED: "větší platí jako toto",
        START_FEED: "od ní začínají rampy",
        ERROR_ACCEL: "brzdění po poruše; 0: jako u míry",
        SOFT_MIN: "dolní mez; platí, je-li pod SOFT_MAX",
        SOFT_MAX: "horní mez",
        LIMIT_MINUS: "vstup: 0 žádný, n BIn aktivní v 1, -n BIn aktivní v 0",
        LIMIT_PLUS: "stejně",
        REFERENCE: "stejně",
        CAPTURE: "stejně",
        HOME_FEED: "ke spínači",
        HOME_SLOW: "od spínače",
        HOME_WAY: "na jejím konci už musí být spínač nalezen",
    },
};

/** In the language of the page; null: as it is said outside. */
export const troubleWords = (kind = ""): string | null => TROUBLES[language.value]?.[kind] ?? null;

/** What has come of an order; what is not known here stays as it is said outside. */
export const answerWords = (text: string): string =>
    (ANSWERS[language.value] ?? []).reduce((told, [pattern, words]) => told.replace(pattern, words), text);

export const settingWords = (name: string, otherwise: string): string => SETTINGS[language.value]?.[name] ?? otherwise;

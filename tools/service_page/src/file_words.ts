/**
 * What services say of files, in other languages than English: G-code, machine files, settings. It becomes a file of
 * its own (/static/file_words.js), which pages load when they need it (common/files.ts). Pure.
 */
import { translatorOf, type Sentences } from "./common/patterns";
import { VECTORS_CS } from "./gve134/vector_words";
import type { Language } from "./language";

/** What is no word of G-code. */
const LETTERS: Sentences = [
    ["the line is longer than $1 characters; is this G-code?", "řádek má více než $1 znaků; je to G-kód?"],
    [
        "subprograms, loops and branches (o... sub, call, while, if) are LinuxCNC's and not known here; "
        + "let the CAM program write them out, as it does for grbl",
        "podprogramy, cykly a větvení (o... sub, call, while, if) jsou z LinuxCNC a zde nejsou známé; "
        + "ať je CAM rozepíše, jako to dělá pro grbl",
    ],
    ["let the CAM program write grbl's G-code", "ať CAM zapíše G-kód pro grbl"],
    ["this is a vector file; name it .gve", "toto je soubor vektorů; pojmenujte jej .gve"],
    ["this is Heidenhain's dialect", "toto je dialekt Heidenhain"],
    [
        "conditions, loops and jumps are not known here; let the CAM program write them out",
        "podmínky, cykly a skoky zde nejsou známé; ať je CAM rozepíše",
    ],
    ["calls with parameters are Siemens' dialect", "volání s parametry patří do dialektu Siemens"],
    ["named commands are Klipper's, a 3D printer's", "pojmenované příkazy patří firmwaru Klipper pro 3D tiskárny"],
    ["this is HPGL, a plotter's language", "toto je HPGL, jazyk plotrů"],
    [
        "M117 and M118 show texts of 3D printers; remove them",
        "M117 a M118 zobrazují texty na 3D tiskárnách; odstraňte je",
    ],
    [
        "this is XML or HTML, as SVG is; let a CAM program make G-code of it",
        "toto je XML nebo HTML, jako třeba SVG; ať z něj CAM udělá G-kód",
    ],
    ["parameters (#) are not known here; write numbers", "parametry (#) zde nejsou známé; pište čísla"],
    ["expressions ([ ]) are not known here; write numbers", "výrazy ([ ]) zde nejsou známé; pište čísla"],
    ["numbers have a point, no comma", "čísla se píší s tečkou, ne s čárkou"],
    ["assignments (=) are of another dialect; write numbers", "přiřazení (=) patří do jiného dialektu; pište čísla"],
    [
        "blocks that may be skipped (/) are not known here; remove the / or the line",
        "vynechatelné bloky (/) zde nejsou známé; odstraňte / nebo celý řádek",
    ],
    ["checksums (*) are of 3D printers; remove them", "kontrolní součty (*) patří 3D tiskárnám; odstraňte je"],
    ["commands of a controller ($) do not belong in a program", "příkazy řídicí jednotky ($) do programu nepatří"],
    ["% stands alone in its line", "% stojí na řádku samo"],
    ["a comment that does not end; write )", "poznámka bez konce; napište )"],
    ["a ) without its (", "chybí ( k této )"],
    ["labels (:) are of another dialect", "návěští (:) patří do jiného dialektu"],
    ["texts in quotes are of another dialect", "texty v uvozovkách patří do jiného dialektu"],
    ["$1 without a number, found $2", "$1 bez čísla, zde je $2"],
    ["a number without a letter: $1", "číslo bez písmene: $1"],
    ["no word of G-code: $1", "není to slovo G-kódu: $1"],
];

/** Words of a block. */
const BLOCKS: Sentences = [
    [
        "compensation of the cutter's radius is not known; let the CAM program compensate",
        "korekce poloměru nástroje není známa; ať ji započítá CAM",
    ],
    [
        "tool lengths are not known; set Z with G92 after a tool change",
        "délky nástrojů nejsou známé; po výměně nástroje nastavte Z pomocí G92",
    ],
    ["G10 is not known; set positions with G92", "G10 není známo; polohy nastavte pomocí G92"],
    ["machine positions are not known; use G28 and G92", "polohy stroje nejsou známé; použijte G28 a G92"],
    ["one coordinate system is known; set it with G92", "známa je jedna souřadná soustava; nastavte ji pomocí G92"],
    [
        "exact stops are not known; corners are slowed by the machine file's jumps",
        "přesné zastavení není známo; rohy zpomalují skoky rychlosti ze souboru stroje",
    ],
    [
        "splines are not known; let the CAM program write lines and arcs",
        "spliny nejsou známé; ať CAM zapíše přímky a oblouky",
    ],
    ["G29 is of 3D printers", "G29 patří 3D tiskárnám"],
    ["of the probing motions G38.2 is known", "z měřicích pohybů je známo G38.2"],
    [
        "centres of arcs (I, J, K) count from the start of the arc (G91.1)",
        "středy oblouků (I, J, K) se počítají od začátku oblouku (G91.1)",
    ],
    [
        "threads are not known: the spindle does not tell its angle",
        "závity nejsou známé: vřeteno nehlásí své natočení",
    ],
    [
        "the spindle's speed is in turns a minute, feeds in mm a minute (G94)",
        "otáčky vřetena se zadávají za minutu, posuvy v mm za minutu (G94)",
    ],
    [
        "canned cycles are not known; let the CAM program write single moves",
        "pevné cykly nejsou známé; ať CAM zapíše jednotlivé pohyby",
    ],
    ["E is of 3D printers, and no exponent of a number", "E patří 3D tiskárnám a není to exponent čísla"],
    [
        "programs with numbers and subprograms (O) are not known; let one file be one program",
        "čísla programů a podprogramy (O) nejsou známé; jeden soubor ať je jeden program",
    ],
    [
        "tool lengths (H) are not known; set Z with G92 after a tool change",
        "délky nástrojů (H) nejsou známé; po výměně nástroje nastavte Z pomocí G92",
    ],
    ["compensation of the cutter's radius (D) is not known", "korekce poloměru nástroje (D) není známa"],
    ["repeats (L) are not known", "opakování (L) nejsou známá"],
    ["Q is of canned cycles, which are not known", "Q patří k pevným cyklům, které nejsou známé"],
    ["a line's number stands at its beginning", "číslo řádku patří na jeho začátek"],
    ["a line's number has no sign", "číslo řádku nemá znaménko"],
    ["$1 stands twice in the line", "$1 je v řádku dvakrát"],
    ["$1 takes numbers up to $2", "$1 smí mít číslo nejvýše $2"],
    ["the line has another G of its group ($1)", "v řádku už je jiné G téže skupiny ($1)"],
    ["the line has another M of its group ($1)", "v řádku už je jiné M téže skupiny ($1)"],
    ["motion", "pohyb"],
    ["what is done once", "jednorázové"],
    ["plane", "rovina"],
    ["units", "jednotky"],
    ["distance", "odměřování"],
    ["feed mode", "druh posuvu"],
    ["cutter", "poloměr nástroje"],
    ["tool length", "délka nástroje"],
    ["system", "souřadná soustava"],
    ["path", "dráha"],
    ["centres", "středy"],
    ["stop", "zastavení"],
    ["spindle", "vřeteno"],
    ["tool", "nástroj"],
    ["mist", "ofuk"],
    ["flood", "chlazení"],
    ["cooling off", "vypnutí chlazení"],
    ["M0 to M9 and M30 are", "známé jsou M0 až M9 a M30"],
    ["M codes from 82 on are of 3D printers", "kódy M od 82 patří 3D tiskárnám"],
    ["subprograms are not: let the CAM program write them out", "podprogramy známé nejsou: ať je CAM rozepíše"],
    ["$1 is not known", "$1 není známo"],
];

/** What a block asks for and cannot be done. */
const ACTS: Sentences = [
    ["a feed is more than 0", "posuv musí být větší než 0"],
    ["the motion has no feed yet; write F", "pohyb zatím nemá posuv; napište F"],
    ["the motion has no feed of its own in G93; write F", "pohyb v G93 nemá vlastní posuv; napište F"],
    [
        "the motion has no feed since $1, with which that from before does not hold; write F",
        "pohyb nemá posuv od $1, kterým přestal platit dřívější; napište F",
    ],
    ["$1 is above the highest feed, $2 degrees/min", "$1 je nad nejvyšším posuvem, $2 °/min"],
    ["$1 is above the highest feed, $2 inch/min", "$1 je nad nejvyšším posuvem, $2 palců/min"],
    ["$1 is above the highest feed, $2 mm/min", "$1 je nad nejvyšším posuvem, $2 mm/min"],
    ["the machine has no axis $1", "stroj nemá osu $1"],
    ["G38.2 takes the position to which the probe may go", "G38.2 potřebuje polohu, kam až smí sonda jet"],
    ["no motion is in force; write G0, G1, G2 or G3", "neplatí žádný pohyb; napište G0, G1, G2 nebo G3"],
    ["G92 takes the positions that axes are to have", "G92 potřebuje polohy, které mají osy mít"],
    ["the machine file tells of no reference run", "v souboru stroje není žádná referenční jízda"],
    ["the machine file has no reference run of $1", "v souboru stroje není referenční jízda osy $1"],
    [
        "where $1 is after G38.2 is known when it runs only; tell it with G92, or move by G91",
        "kde je po G38.2 osa $1, bude známo až za běhu; nastavte to pomocí G92, nebo jeďte v G91",
    ],
    ["$1 is not in the plane of the arc, $2", "$1 není v rovině oblouku, $2"],
    ["the arc has both R and a centre; keep one of them", "oblouk má R i střed; ponechte jedno z toho"],
    ["the arc has no centre; write $1 and $2, or R", "oblouk nemá střed; napište $1 a $2, nebo R"],
    ["the machine file tells of no probe", "v souboru stroje není žádná sonda"],
    ["G38.2 takes a feed of G94", "G38.2 potřebuje posuv podle G94"],
    ["G38.2: the way is shorter than a pulse", "G38.2: dráha je kratší než puls"],
    [
        "the arc has no radius: its centre is its start or its end",
        "oblouk nemá poloměr: střed je v jeho začátku nebo konci",
    ],
    [
        "the arc does not close: its start is $1 mm from the centre, its end $2 mm",
        "oblouk se neuzavírá: začátek je od středu $1 mm, konec $2 mm",
    ],
    [
        "the arc does not close: R$1 mm does not reach the end, $2 mm away",
        "oblouk se neuzavírá: R$1 mm nedosáhne na konec vzdálený $2 mm",
    ],
    [
        "an arc with R must end elsewhere than it starts; write a circle with I, J, K",
        "oblouk s R musí končit jinde, než začíná; kružnici napište s I, J, K",
    ],
    ["the way is longer than $1 pulses of an axis; divide it", "dráha osy je delší než $1 pulsů; rozdělte ji"],
    [
        "the feed is too low: the unit makes $1 pulses/s at least",
        "posuv je příliš malý: jednotka umí nejméně $1 pulsů/s",
    ],
    ["$1 would go to $2, beyond its lowest position, $3 degree", "$1 by jela na $2, za svou nejnižší polohu, $3°"],
    ["$1 would go to $2, beyond its highest position, $3 degree", "$1 by jela na $2, za svou nejvyšší polohu, $3°"],
    ["$1 would go to $2, beyond its lowest position, $3", "$1 by jela na $2, za svou nejnižší polohu, $3"],
    ["$1 would go to $2, beyond its highest position, $3", "$1 by jela na $2, za svou nejvyšší polohu, $3"],
    ["the spindle turns with 0 to $1 turns a minute", "vřeteno má 0 až $1 ot/min"],
    ["T takes the number of a tool, a whole one", "T potřebuje číslo nástroje, celé"],
    [
        "M4: by the machine file the spindle turns one way only",
        "M4: podle souboru stroje se vřeteno točí jen jedním směrem",
    ],
    ["the spindle has no speed yet; write S", "vřeteno zatím nemá otáčky; napište S"],
    ["M6: no tool has been chosen; write T", "M6: není zvolen nástroj; napište T"],
    ["M9 stands beside M7 or M8; keep one of them", "M9 stojí vedle M7 nebo M8; ponechte jedno z nich"],
    ["the machine file tells of no spindle", "v souboru stroje není žádné vřeteno"],
    [
        "G64 takes no tolerance (P) here: the path is kept exactly, and corners are slowed by the machine file's "
        + "jumps; write G64 alone",
        "G64 zde nemá toleranci (P): dráha se dodrží přesně a rohy zpomalují skoky rychlosti ze souboru stroje; "
        + "napište samotné G64",
    ],
    [
        "the line has two G that take its positions; divide it",
        "v řádku jsou dvě G, která berou jeho polohy; rozdělte jej",
    ],
    ["G4 takes how long to dwell: P, in seconds", "G4 potřebuje dobu prodlevy: P, v sekundách"],
    ["$1 has no meaning in this line", "$1 nemá v tomto řádku význam"],
    ["$1 is a dwell of $2 s; P is in seconds here", "$1 je prodleva $2 s; P je zde v sekundách"],
    [
        "the program ends without M2 or M30: the spindle stays on",
        "program končí bez M2 nebo M30: vřeteno zůstane zapnuté",
    ],
    [
        "the spindle is off since the tool was changed (M6); write M3 after it",
        "vřeteno je od výměny nástroje (M6) vypnuté; napište po ní M3",
    ],
    ["there is no G-code in this file", "v souboru není žádný G-kód"],
    [
        "all moves of this program are shorter than a pulse, so nothing moves; look at steps_per_mm and steps_per_degree of the "
            + "machine file",
        "všechny pohyby programu jsou kratší než jeden puls, takže se nic nepohne; podívejte se na steps_per_mm a "
            + "steps_per_degree v souboru stroje",
    ],
    ["what follows the end of the program is left out", "co je za koncem programu, se vynechá"],
    [
        "vectors go slower than F, at an axis' limit; there are $1, the first one here",
        "vektory jedou pomaleji než F, na mezi některé osy; je jich $1, první zde",
    ],
    [
        "vectors of arcs go slower than F, "
        + "so that the acceleration keeps them on their arc; there are $1, the first one here",
        "vektory oblouků jedou pomaleji než F, aby je zrychlení udrželo na oblouku; je jich $1, první zde",
    ],
];

/** A file as a whole. */
const FILES: Sentences = [
    ["this is UTF-16; save it as UTF-8 or ANSI", "toto je UTF-16; uložte jej jako UTF-8 nebo ANSI"],
    [
        "this is UTF-16 without a mark; save it as UTF-8 or ANSI",
        "toto je UTF-16 bez značky; uložte jej jako UTF-8 nebo ANSI",
    ],
    ["is not a text file; name $1", "není to textový soubor; zvolte $1"],
    ["a vector file (.gve)", "soubor vektorů (.gve)"],
    ["a program of G-code (.nc)", "program v G-kódu (.nc)"],
    ["a command at a time (@) is for gve134 sim", "příkaz v daném čase (@) je pro gve134 sim"],
    ["nothing was sent", "nic nebylo odesláno"],
    [
        "for which machine? open its machine file (.rkm) first",
        "pro který stroj? nejdříve otevřete jeho soubor stroje (.rkm)",
    ],
    ["more than $1 bytes; that is no program", "více než $1 bajtů; to není program"],
    [
        "the file has no name, or one of more than $1 characters",
        "soubor nemá jméno, nebo má delší než $1 znaků",
    ],
    ["there is no such example; reload the page", "takový příklad není; načtěte stránku znovu"],
    ["another file was opened meanwhile; look at that", "mezitím byl otevřen jiný soubor; podívejte se na něj"],
    [
        "no machine file is open; open one (.rkm) first",
        "žádný soubor stroje není otevřen; nejdříve jej otevřete (.rkm)",
    ],
    ["$1 is not done; go on with it, or halt and delete it", "$1 neskončilo; pokračujte, nebo zastavte a smažte"],
    ["cannot be read ($1); is the clone whole?", "nelze číst ($1); je kopie projektu úplná?"],
];

/** A machine file. */
const MACHINES: Sentences = [
    ["is not UTF-8, so it is not a machine file", "není to UTF-8, takže to není soubor stroje"],
    ["is not JSON ($1); was it cut off?", "není to JSON ($1); není soubor useknutý?"],
    ["expecting value", "chybí hodnota"],
    ["expecting property name enclosed in double quotes", "chybí název v uvozovkách"],
    ["expecting ':' delimiter", "chybí dvojtečka"],
    ["expecting ',' delimiter", "chybí čárka"],
    ["unterminated string starting at", "text nemá konec"],
    ["invalid control character at", "v textu je řídicí znak"],
    ["invalid \\escape", "za \\ je nesprávný znak"],
    ["invalid \\uXXXX escape", "za \\u nejsou čtyři šestnáctkové číslice"],
    ["extra data", "za koncem ještě něco je"],
    ["illegal trailing comma before end of $1", "před koncem je čárka navíc"],
    ["is not a machine file: it lacks $1", "není to soubor stroje: chybí $1"],
    ["is not a machine file: it is nested too deep", "není to soubor stroje: je příliš vnořený"],
    ["is not a machine file: a text has half a character", "není to soubor stroje: v textu je půl znaku"],
    ["is not a machine file: a number has too many digits", "není to soubor stroje: číslo má příliš mnoho číslic"],
    ["is not a machine file: $1 stands there twice", "není to soubor stroje: $1 je tam dvakrát"],
    ["is not a machine file: $1 is no number", "není to soubor stroje: $1 není číslo"],
    [
        "was written by later tools (format $1, and these know $2)",
        "zapsaly jej novější nástroje (formát $1, tyto znají $2)",
    ],
    ["take the later tools", "použijte novější nástroje"],
    ["nothing was changed", "nic se nezměnilo"],
    ["and $1 more", "a ještě $1"],
    ["lacks \"gve134\", the part for this unit", "chybí \"gve134\", část pro tuto jednotku"],
    ["tools/examples/gve/mill.rkm shows one", "jednu ukazuje tools/examples/gve/mill.rkm"],
    ["$1 is axis $2 and needs $3", "$1 je osa $2 a potřebuje $3"],
    ["lacks $1", "chybí $1"],
    ["must be $1, found $2", "má být $1, zde je $2"],
    ["must be a list of $1, one for each motor", "má být seznam o délce $1, jeden pro každý motor"],
    ["found $1", "zde je $1"],
    ["a text", "text"],
    ["a whole number", "celé číslo"],
    ["a number", "číslo"],
    ["an object { }", "objekt { }"],
    ["a list [ ]", "seznam [ ]"],
    ["true or false", "true nebo false"],
    ["nothing is known of $1", "není známo $1"],
    ["did you mean $1?", "nemělo to být $1?"],
    ["$1 is too small; $2 is the least", "$1 je příliš málo; nejméně $2"],
    ["$1 is too large; $2 is the most", "$1 je příliš mnoho; nejvýše $2"],
    ["$1 must be more than $2", "$1 musí být více než $2"],
    ["must not be empty", "nesmí být prázdné"],
    ["has $1 characters; $2 are the most", "má znaků $1; nejvýše $2"],
    ["has both $1 and $2; keep one", "má $1 i $2; ponechte jedno"],
    ["position_min_steps $1 is above position_max_steps $2", "position_min_steps $1 je nad position_max_steps $2"],
    ["way_steps 0 leads to no switch", "way_steps 0 nevede k žádnému spínači"],
    ["$1 is above speed_max_steps_per_s $2 of motor $3, limits", "$1 je nad speed_max_steps_per_s $2 motoru $3, limits"],
    ["$1 is above speed_steps_per_s $2 of axis $3", "$1 je nad speed_steps_per_s $2 osy $3"],
];

/** A file of settings of a positioning unit. */
const SETTINGS: Sentences = [
    ["$1 is there twice", "$1 je tam dvakrát"],
    ["it is no JSON", "není to JSON"],
    ["it is of another kind", "je jiného druhu"],
    ["it is of another version of the unit or of this tool", "je jiné verze jednotky nebo tohoto nástroje"],
    ["it must have $1", "musí mít $1"],
    ["$1 does not have just its settings", "$1 nemá právě svá nastavení"],
    ["$1 of $2 has no value of its range", "$1 v $2 nemá hodnotu ze svého rozsahu"],
    ["nothing was written", "nic se nezapsalo"],
    ["settings backup makes such a file", "takový soubor vytvoří settings backup"],
];

const TRANSLATORS: Partial<Record<Language, (text: string) => string>> = {
    cs: translatorOf([...VECTORS_CS, ...FILES, ...MACHINES, ...SETTINGS, ...LETTERS, ...ACTS, ...BLOCKS]),
};

/** What is not known stays as it is said. */
export const wordsOf = (text: string, language: Language): string => TRANSLATORS[language]?.(text) ?? text;

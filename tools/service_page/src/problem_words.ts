import { language } from "./i18n";

/** What the parser says, piece by piece; the first whole pattern that fits is used, with $1 … filled in. */
const CZECH: readonly (readonly [pattern: RegExp, words: string])[] = [
    [/^unknown command (.+?)(; .*)?$/, "neznámý příkaz $1$2"],
    [
        /^the comment that begins here has no end; close it with }$/,
        "komentář, který zde začíná, nemá konec; uzavřete jej }",
    ],
    [/^there is no command in this file$/, "v programu není žádný příkaz"],
    [/^label (\d+) is defined again; only its last place counts$/, "návěští $1 je zde znovu; platí jen poslední"],
    [/^there is no label (\d+) \(@\d+\) in this file$/, "v programu není návěští $1 (@$1)"],
    [/^this loop is nested too deeply; at most (\d+) can be open$/, "příliš vnořená smyčka; nejvýše $1"],
    [/^E without an L before it$/, "E bez předchozího L"],
    [/^(\S+) without an E after it$/, "$1 bez následujícího E"],
    [/^calls can become more than (\d+) deep here$/, "volání zde může být hlubší než $1"],
    [/^(.+) is never reached$/, "$1 se nikdy neprovede"],
    [/^(\S+) is below (\S+); the move runs at (\S+) throughout$/, "$1 je pod $2; celý pohyb poběží rychlostí $3"],
    [/^(R|Y) before any F or B( does nothing)?.*$/, "$1 před prvním F nebo B nic neudělá"],
    [
        /^(\S+) inside a program is ignored; it must be sent alone$/,
        "$1 uvnitř programu se nevykoná; musí se poslat samotný",
    ],
    [/^a compound move has at most (\d+) sections$/, "složený pohyb má nejvýše $1 úseků"],
    [/^(.+?) takes (.+), (found .+)$/, "$1: $2, $3"],
];

/** Parts that stand inside of longer sentences. */
const CZECH_PARTS: readonly (readonly [pattern: RegExp, words: string])[] = [
    [/; this number belongs to no command/, "; toto číslo nepatří k žádnému příkazu"],
    [/; commands are upper case: /, "; příkazy se píší velkými písmeny: "],
    [/; no comment is open here/, "; zde není otevřený komentář"],
    [/; a subroutine is called with '/, "; podprogram se volá znakem '"],
    [
        /the number of an input .* from (\d+) to (\d+), as in (\w+)/,
        "čeká se číslo vstupu (1 až 8) nebo proměnné (80 až 95), H nebo L a návěští od $1 do $2, jako $3",
    ],
    [/a number from (-?\d+) to (-?\d+)/, "čeká se číslo od $1 do $2"],
    [
        /found a blank; nothing may stand between a command and its number/,
        "zde je mezera; mezi příkazem a číslem nesmí nic být",
    ],
    [/found the end of the file/, "zde je konec programu"],
    [/found no number/, "zde není číslo"],
    [/found (\S+)$/, "zde je $1"],
    [/acceleration/, "zrychlení"],
    [/start\/stop speed/, "Start/Stop rychlost"],
    [/maximum speed/, "maximální rychlost"],
    [/steps backward/, "počet kroků vzad"],
    [/steps forward/, "počet kroků vpřed"],
    [/wait for milliseconds/, "prodleva v ms"],
    [/start of a loop/, "počátek smyčky"],
    [/call a subroutine/, "volání podprogramu"],
    [/jump to a label/, "skok na návěští"],
    [/\(label\)/, "(návěští)"],
    [/write the position/, "zápis polohy"],
];

/** A remark of the parser in the language of the page; what is not known stays in English. */
export function translateProblem(message: string): string {
    if (language.value !== "cs") {
        return message;
    }
    const found = CZECH.find(([pattern]) => pattern.test(message));
    if (found === undefined) {
        return message;
    }
    const whole = message.replace(found[0], (_all, ...groups: (string | undefined)[]) =>
        found[1].replace(/\$(\d)/g, (_place, digit: string) => String(groups[Number(digit) - 1] ?? "")),
    );
    return CZECH_PARTS.reduce((text, [pattern, words]) => text.replace(pattern, words), whole);
}

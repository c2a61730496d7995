/** What the unit's parser says of vector files, in Czech. */
import type { Sentences } from "../common/patterns";

export const VECTORS_CS: Sentences = [
    ["$1 has no command that begins like this", "$1 nemá příkaz, který takto začíná"],
    ["the interpolator", "interpolátor"],
    ["the spindle", "vřeteno"],
    ["to the spindle write $1", "pro vřeteno pište $1"],
    ["$1 takes at most $2 parameter$3; example: $4", "$1: počet parametrů je nejvýše $2; příklad: $4"],
    ["$1 takes $2 parameter$3; example: $4", "$1: počet parametrů je $2; příklad: $4"],
    ["$1 takes $2 as parameter $3, found nothing", "$1: parametr $3 má být $2, zde není nic"],
    ["$1 takes $2 as parameter $3, found $4", "$1: parametr $3 má být $2, zde je $4"],
    ["a number from $1 to $2 that is not 0", "číslo od $1 do $2, ale ne 0"],
    ["a number from $1 to $2", "číslo od $1 do $2"],
    ["a number up to $1", "číslo do $1"],
    ["one or two hexadecimal digits, 00 to $1", "jedna nebo dvě šestnáctkové číslice, 00 až $1"],
    ["one to eight hexadecimal digits, 00 to $1", "jedna až osm šestnáctkových číslic, 00 až $1"],
    ["an axis: X, Y, Z or A", "osa: X, Y, Z nebo A"],
    ["*E without the *S that begins a packet", "*E bez *S, kterým paket začíná"],
    ["the packet has $1 commands, more than $2", "příkazů v paketu: $1, více než $2"],
    ["the packet has $1 commands, *E says $2", "příkazů v paketu: $1, ale *E uvádí $2"],
    ["the packet that begins here has no *E", "paket, který zde začíná, nemá *E"],
    ["$1 cannot stand in a packet, only C and B can", "$1 nesmí být v paketu, jen C a B"],
    ["the command has $1 characters, more than $2", "příkaz má znaků $1, více než $2"],
    [";@probe stands right after the L that goes to the sensor", ";@probe patří hned za L, které jede ke snímači"],
    [
        "the time has more than 6 decimals, none after its point, or is past 31 years",
        "čas má více než 6 desetinných míst, za tečkou žádné, nebo je za 31 lety",
    ],
    ["after @ and a time in ms come a blank and a command", "za @ a časem v ms patří mezera a příkaz"],
    [
        "after ! comes the address of the interpolator, 0, or of the spindle, 7",
        "za ! patří adresa interpolátoru, 0, nebo vřetena, 7",
    ],
    [
        "for the host there are ;@wait with seconds, ;@pause with a text, and ;@probe",
        "pro počítač je ;@wait se sekundami, ;@pause s textem a ;@probe",
    ],
    [
        "line $1: a command at a time (@) is for tools/gve134 sim",
        "řádek $1: příkaz v daném čase (@) je pro tools/gve134 sim",
    ],
];

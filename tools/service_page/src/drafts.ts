import { newForm, type FileForm } from "./file_form";
import { t, type Key } from "./i18n";
import { MOTORS } from "./protocol";
import { keep, recall } from "./storage";

/** Commands and what is said of them at the first visit. */
const FIRST_PROGRAM: readonly (readonly [commands: string, words: Key])[] = [
    ["\\ C100", "first.zero"],
    ["S100 V600 A2000", "first.settings"],
    ["F1000 R", "first.forward"],
    ["L3", "first.loop"],
    ["    F500 R W200", "first.there"],
    ["    D R W1000", "first.back"],
    ["E", "first.end"],
    ["B1000 R", "first.home"],
];
const COMMANDS_WIDTH = 20;

const firstProgram = (): string =>
    FIRST_PROGRAM.map(([commands, words]) => `${commands.padEnd(COMMANDS_WIDTH)}{ ${t(words)} }\n`).join("");

export interface Draft extends FileForm {
    text: string;
}

/** What a program is saved as that comes from no file. */
export const motorForm = (motor: number): FileForm => newForm(`motor${motor}.rks`);

/** The four programs as they were left; at the first visit, one that shows how programs look. */
export function recallDrafts(): Draft[] {
    const kept = recall<Partial<Draft>[]>("drafts", []);
    return MOTORS.map((motor, index) => {
        const otherwise = index === 0 ? firstProgram() : "";
        return { text: otherwise, ...motorForm(motor), ...kept[index] };
    });
}

export const keepDrafts = (drafts: Draft[]): void => keep("drafts", drafts);

import { Refusal } from "../../unit_place";
import { DONE, NOTHING_TO_GO_ON, NOT_WHILE_MOVING, answerText, answerWords, canonical } from "./answers";
import { Refused, type UnitLink } from "./link";
import { FAULT, INTA, NO_CRYSTAL, RUN, flagsText, positionsText } from "./told";

const QUESTION = /^(\?|Q|P[F4L]?|SR\d|F|I[12]|E[UF]?R[0-9A-F]{1,2})$/;
/** What the line does itself, and what has buttons of its own. */
const NOT_TYPED = /^([@>%*].*|H|W.*)$/;
/** What moves axes, or takes away what a job goes on with. */
const CUTS_IN = /^([LCGDNRK].*|(!7)?J|SW0*6.*)$/;
/** One command, of the interpolator or the spindle. */
const COMMAND = /^(!7)?[\x22-\x7e][\x20\x22-\x7e]*$/;
const TYPED_MAX = 76;

const plain = (text: string): string => canonical(text.trim().replace(/^!0/, ""));

/** Whether a command only asks. */
export const onlyAsks = (text: string): boolean => QUESTION.test(plain(text));

/** Whether a command would change what a job that was stopped goes on with. */
export const cutsIn = (text: string): boolean => CUTS_IN.test(plain(text));

/** A command as the console has it. */
export async function type(link: UnitLink, text: string): Promise<string> {
    const command = plain(text);
    if (NOT_TYPED.test(command)) {
        throw new Refusal(`${command}: the page has a button for it, or the line does it by itself`, "");
    }
    if (!COMMAND.test(command) || command.length > TYPED_MAX) {
        throw new Refusal(`${command}: that is no command of the unit`, "write one as in vector files, such as V1000");
    }
    const answer = await link.execute(command);
    if (answer.code !== DONE) {
        throw new Refused(command, answer);
    }
    return `${command} → ${answerText(answer)}  ${answerWords(answer)}`;
}

/** Refuses to begin a motion where another one is under way or waits. */
export function requireFree(flags: number): void {
    if (flags & (NO_CRYSTAL | FAULT)) {
        throw new Refusal("nothing was moved", flagsText(flags));
    }
    if (flags & INTA) {
        throw new Refusal("nothing was moved: the unit was stopped", "go on or delete first");
    }
    if (flags & RUN) {
        throw new Refusal("nothing was moved: the axes move", "wait or halt them");
    }
}

/** Moves axes a little. */
export async function jog(link: UnitLink, parts: number[], speed: number): Promise<string> {
    requireFree(await link.flags());
    await link.order(`V${speed}`);
    await link.order(`L${parts.join()}`);
    return `the axes move by ${positionsText(parts)}`;
}

/** Lets what waits go on. `mayBeEmpty`: more comes from here. */
export async function go(link: UnitLink, mayBeEmpty: boolean): Promise<string> {
    const answer = await link.ask("G");
    const isEmpty = answer.code === NOTHING_TO_GO_ON;
    if (answer.code !== DONE && !(isEmpty && mayBeEmpty)) {
        throw new Refused(isEmpty ? "nothing waits to go on" : "G", answer);
    }
    return "the axes go on";
}

/** Deletes the queue, and what is told of the last stop. */
export async function deleteQueue(link: UnitLink): Promise<string> {
    const answer = await link.ask("D");
    if (answer.code === NOT_WHILE_MOVING) {
        throw new Refused("nothing was deleted", answer, "the axes move; halt comes first");
    }
    if (answer.code !== DONE) {
        throw new Refused("D", answer);
    }
    return `the queue is empty; the axes stand at ${positionsText(await link.positions())}`;
}

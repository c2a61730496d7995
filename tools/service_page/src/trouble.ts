import { told, troubleText as toldTrouble } from "./common/told";
import { translateProblem } from "./problem_words";
import type { Trouble } from "./protocol";

/** What the parser says of a program that was not sent, perhaps after its motor, and what to do. */
const WRONG = /^(motor \d: )?(.+?)((?:; nothing was sent to any motor)?; correct it, then send again)$/;

/** Cause and next step in the language of the page. */
export function troubleText(trouble: Trouble): string {
    const [, motor = "", problem, rest = ""] = WRONG.exec(`${trouble.cause}; ${trouble.next}`) ?? [];
    return problem === undefined ? toldTrouble(trouble) : `${motor}${translateProblem(problem)}; ${told(rest.slice(2))}`;
}

import { MOTORS } from "./protocol";
import { keep, recall } from "./storage";

const FIRST_PROGRAM = [
    "\\ C100              { here is position 0 }",
    "S100 V600 A2000     { start speed, speed, ramp }",
    "F1000 R             { 1000 steps forward }",
    "L3                  { three times: }",
    "    F500 R W200     { 500 forward, wait 200 ms }",
    "    D R W1000       { turn round, wait 1 s }",
    "E",
    "B1000 R             { back to where it began }",
    "",
].join("\n");

export interface Draft {
    text: string;
    /** Name of the file it came from or went to. */
    name: string;
}

/** The four programs as they were left; at the first visit, one that shows how programs look. */
export function recallDrafts(): Draft[] {
    const kept = recall<Draft[]>("drafts", []);
    return MOTORS.map((motor, index) => {
        const otherwise = index === 0 ? FIRST_PROGRAM : "";
        return kept[index] ?? { text: otherwise, name: `motor${motor}.rks` };
    });
}

export const keepDrafts = (drafts: Draft[]): void => keep("drafts", drafts);

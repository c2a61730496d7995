import { TEXT_MAX, type Checked, type Simulator } from "./simulator";
import { Refusal } from "./unit_place";

export const COMMANDS_MAX = 700;
export const RESET = "\\";
export const HOLD = "[";
export const RELEASE = "]";
/** What acts only alone in a message. */
const ALONE = ["K", "C75"];

/** A program without errors as it goes to a unit: in as many texts as it needs. */
export interface Plan {
    texts: string[];
    /** What is stored, without what the plan adds. */
    commands: number;
    /** These commands in canonical form, from the last reset on, which is not among them. */
    plain: string[];
    resets: boolean;
    /** The one command that acts only alone in a message, if it is that. */
    alone: string | null;
}

/** Checks a program and chooses its messages; more than one are held back by `[` until all of them have come. */
export function planned(simulator: Simulator, text: string, text_bytes_max: number): Plan {
    const { commands, stored } = checked(simulator, text);
    const all = commands.map((command) => command.text);
    const alone = all.length === 1 && ALONE.includes(all[0] ?? "") ? (all[0] ?? null) : null;
    const last = all.lastIndexOf(RESET);
    const resets = last >= 0;
    if (alone === null && !resets && stored === 0) {
        throw new Refusal("there is nothing in it to be sent", "write a command");
    }
    if (stored > COMMANDS_MAX) {
        const cause = `the program has ${stored} commands, and the memory holds ${COMMANDS_MAX}`;
        throw new Refusal(`${cause}; nothing was sent`, "make it shorter");
    }
    const plain = all.slice(last + 1);
    const whole = { texts: [], commands: stored, plain, resets, alone };
    const texts = packed([...begun(resets), ...plain], text_bytes_max);
    return texts.length === 1 ? { ...whole, texts } : heldBack(whole, text_bytes_max, RELEASE);
}

/** The same program after `[`, so that it runs when `]` comes: at its end, or later from somebody else. */
export function heldBack(plan: Plan, text_bytes_max: number, end = ""): Plan {
    if (plan.plain.includes(HOLD) || plan.plain.includes(RELEASE)) {
        throw new Refusal(
            "the program has [ or ] of its own, so it cannot be held back until all of it has come",
            "nothing was sent; make it shorter, send it without starting together, or take tools/rkm04 send",
        );
    }
    if (plan.plain.length + 2 > COMMANDS_MAX) {
        throw new Refusal(
            "the memory has no room for [ and ] beside the program",
            "nothing was sent; make it shorter, send it without starting together, or take tools/rkm04 send",
        );
    }
    const tokens = [...begun(plan.resets), HOLD, ...plan.plain, ...(end ? [end] : [])];
    return { ...plan, texts: packed(tokens, text_bytes_max) };
}

/** Whether a memory ends in a `[` that holds, as that of a program does whose end has not come. */
export function waitsForRelease(held: string[]): boolean {
    return held.filter((command) => command === HOLD || command === RELEASE).at(-1) === HOLD;
}

function begun(resets: boolean): string[] {
    return resets ? [RESET] : [];
}

/** Joins commands to as few texts as there can be. */
function packed(tokens: string[], bytes_max: number): string[] {
    const texts = [""];
    for (const token of tokens) {
        if ((texts.at(-1)?.length ?? 0) + token.length > bytes_max) {
            texts.push("");
        }
        texts[texts.length - 1] += token;
    }
    return texts;
}

function checked(simulator: Simulator, text: string): Checked {
    if (text.length > TEXT_MAX) {
        throw new Refusal("text is too long", `${TEXT_MAX} characters are the most`, { kind: "TooLarge" });
    }
    const found = simulator.read(text);
    const first = found.problems.find(({ severity }) => severity === "error");
    if (first) {
        const { line, column } = first;
        throw new Refusal(first.message, "correct it, then send again", { line, column });
    }
    return found;
}

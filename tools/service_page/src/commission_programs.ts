/*
 * The short programs of commissioning, as texts. What is wrong with one is for the firmware's parser to say.
 */

/** S, V and A of a program. */
export interface Settings {
    start: string;
    speed: string;
    ramp: string;
}

export interface Homing {
    /** The sign of the limit run. */
    run: "(" | ")";
    input: string;
    /** The speed at which the switch is looked for; it is a start speed. */
    speed: string;
    /** Steps from the switch to position 0. */
    away: string;
    /** Whether the switch is left and looked for again, slowly. */
    twice: boolean;
}

export const settingsOf = ({ start, speed, ramp }: Settings): string => `S${start} V${speed} A${ramp}`;

/** A move of so many steps, from a state in which nothing of a program is left. */
export function moveOf(settings: Settings, steps: number): string {
    return `\\${settingsOf(settings)} ${steps < 0 ? "B" : "F"}${Math.abs(steps)} R`;
}

/** A run that ends when it is stopped, or after so many steps; 0: it has no end. */
export function runOf(settings: Settings, direction: 1 | -1, steps_max: number): string {
    if (steps_max > 0) {
        return moveOf(settings, direction * steps_max);
    }
    return `\\${settingsOf(settings)} G${direction < 0 ? "-" : "+"}`;
}

/** The command that goes to a position; null: there is none for it. */
export function goTo(position: number): string | null {
    if (position === 0) {
        return "H";
    }
    return position > 0 ? `G${position}` : null;
}

const SLOWER = 10;

/** A search for a switch, after which position 0 is `away` steps from it; `words` are the comments. */
export function homingOf(
    { run, input, speed, away, twice }: Homing,
    { speed: fast, ramp }: Settings,
    words: Record<"speed" | "search" | "leave" | "again" | "here" | "zero", string>,
): string {
    const [sign, leave] = run === "(" ? ["-", "F"] : ["", "B"];
    const slow = Math.max(1, Math.round(Number(speed) / SLOWER));
    const rows: [string, string][] = [
        [`S${speed} V${fast} A${ramp}`, words.speed],
        [`${run}${input}`, words.search],
    ];
    if (twice) {
        rows.push([`${leave}${Number(away) || SLOWER} R`, words.leave], [`S${slow} ${run}${input}`, words.again]);
    }
    if (Number(away) === 0) {
        rows.push(["C100", words.zero]);
    } else {
        rows.push([`=${sign}${away}`, words.here], ["H", words.zero]);
    }
    return rows.map(([code, comment]) => `${code.padEnd(18)} { ${comment} }\n`).join("");
}

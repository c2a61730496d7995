/** What a unit tells of itself: its flags, and what has stopped it, in words. */

export type Positions = number[];

export const STOP = 1;
export const NO_CRYSTAL = 4;
export const FAULT = 8;
export const INTCOM = 16;
export const RUN = 64;
export const INTA = 128;
/** Inputs and interrupts by number: 0 to 7 are those of port 1, the others those of port 2. */
export const INTERRUPTS: readonly (readonly [number, string])[] = [
    [0, "RefX"], [1, "RefY"], [2, "RefZ"], [3, "RefA"], [14, "sensor button"], [15, "sensor plate"],
];

/** Whether no axis moves: a vector that waits after an interrupt does not. */
export const stands = (flags: number): boolean => (flags & INTA) !== 0 || (flags & RUN) === 0;

export function flagsText(flags: number): string {
    const has = (bit: number): boolean => (flags & bit) !== 0;
    if (has(NO_CRYSTAL)) {
        return "no motion: its crystal does not run";
    }
    if (has(FAULT)) {
        return "no motion: restarted by its watchdog or a fault (Delete clears it)";
    }
    if (!has(INTA)) {
        return has(RUN) ? (has(STOP) ? "braking" : "moving") : "at rest";
    }
    return has(RUN) ? "stopped, the rest of the vectors waits (Go on, or Delete)" : "stopped, nothing waits (Delete clears it)";
}

export const positionsText = (positions: Positions): string =>
    positions.map((at, axis) => `${"XYZA"[axis] ?? ""} ${at}`).join("  ");

/** The names of what has stopped the axes. */
export async function causesOf(link: { byte(command: string): Promise<number> }, flags: number): Promise<string[]> {
    const bits = (await link.byte("SR4")) | ((await link.byte("SR5")) << 8);
    const nameOf = (number: number): string => INTERRUPTS.find(([each]) => each === number)?.[1] ?? `INTR${number}`;
    const names = Array.from({ length: 16 }, (_, number) => number).filter((number) => (bits >> number) & 1).map(nameOf);
    return [...names, ...(flags & INTCOM ? ["H"] : [])];
}

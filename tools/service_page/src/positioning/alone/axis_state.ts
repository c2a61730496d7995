import { FAULTS, FEED_PER_MM_MIN, FLAG, UM_PER_MM, type AxisName } from "../protocol";
import { bits, readBlock, valueOf } from "./table";

/** Words of the unit by their numbers; the page that needs no service brings them along. */
export interface Names {
    errors: Record<number, string>;
    exceptions: Record<number, string>;
}

const BLOCK = readBlock("A");
const UNIT_BLOCK = readBlock("U");
export const AXIS_READ = { first: BLOCK.first, words: BLOCK.words };
export const UNIT_READ = { first: UNIT_BLOCK.first, words: UNIT_BLOCK.words };

/** What an axis tells at one moment: its registers that are only read, by their names in small letters. */
export type AxisValues = Record<
    | "status" | "error" | "done" | "result" | "flags" | "captures" | "speed" | "position_steps" | "captured_steps"
    | "position_um" | "way_left_um" | "captured_um",
    number
>;

export interface AxisState extends AxisValues {
    axis: number;
    state: AxisName;
}

const IN_UM: Record<string, keyof AxisValues> = { POSITION: "position_um", WAY_LEFT: "way_left_um", CAPTURED: "captured_um" };

export function axisState(axis: number, words: readonly number[]): AxisState {
    const named = BLOCK.rows.map((row) => [IN_UM[row.name] ?? row.name.toLowerCase(), valueOf(row, words, row.number - BLOCK.first)]);
    const values = Object.fromEntries(named) as AxisValues;
    return { axis, ...values, state: nameOf(values) };
}

/** What the unit tells of itself, by the names of its registers in small letters. */
export const unitState = (words: readonly number[]): Record<string, number> =>
    Object.fromEntries(UNIT_BLOCK.rows.map((row) => [row.name.toLowerCase(), valueOf(row, words, row.number - UNIT_BLOCK.first)]));

export const versionText = (version: number): string => `${version >> 8}.${String(version & 0xff).padStart(2, "0")}`;

type Status = Pick<AxisValues, "status" | "error">;

export const has = ({ status }: Pick<AxisValues, "status">, name: "JEDE" | "POL" | "DISP" | "PROG" | "ERR"): boolean => (status & bits[name]) !== 0;

/** Whether nothing moves before POS_INIT, because of an error. */
export const hasFault = ({ error }: Pick<AxisValues, "error">): boolean => FAULTS.includes(error);

/** The name that the documents give to what it does. */
export function nameOf(axis: Status): AxisName {
    if (!has(axis, "DISP")) {
        return "FREE";
    }
    if (hasFault(axis)) {
        return "FAULT";
    }
    if (!has(axis, "PROG")) {
        return "TAKEN";
    }
    return has(axis, "POL") ? "REACHED" : has(axis, "JEDE") ? "MOVING" : "READY";
}

export const mmText = (um: number): string => (um / UM_PER_MM).toFixed(3);

const ACTIVE: [number, string][] = [
    [FLAG.LIMIT_MINUS, "limit -"], [FLAG.LIMIT_PLUS, "limit +"], [FLAG.REFERENCE, "reference"], [FLAG.CAPTURE, "capture"],
];

export const errorText = (number: number, { errors }: Names): string => `error ${number}: ${errors[number] ?? "not one that this page knows"}`;

/** State and what else is to be known, in words. */
export function stateText(axis: AxisState, names: Names): string {
    const parts: string[] = [axis.state];
    const add = (isSo: boolean, words: string): void => void (isSo && parts.push(words));
    add(has(axis, "JEDE") && axis.state !== "MOVING", "brakes");
    add((axis.flags & bits.HOMING) !== 0, "homing");
    add((axis.flags & bits.ARMED) !== 0, "capture armed");
    ACTIVE.forEach(([bit, words]) => add((axis.flags & bit) !== 0, `${words} active`));
    add(has(axis, "ERR"), errorText(axis.error, names));
    return parts.join(", ");
}

/** An axis in one line. */
export function axisText(axis: AxisState, names: Names): string {
    const feed = Number((axis.speed / FEED_PER_MM_MIN).toFixed(3));
    const speed = has(axis, "JEDE") ? `, ${feed} mm/min` : "";
    return `axis ${axis.axis}: ${mmText(axis.position_um)} mm${speed}, ${stateText(axis, names)}`;
}

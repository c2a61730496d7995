/** What the page of a positioning unit and its service say to each other over the WebSocket. */
import type { CommonFromService, CommonState } from "../common/known";

export const AXES = [1, 2, 3, 4] as const;
export const INPUTS = [1, 2, 3, 4, 5, 6, 7, 8] as const;
export const FEED_PER_MM_MIN = 65_536;
export const UM_PER_MM = 1000;

/** Bits of STATUS, by the names of the documents. */
export const STATUS = { JEDE: 0x100, SMER: 0x200, POL: 0x800, DISP: 1, PROG: 2, ERR: 4 } as const;
export const FLAG = { REFERENCED: 1, LIMIT_MINUS: 2, LIMIT_PLUS: 4, REFERENCE: 8, CAPTURE: 16, ARMED: 32, HOMING: 64 } as const;
/** Bits of CONDITION. */
export const CONDITION = { crystal: 1, damaged: 2, notStored: 4 } as const;
export const FAULTS: readonly number[] = [7, 8, 10, 11];

export type Part = "unit" | "axis1" | "axis2" | "axis3" | "axis4";
export type Values = Partial<Record<Part, Record<string, number>>>;
export type Method = 19 | 21 | 37;

/** One of several types that need no more than this. */
type Plain<Type, More = object> = Type extends string ? { type: Type } & More : never;

export type ToService =
    | { type: "connect"; port: string; node: number }
    | Plain<"disconnect" | "ports">
    | Plain<"halt" | "seen" | "settings" | "store" | "deliver", { id: number }>
    | Plain<"hold" | "take" | "release" | "capture", { id: number; axis: number }>
    | { type: "control"; id: number; axis: number; feed?: number; permitted?: boolean }
    | { type: "measure"; id: number; axis: number; um: number; accel: number; absolute: boolean; feed?: number }
    | { type: "home"; id: number; axis: number; method: Method; um: number; accel: number; feed: number }
    | { type: "write"; id: number; values: Values }
    | { type: "input"; input: number; level: 0 | 1 };

export interface UnitState extends CommonState {
    node: number;
    /** Something that moves an axis was asked for and not answered. */
    doubt: boolean;
    /** The axes of which no stop is confirmed since one was asked for. */
    unheld: number[];
}

export type AxisName = "FREE" | "TAKEN" | "WAITING" | "READY" | "MOVING" | "REACHED" | "FAULT";

export interface AxisLive {
    axis: number;
    state: AxisName;
    status: number;
    flags: number;
    error: number;
    captures: number;
    position_um: number;
    way_left_um: number;
    /** In 1/65 536 mm/min, as `feed`. */
    speed: number;
    position_steps: number;
    captured_um: number;
    feed: number;
    permitted: boolean;
    /** Another master has given it an order within the last seconds. */
    by_other: boolean;
}

export interface Live {
    time_s: number;
    unit: Record<string, number> & { inputs: number[]; others: number | null };
    axes: AxisLive[];
}

/** A setting, as the table of registers has it. */
export interface Row {
    name: string;
    part: "unit" | "axis";
    form: string;
    least: number;
    most: number;
    delivered: number;
    unit: string;
    text: string;
}

/** All settings, and the file that keeps them; null: they are not known. */
export interface Settings {
    values: Record<Part, Record<string, number>> | null;
    file: string | null;
}

export type FromService =
    | CommonFromService
    | ({ type: "state" } & UnitState)
    | ({ type: "live" } & Live)
    | { type: "rows"; rows: Row[] }
    | ({ type: "settings" } & Settings);

/** What the page of a GVE134 and its service say to each other, over HTTP and over the WebSocket. */
import type { CommonFromService, CommonState } from "../common/known";
import type { Trouble } from "../protocol";
export type { Trouble };

export const AXES = ["X", "Y", "Z", "A"] as const;
/** Inputs in the order in which a look has them: numbers of the board, and names. */
export const INPUTS = [[1, "X"], [2, "Y"], [3, "Z"], [4, "A"], [7, "button"], [8, "plate"]] as const;
/** Bits of port 0, which are on at 0. */
export const OUTPUTS = ["spindle", "brake", "cooling", "blow", "lock", "release", "cover"] as const;

export const FLAG = { stop: 1, noCrystal: 4, fault: 8, full: 32, run: 64, inta: 128 } as const;

export type ToService =
    | { type: "connect"; port: string }
    | { type: "disconnect" | "ports" }
    | { type: "halt" | "go" | "delete" | "resume" | "seen"; id: number }
    | { type: "start"; id: number; file: number }
    | { type: "home"; id: number; axis: string | null }
    | { type: "jog"; id: number; parts: number[]; speed: number }
    | { type: "override"; id: number; percent: number }
    | { type: "output"; id: number; port: number }
    | { type: "spindle"; id: number; permille: number }
    | { type: "typed"; id: number; text: string }
    | { type: "input"; input: number; level: 0 | 1 };

export type Phase = "sending" | "finishing" | "waits" | "held" | "done" | "failed";

export interface Job {
    file: number;
    name: string;
    phase: Phase;
    /** What a person is asked to do. */
    text: string;
    trouble: Trouble | null;
    /** Where the axes stood at its beginning. */
    begin: number[];
}

export interface FileState {
    number: number;
    name: string;
    ok: boolean;
    errors: number;
    vectors: number;
    seconds: number | null;
    peaks: number[] | null;
    /** Of X, Y and Z the first vector from which on places are absolute; null: there is none. */
    absolute_from: (number | null)[] | null;
}

export interface MachineAxis {
    unit: "mm" | "degree";
    steps_per_unit: number;
    speed: number;
    lowest: number | null;
    highest: number | null;
    homes: boolean;
}

export interface Machine {
    name: string;
    axes: (MachineAxis | null)[];
    rpm: number | null;
}

export interface UnitState extends CommonState {
    /** A reference run, in which the unit tells nothing. */
    reference: boolean;
    known: { port: number | null; spindle: number | null; percent: number | null };
    /** The speed that is being brought about. */
    wanted: number | null;
    job: Job | null;
    file: FileState | null;
    machine: Machine | null;
}

export interface Progress {
    /** The vector that is executed; null: not known, and neither is what follows. */
    at: number | null;
    line: number | null;
    level: number | null;
    sent: number;
    left_s: number | null;
}

export interface Live {
    time_s: number;
    positions: number[];
    speeds: (number | null)[];
    flags: number;
    inputs: number[];
    causes: string[];
    late: number | null;
    /** For how long in all the time of the unit in the page has stood; a service does not tell it. */
    stood_s?: number;
    progress: Progress | null;
    made: number[][];
}

export type FromService =
    | CommonFromService
    | ({ type: "state" } & UnitState)
    | ({ type: "live" } & Live)
    | { type: "made"; places: number[][] };

export interface MachineText {
    name: string;
    text: string;
}

export interface Problem {
    severity: "error" | "warning";
    line: number;
    column: number;
    message: string;
}

export interface FileText {
    text: string;
    problems: Problem[];
    more: number;
}

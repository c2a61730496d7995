/** What the page and the service say to each other, over HTTP and over the WebSocket. */

export const MOTORS = [1, 2, 3, 4] as const;
/** Inputs, and outputs. */
export const LINES = [1, 2, 3, 4, 5, 6, 7, 8] as const;
export const ALL_MOTORS = 0;
/** What a page says to its worker when it comes or comes back; all else is an object. */
export const GREETING = "";

export type MessageName =
    | "version" | "send" | "store" | "position" | "program" | "table" | "progress"
    | "send_all" | "scan";

/** Why something did not happen, and what to do about it. `kind` is for translation. */
export interface Trouble {
    kind?: string;
    cause: string;
    next: string;
    motor?: number;
    line?: number;
    column?: number;
}

export type ToService =
    | { type: "connect"; port: string; node: number; rate?: number }
    | { type: "disconnect" }
    | { type: "ports" }
    | ({ type: "request"; id: number; message: MessageName; motor: number } & RequestParts)
    | { type: "stop"; id: number; nodes: Node[] }
    /** The user has dealt with them: no stop waits for them any more. */
    | { type: "forget"; nodes: Node[] }
    | { type: "resume" | "reset"; id: number }
    | { type: "speed"; id: number; motor: number; value: number }
    /** A button that makes a motor run is held; who falls silent meanwhile has all motors stopped. */
    | { type: "hold"; held: boolean }
    | { type: "input"; input: number; level: 0 | 1 };

export interface RequestParts {
    text?: string;
    /** To all units of the line (DNode 0), of which none answers. */
    everywhere?: boolean;
    /** Programs by motor, for all at once. */
    texts?: Record<string, string>;
    /** Whether they start on the same tick, or each as it arrives. */
    together?: boolean;
    /** Of a button that is held: its run, which is not sent after it was let go, or the K of letting go. */
    held?: true;
}

/** A unit: its address on a port. */
export interface Node {
    port: string;
    node: number;
}

export interface UnitState {
    connected: boolean;
    port: string | null;
    virtual: boolean;
    node: number;
    busy: string | null;
    error: Trouble | null;
    unit?: { version: string; date: string } | null;
    /** The port was lost, and is opened again when it is there. */
    away: boolean;
    /** Those that have answered on this port since the service began. */
    nodes: Node[];
    /** Those that have not confirmed the last stop; null: all have, or there was none. */
    stop: Node[] | null;
    /** The port was lost while units of it may have moved, and they were not seen since. */
    lost?: boolean;
    /** Seconds since the unit answered last; null: it never has. */
    seen_ago_s: number | null;
}

/** What a motor does; see firmware/rkm04/docs/messages.md, Get Status. An original unit tells positions only. */
export interface MotorLive {
    position: number;
    /** Steps/s, negative backward; null: not known. */
    speed: number | null;
    /** null: not known, and neither is the rest. */
    moving: boolean | null;
    running?: boolean;
    waiting?: boolean;
    stopped?: boolean;
    failed?: boolean;
    /** STEP and DIR do not reach its pins (T41). */
    simulated?: boolean;
    ended?: boolean;
    error?: string;
    awaited?: { what: string; number: number; level: number } | null;
    /** The ordinal of the command that is being run, or was run last where `running` is not known; null: not known. */
    place?: number | null;
}

export interface LiveUnit {
    cause: string;
    no_crystal: boolean;
    not_started: boolean;
    no_store: boolean;
    untimed: boolean;
    memory_locked: boolean;
    simulating: boolean;
    late_steps: number;
    line: Record<string, number>;
    /** Of the unit in a page: for how long its time has stood, and the share of real time that it needs. */
    clock?: { stood_s: number; load: number };
}

/** What of a look at the unit changes by itself. */
export const GOES_ON = ["time_s", "line", "clock"] as const;

export interface Live {
    node: number;
    time_s: number;
    motors: MotorLive[];
    /** null: the unit does not know Get Status. */
    inputs: number[] | null;
    outputs: number[] | null;
    unit: LiveUnit | null;
}

export interface Answer {
    id: number | null;
    from?: number | null;
    message: string;
    node: number;
    motor: number | null;
    request_bytes: string | null;
    answer_bytes: string | null;
    request_message?: string | null;
    answer_message?: string | null;
    /** The answer in English. */
    text: string | null;
    values?: AnswerValues | null;
    error: Trouble | null;
}

/** What an answer says, apart from the language; which of them there are depends on the message. */
export interface AnswerValues {
    version?: string;
    date?: string;
    commands?: number;
    messages?: number;
    overflow?: boolean;
    /** What the unit holds, as it tells it. */
    program?: string;
    notes?: string[];
    /** The one command that acts only alone in a message, if it was that. */
    alone?: string;
    /** Commands by motor, when all programs were sent. */
    sent?: Record<string, number>;
    together?: boolean;
    everywhere?: boolean;
    found?: FoundUnit[];
    stored?: Record<string, number>;
    positions?: Record<string, number>;
    points?: [step: number, speed: number][];
    steps?: number;
    command?: number;
    speed?: number;
    confirmed?: Node[];
    /** The motors that got the speed. */
    motors?: number[];
}

/** A unit that has answered a scan; without a version, what it has answered was damaged. */
export interface FoundUnit {
    node: number;
    version: string | null;
    date: string | null;
    remark: string;
}

export interface Port {
    port: string;
    label: string;
}

export type FromService =
    | { type: "hello"; version: string; language_default: string; client?: number; beat: number }
    | { type: "beat"; beat: number }
    | ({ type: "state" } & UnitState)
    | { type: "ports"; ports: Port[] }
    | ({ type: "live" } & Live)
    | ({ type: "answer" } & Answer)
    | { type: "progress"; id: number; from?: number | null; value: number }
    | { type: "error"; error: Trouble };

/** A remark of the firmware's parser: lines and columns count from 1, columns in characters. */
export interface Problem {
    line: number;
    column: number;
    end_column: number;
    severity: "error" | "warning";
    message: string;
}

export interface Verdict {
    problems: Problem[];
    /** So many more were found. */
    more?: number;
    /** How many commands the program has; told of programs without errors. */
    commands?: number | null;
    /** The stored commands of a program without errors, in the order of their ordinals from 1. */
    listing?: [line: number, column: number, text: string][];
    /** It forgets what the unit had before. */
    resets?: boolean;
}

export interface MotorCurve {
    /** Seconds, not decreasing; two equal times are a jump. */
    t: number[];
    /** Steps/s, negative backward. */
    speed: number[];
    position: number[];
    /** Where it was at the beginning of the part of the time that was asked for. */
    before: number;
    /** Every single pulse of that part, and every position that was written; null: too many to be told. */
    steps: [seconds: number, position: number][] | null;
    /** The ordinal of the command that was run at the beginning of that part; 0: none. */
    command: number;
    /** When each command of that part began, and its ordinal. */
    commands: [seconds: number, ordinal: number][];
    /** From then on there are more commands than are told; null: all are told. */
    commands_cut: number | null;
    moves: number;
    pulses: number;
    peak: number;
    /** In words: what the program does at the end of the time. */
    state_text?: string | null;
    error?: string | null;
}

export interface CurveRequest {
    programs: Record<string, string>;
    inputs: [ms: number, input: number, level: number][];
    seconds: number;
    points: number;
    page: string;
    range?: [from: number, to: number];
}

export interface Curve {
    seconds: number;
    /** Whether all programs came to rest. */
    ended: boolean;
    /** Whether it was given up because it took too long to compute. */
    cut?: boolean;
    motors: Record<string, MotorCurve>;
    outputs: [seconds: number, output: number, level: number][];
    error: string | null;
}

export interface Example {
    name: string;
    text: string;
    /** Changes of inputs that belong to it. */
    inputs?: [ms: number, input: number, level: number][];
}

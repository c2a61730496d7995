/** What the page and the service say to each other, over HTTP and over the WebSocket. */

export const MOTORS = [1, 2, 3, 4] as const;
export const ALL_MOTORS = 0;

export type MessageName =
    "version" | "send" | "store" | "position" | "program" | "table" | "progress";

/** Why something did not happen, and what to do about it. `kind` is for translation. */
export interface Trouble {
    kind?: string;
    cause: string;
    next: string;
    line?: number;
    column?: number;
}

export type ToService =
    | { type: "connect"; port: string; node: number }
    | { type: "disconnect" }
    | { type: "ports" }
    | { type: "request"; id: number; message: MessageName; motor: number; text?: string }
    | { type: "stop" | "resume" | "reset"; id: number }
    | { type: "speed"; id: number; motor: number; value: number }
    | { type: "input"; input: number; level: 0 | 1 };

export interface UnitState {
    connected: boolean;
    port: string | null;
    virtual: boolean;
    node: number;
    busy: string | null;
    error: Trouble | null;
    unit?: { version: string; date: string } | null;
}

export interface MotorLive {
    position: number;
    /** Steps/s, negative backward. */
    speed: number;
    idle: boolean;
}

export interface Live {
    time_s: number;
    motors: MotorLive[];
    /** null: the line has no message that asks for them. */
    inputs: number[] | null;
    outputs: number[] | null;
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
    notes?: string[];
    stored?: Record<string, number>;
    positions?: Record<string, number>;
    points?: [step: number, speed: number][];
    steps?: number;
    command?: number;
    speed?: number;
}

export interface Port {
    port: string;
    label: string;
}

export type FromService =
    | { type: "hello"; version: string; language_default: string; client?: number }
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

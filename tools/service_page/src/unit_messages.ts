import type { Bytes } from "./program_host";
import { ALL_MOTORS, MOTORS, type LiveUnit, type MotorLive } from "./protocol";

/*
 * The messages of firmware/rkm04/docs/messages.md: requests as bytes, answers as values. Pure.
 */

export const VERSION = 1;
export const SET_COMMAND = 2;
export const STORE_FLASH = 3;
export const GET_POSITION = 4;
export const GET_COMMAND = 5;
export const GET_TABLE = 6;
export const GET_PROGRESS = 7;
export const GET_STATUS = 200;

export const REQUEST_BYTES_MAX = 8192;
/** What a text may have: number and motor stand before it. */
export const TEXT_BYTES_MAX = REQUEST_BYTES_MAX - 2;

const HEAD_BYTES = 2;
const LINES = 8;
const WAITS_HIGH = 0x80;
const WAITS_TIME = 96;
const VARIABLE_FIRST = 80;

/** Names of what Get Status tells by number, in the order of the numbers; the page brings them along. */
export interface StatusNames {
    causes: string[];
    errors: string[];
    line: string[];
}

export interface Status {
    inputs: number[];
    outputs: number[];
    motors: Required<MotorLive>[];
    unit: LiveUnit;
}

export function request(message: number, motor: number, text = ""): Bytes {
    return Uint8Array.of(message, 0x30 + motor, ...Array.from(text, (character) => character.charCodeAt(0)));
}

export const hex = (bytes: Uint8Array): string =>
    Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0").toUpperCase()).join(" ");

const ascii = (bytes: Uint8Array): string => String.fromCharCode(...bytes);

/** What follows number and motor. */
export const content = (answer: Uint8Array): string => ascii(answer.subarray(HEAD_BYTES));

export function version(answer: Uint8Array): { version: string; date: string } {
    const [number = "", date = ""] = content(answer).split(",");
    return { version: number, date: date.split(".").reverse().join("-") };
}

export function positions(answer: Uint8Array, motor: number): Record<string, number> {
    const found: Record<string, number> = {};
    let at = HEAD_BYTES;
    for (const each of motor === ALL_MOTORS ? MOTORS : [motor]) {
        const length = answer[at] ?? 0;
        found[each] = Number(ascii(answer.subarray(at + 1, at + 1 + length)));
        at += 1 + length;
    }
    return found;
}

/** The break points of the move in progress. */
export function table(answer: Uint8Array): [step: number, speed: number][] {
    return [...content(answer).matchAll(/\((\d+);(\d+)\)/g)].map(([, step, speed]) => [Number(step), Number(speed)]);
}

export function progress(answer: Uint8Array): { steps: number; command: number } {
    const [steps, command] = content(answer).split(";").map(Number);
    return { steps: steps ?? 0, command: command ?? 0 };
}

export function status(answer: Uint8Array, names: StatusNames): Status {
    const view = new DataView(answer.buffer, answer.byteOffset, answer.byteLength);
    const byte = (at: number): number => view.getUint8(at);
    const count = (at: number): number => view.getUint32(at, true);
    const levels = (at: number): number[] => Array.from({ length: LINES }, (_, bit) => (byte(at) >> bit) & 1);
    const switches = byte(5);
    const motors = MOTORS.map((_, index) => {
        const [state, error] = [byte(6 + index), byte(10 + index)];
        const position = Number(view.getBigInt64(14 + 8 * index, true));
        return motorOf(state, position, names.errors[error] ?? `error ${error}`, byte(98 + index));
    });
    const unit = {
        cause: names.causes[byte(4)] ?? `cause ${byte(4)}`,
        no_crystal: (switches & 1) !== 0,
        not_started: (switches & 2) !== 0,
        memory_locked: (switches & 4) !== 0,
        simulating: (switches & 8) !== 0,
        no_store: (switches & 16) !== 0,
        late_steps: count(46),
        line: Object.fromEntries(names.line.map((name, index) => [name, count(50 + 4 * index)])),
    };
    return { inputs: levels(2), outputs: levels(3), motors, unit };
}

function motorOf(state: number, position: number, error: string, awaited: number): Required<MotorLive> {
    const is = (bit: number): boolean => ((state >> bit) & 1) === 1;
    return {
        position,
        speed: null,
        moving: is(0),
        running: is(1),
        waiting: is(2),
        stopped: is(3),
        failed: is(4),
        ended: is(5),
        simulated: is(6),
        error: is(4) ? error : "",
        awaited: is(2) ? awaitedOf(awaited) : null,
    };
}

function awaitedOf(code: number): MotorLive["awaited"] & object {
    const number = code & ~WAITS_HIGH;
    const level = (code & WAITS_HIGH) === 0 ? 0 : 1;
    if (number >= 1 && number <= LINES) {
        return { what: "input", number, level };
    }
    if (number >= VARIABLE_FIRST && number < WAITS_TIME) {
        return { what: "variable", number, level };
    }
    return { what: number === WAITS_TIME ? "time" : "]", number: 0, level: 0 };
}

import type { Bytes } from "./program_host";
import { ALL_MOTORS, MOTORS, type LiveUnit, type MotorLive } from "./protocol";
import { Refusal } from "./unit_place";

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
const UNKNOWN = 255;

export const REQUEST_BYTES_MAX = 8192;
/** What a text may have: number and motor stand before it. */
export const TEXT_BYTES_MAX = REQUEST_BYTES_MAX - 2;

const HEAD_BYTES = 2;
const LINES = 8;
/** Bytes of the oldest layout, and of those since. */
const STATUS_BYTES = 98;
const WAITS_BYTES = 4;
const LAYOUT_OLDEST = 1;
const WAITS_HIGH = 0x80;
const WAITS_TIME = 96;
const WAITS_RELEASE = 97;
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
    motors: Required<Omit<MotorLive, "place">>[];
    unit: LiveUnit;
}

export function request(message: number, motor: number, text = ""): Bytes {
    return Uint8Array.of(message, 0x30 + motor, ...Array.from(text, (character) => character.charCodeAt(0)));
}

export const hex = (bytes: Uint8Array): string =>
    Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0").toUpperCase()).join(" ");

const ascii = (bytes: Uint8Array): string => Array.from(bytes, (byte) => String.fromCharCode(byte)).join("");

/** A whole frame whose content is not what the request asks for. */
function wrong(answer: Uint8Array): Refusal {
    const shown = hex(answer.subarray(0, 24));
    return new Refusal(
        `the answer is not one of an RKM04 (${shown})`,
        "is it another unit, or does another program use this line?",
        { kind: "WrongAnswer" },
    );
}

/** The unit has other software, which does not know the request. */
export class UnknownMessage extends Refusal {
    constructor() {
        super("the unit does not know this message", "it has other software", { kind: "UnknownMessage" });
    }
}

/** What follows number and motor of the answer to a request for a motor. */
export function content(answer: Uint8Array, message: number, motor: number): Uint8Array {
    requireKnown(answer);
    if (answer[0] !== message || answer[1] !== 0x30 + motor) {
        throw wrong(answer);
    }
    return answer.subarray(HEAD_BYTES);
}

export const text = (answer: Uint8Array, message: number, motor: number): string =>
    ascii(content(answer, message, motor));

function requireKnown(answer: Uint8Array): void {
    if (answer[0] === UNKNOWN) {
        throw new UnknownMessage();
    }
}

export function version(answer: Uint8Array): { version: string; date: string } {
    requireKnown(answer);
    const found = /^(\d\d\.\d\d),(\d\d)\.(\d\d)\.(\d{4})$/.exec(ascii(answer.subarray(HEAD_BYTES)));
    if (answer[0] !== VERSION || answer[1] !== answer.length - HEAD_BYTES || found === null) {
        throw wrong(answer);
    }
    const [, number = "", day = "", month = "", year = ""] = found;
    return { version: number, date: `${year}-${month}-${day}` };
}

export function positions(answer: Uint8Array, motor: number): Record<string, number> {
    const rest = content(answer, GET_POSITION, motor);
    const found: Record<string, number> = {};
    let at = 0;
    for (const each of motor === ALL_MOTORS ? MOTORS : [motor]) {
        const length = rest[at] ?? 0;
        const digits = ascii(rest.subarray(at + 1, at + 1 + length));
        if (!/^ *-?\d+$/.test(digits)) {
            throw wrong(answer);
        }
        found[each] = Number(digits);
        at += 1 + length;
    }
    if (at !== rest.length) {
        throw wrong(answer);
    }
    return found;
}

/** The break points of the move in progress. */
export function table(answer: Uint8Array, motor: number): [step: number, speed: number][] {
    const told = text(answer, GET_TABLE, motor);
    const points = [...told.matchAll(/\((\d+);(\d+)\)/g)];
    if (Number(/^ *(\d+);\[.*\]$/.exec(told)?.[1]) !== points.length) {
        throw wrong(answer);
    }
    return points.map(([, step, speed]) => [Number(step), Number(speed)]);
}

export function progress(answer: Uint8Array, motor: number): { steps: number; command: number } {
    const found = /^ *(\d+); *(\d+)$/.exec(text(answer, GET_PROGRESS, motor));
    if (found === null) {
        throw wrong(answer);
    }
    return { steps: Number(found[1]), command: Number(found[2]) };
}

/** Reads an answer of this layout or a later one; an older one does not tell what is waited for. */
export function status(answer: Uint8Array, names: StatusNames): Status {
    requireKnown(answer);
    const layout = answer[1] ?? 0;
    const least = STATUS_BYTES + (layout > LAYOUT_OLDEST ? WAITS_BYTES : 0);
    if (answer[0] !== GET_STATUS || layout < LAYOUT_OLDEST || answer.length < least) {
        throw wrong(answer);
    }
    const view = new DataView(answer.buffer, answer.byteOffset, answer.byteLength);
    const byte = (at: number): number => view.getUint8(at);
    const count = (at: number): number => view.getUint32(at, true);
    const levels = (at: number): number[] => Array.from({ length: LINES }, (_, bit) => (byte(at) >> bit) & 1);
    const switches = byte(5);
    const motors = MOTORS.map((_, index) => {
        const [state, error] = [byte(6 + index), byte(10 + index)];
        const position = Number(view.getBigInt64(14 + 8 * index, true));
        const awaited = layout > LAYOUT_OLDEST ? byte(STATUS_BYTES + index) : 0;
        return motorOf(state, position, names.errors[error] ?? `error ${error}`, awaited);
    });
    const unit = {
        cause: names.causes[byte(4)] ?? `cause ${byte(4)}`,
        no_crystal: (switches & 1) !== 0,
        not_started: (switches & 2) !== 0,
        memory_locked: (switches & 4) !== 0,
        simulating: (switches & 8) !== 0,
        no_store: (switches & 16) !== 0,
        untimed: (switches & 32) !== 0,
        late_steps: count(46),
        line: Object.fromEntries(names.line.map((name, index) => [name, count(50 + 4 * index)])),
    };
    return { inputs: levels(2), outputs: levels(3), motors, unit };
}

function motorOf(state: number, position: number, error: string, awaited: number): Status["motors"][number] {
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

function awaitedOf(code: number): Required<MotorLive>["awaited"] {
    const number = code & ~WAITS_HIGH;
    const level = (code & WAITS_HIGH) === 0 ? 0 : 1;
    if (number >= 1 && number <= LINES) {
        return { what: "input", number, level };
    }
    if (number >= VARIABLE_FIRST && number < WAITS_TIME) {
        return { what: "variable", number, level };
    }
    const others: Record<number, string> = { [WAITS_TIME]: "time", [WAITS_RELEASE]: "]" };
    const what = others[code];
    return what === undefined ? null : { what, number: 0, level: 0 };
}

/** Whether a motor brakes to stay, or stands and has nothing to run. */
export function isStopped({ stopped, failed, ended, moving, running }: MotorLive): boolean {
    return Boolean(stopped || failed || ended) || !(moving || running);
}

/** Whether a motor stands, and all that is stored has run. */
export function isAtRest(motor: Status["motors"][number] | undefined): boolean {
    return motor !== undefined && !(motor.moving || motor.running || motor.stopped || motor.failed || motor.ended);
}

/** Modbus RTU: requests, and the answers to them among the bytes of a line. */
import type { Bytes } from "../../program_host";

export const READ = 3;
export const WRITE = 16;
export const WRITE_READ = 23;
export const IDENTIFY = 43;
export const REFUSED = 0x80;

const CRC_POLYNOMIAL = 0xa001;
const CRC_BYTES = 2;
const FIXED_BYTES = 8;
const EXCEPTION_BYTES = 5;
const IDENTITY_HEAD = 8;
const MEI = 0x0e;

export function crc(data: Uint8Array): number {
    let sum = 0xffff;
    for (const byte of data) {
        sum ^= byte;
        for (let bit = 0; bit < 8; bit += 1) {
            sum = sum & 1 ? (sum >> 1) ^ CRC_POLYNOMIAL : sum >> 1;
        }
    }
    return sum;
}

const pair = (word: number): [number, number] => [word >> 8, word & 0xff];
const pairs = (words: readonly number[]): number[] => words.flatMap(pair);

/** What a request asks for, from the function on. */
export const readRequest = (first: number, count: number): number[] => [READ, ...pair(first), ...pair(count)];
export const writeRequest = (first: number, words: readonly number[]): number[] => [
    WRITE, ...pair(first), ...pair(words.length), 2 * words.length, ...pairs(words),
];
export const writeReadRequest = (first: number, words: readonly number[], read: number, count: number): number[] => [
    WRITE_READ, ...pair(read), ...pair(count), ...pair(first), ...pair(words.length), 2 * words.length, ...pairs(words),
];
export const identifyRequest = (): number[] => [IDENTIFY, MEI, 1, 0];

/** The frame of a request, or of an answer. */
export function framed(node: number, content: readonly number[]): Bytes {
    const body = Uint8Array.from([node, ...content]);
    const sum = crc(body);
    return Uint8Array.from([...body, sum & 0xff, sum >> 8]);
}

/** The length of the answer that begins at a place; null: it is not there yet. */
function lengthOf(data: Uint8Array, at: number): number | null {
    const [code = 0, count] = [data[at + 1], data[at + 2]];
    if (code & REFUSED) {
        return EXCEPTION_BYTES;
    }
    if (code === WRITE) {
        return FIXED_BYTES;
    }
    if (code !== IDENTIFY) {
        return count === undefined ? null : 3 + count + CRC_BYTES;
    }
    const objects = data[at + IDENTITY_HEAD - 1];
    let end = at + IDENTITY_HEAD;
    for (let index = 0; index < (objects ?? 0); index += 1) {
        end += 2 + (data[end + 1] ?? 0);
    }
    return objects === undefined ? null : end - at + CRC_BYTES;
}

function frameAt(data: Bytes, at: number): Bytes | null {
    const length = lengthOf(data, at);
    if (length === null || at + length > data.length) {
        return null;
    }
    const frame = data.slice(at, at + length);
    return crc(frame.subarray(0, -CRC_BYTES)) === (frame.at(-2) ?? 0) + 256 * (frame.at(-1) ?? 0) ? frame : null;
}

/** The answer of a node to a function, from the function on; null: it is not among these bytes. */
export function findAnswer(heard: Bytes, node: number, code: number): Bytes | null {
    for (let at = 0; at < heard.length; at += 1) {
        if (heard[at] === node && ((heard[at + 1] ?? 0) & ~REFUSED) === code) {
            const frame = frameAt(heard, at);
            if (frame !== null) {
                return frame.slice(1, -CRC_BYTES);
            }
        }
    }
    return null;
}

/** The registers that the answer to a read has; null: it has others. */
export function wordsIn(answer: Bytes, count: number): number[] | null {
    if (answer[1] !== 2 * count || answer.length !== 2 + 2 * count) {
        return null;
    }
    return Array.from({ length: count }, (_, index) => ((answer[2 + 2 * index] ?? 0) << 8) | (answer[3 + 2 * index] ?? 0));
}

/** The texts of an identification. */
export function textsIn(answer: Bytes): string[] {
    const found: string[] = [];
    for (let at = IDENTITY_HEAD - 1; at + 1 < answer.length; at += 2 + (answer[at + 1] ?? 0)) {
        found.push(String.fromCharCode(...answer.slice(at + 2, at + 2 + (answer[at + 1] ?? 0))));
    }
    return found;
}

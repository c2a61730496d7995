/** Requests of Modbus from the function on, and what is in the answers to them. */
import type { Bytes } from "../../program_host";

const READ = 3;
const WRITE = 16;
const WRITE_READ = 23;
const IDENTIFY = 43;
const MEI = 0x0e;
const OBJECTS_AT = 7;

const pair = (word: number): [number, number] => [word >> 8, word & 0xff];
const counted = (words: readonly number[]): number[] => [...pair(words.length), 2 * words.length, ...words.flatMap(pair)];

export const readRequest = (first: number, count: number): Bytes => Uint8Array.from([READ, ...pair(first), ...pair(count)]);
export const writeRequest = (first: number, words: readonly number[]): Bytes =>
    Uint8Array.from([WRITE, ...pair(first), ...counted(words)]);
export const writeReadRequest = (first: number, words: readonly number[], read: number, count: number): Bytes =>
    Uint8Array.from([WRITE_READ, ...pair(read), ...pair(count), ...pair(first), ...counted(words)]);
export const identifyRequest = (): Bytes => Uint8Array.from([IDENTIFY, MEI, 1, 0]);

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
    for (let at = OBJECTS_AT; at + 1 < answer.length; at += 2 + (answer[at + 1] ?? 0)) {
        found.push(String.fromCharCode(...answer.slice(at + 2, at + 2 + (answer[at + 1] ?? 0))));
    }
    return found;
}

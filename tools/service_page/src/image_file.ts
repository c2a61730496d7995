import type { Bytes } from "./program_host";

/** What a `.bin` of the build holds: the image, and its name, UNIT-BOARD, in the DFU suffix (USB DFU 1.1, appendix B). */
export interface ImageFile {
    unit: string;
    board: string;
    image: Bytes;
}

const NAME_BYTES = 32;
const SUFFIX_BYTES = NAME_BYTES + 16;
/** "UFD", and the length of the suffix after it. */
const SIGNATURE = [0x55, 0x46, 0x44, SUFFIX_BYTES];
const SUM_BYTES = 4;

/** What is left over if the sum at the end is right, whatever comes before it. */
function remainderOf(bytes: Uint8Array): number {
    let rest = ~0;
    for (const byte of bytes) {
        rest ^= byte;
        for (let bit = 0; bit < 8; bit += 1) {
            rest = (rest >>> 1) ^ (rest & 1 ? 0xedb88320 : 0);
        }
    }
    return rest;
}

/** The image of a file; undefined if it is not whole, or none. */
export function imageFileOf(file: Bytes): ImageFile | undefined {
    const suffix = file.slice(-SUFFIX_BYTES);
    const signature = suffix.slice(-SUM_BYTES - SIGNATURE.length, -SUM_BYTES);
    if (SIGNATURE.some((each, index) => each !== signature[index]) || remainderOf(file) !== 0) {
        return undefined;
    }
    const [unit = "", ...board] = new TextDecoder().decode(suffix.slice(0, NAME_BYTES)).replace(/\0+$/, "").split("-");
    return { unit, board: board.join("-"), image: file.slice(0, -SUFFIX_BYTES) };
}

/** The linker script gives 64 kB to the image. */
export const FILE_BYTES_MAX = 64 * 1024 + SUFFIX_BYTES;

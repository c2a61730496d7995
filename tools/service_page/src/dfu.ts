import type { Bytes } from "./program_host";

/*
 * The protocol of the loader in the chip's system memory (ST's AN3156, with the states of USB DFU 1.1): what it is told,
 * step by step. Nothing of it was tried on a part; tests/support/fake_loader.js is a loader written from the same note.
 */

/** The part of WebUSB that is used. */
export interface UsbDevice {
    readonly configuration: { interfaces: UsbInterface[] } | null;
    open(): Promise<void>;
    close(): Promise<void>;
    selectConfiguration(value: number): Promise<void>;
    claimInterface(number: number): Promise<void>;
    selectAlternateInterface(number: number, alternate: number): Promise<void>;
    controlTransferOut(setup: UsbSetup, data?: Bytes): Promise<{ status?: string }>;
    controlTransferIn(setup: UsbSetup, length: number): Promise<{ status?: string; data?: DataView }>;
}

interface UsbInterface {
    interfaceNumber: number;
    alternates: { alternateSetting: number; interfaceName?: string | null; interfaceClass: number }[];
}

interface UsbSetup {
    requestType: "class";
    recipient: "interface";
    request: number;
    value: number;
    index: number;
}

/** How the loader shows up on USB. */
export const LOADER = { vendorId: 0x0483, productId: 0xdf11 };
export const FLASH_ADDRESS = 0x0800_0000;
/** Stored programs lie in the last two sectors of so much. */
const FLASH_BYTES_MIN = 1024 * 1024;

const DFU_CLASS = 0xfe;
const [DNLOAD, UPLOAD, GETSTATUS, CLRSTATUS, ABORT] = [1, 2, 3, 4, 6];
const [IDLE, BUSY, DNLOAD_IDLE, MANIFEST, ERROR] = [2, 4, 5, 7, 10];
const [SET_ADDRESS, ERASE] = [0x21, 0x41];
/** Block numbers 0 and 1 are not for data. */
const FIRST_BLOCK = 2;
/** Of a block, as the loader of an STM32F4 takes it. */
const BLOCK_BYTES = 2048;
/** A sector of 128 kB needs up to 4 s. */
const BUSY_MS = 10_000;
const STATUS_BYTES = 6;

/** Status errVENDOR: what AN3156 has where the flash is protected against reading. */
const ERR_VENDOR = 0x0b;

export type DfuFault = "noLoader" | "small" | "place" | "busy" | "refused" | "protected" | "differs";
/** What is known of the board: not opened; its flash as it was; perhaps not whole; the image, read back. */
export type DfuStage = "closed" | "nothing" | "half" | "whole";

/** What went wrong; `words` are from the browser or the loader. */
export class DfuTrouble extends Error {
    readonly kind: DfuFault;

    constructor(kind: DfuFault, words = "") {
        super(words);
        this.kind = kind;
    }
}

export interface Sector {
    address: number;
    bytes: number;
}

/** The sectors that the name of an interface tells, such as `@Internal Flash  /0x08000000/04*016Kg,01*064Kg,07*128Kg`. */
export function sectorsOf(name: string): Sector[] {
    const [, begin, groups] = /^@Internal Flash\s*\/(0x[0-9a-f]+)\/([^/]+)/i.exec(name) ?? [];
    const sectors: Sector[] = [];
    let address = Number(begin);
    for (const [, count, size, unit] of (groups ?? "").matchAll(/(\d+)\*(\d+)([ KM])/g)) {
        const bytes = Number(size) * ({ K: 1024, M: 1024 * 1024 }[unit ?? ""] ?? 1);
        for (let each = 0; each < Number(count); each += 1) {
            sectors.push({ address, bytes });
            address += bytes;
        }
    }
    return sectors;
}

/** Speaks to the loader of one device. */
export class Loader {
    stage: DfuStage = "closed";
    readonly #device: UsbDevice;
    #interface = 0;
    #sectors: Sector[] = [];

    constructor(device: UsbDevice) {
        this.#device = device;
    }

    /** Opens it, and sees that it has the flash that a unit needs. */
    async open(): Promise<void> {
        await this.#device.open();
        if (this.#device.configuration === null) {
            await this.#device.selectConfiguration(1);
        }
        const places = (this.#device.configuration?.interfaces ?? []).flatMap(({ interfaceNumber, alternates }) =>
            alternates.map((alternate) => ({ interfaceNumber, ...alternate })));
        const flash = places.find(({ interfaceClass, interfaceName }) =>
            interfaceClass === DFU_CLASS && sectorsOf(interfaceName ?? "").length > 0);
        if (flash === undefined) {
            throw new DfuTrouble("noLoader");
        }
        this.#interface = flash.interfaceNumber;
        this.#sectors = sectorsOf(flash.interfaceName ?? "");
        const bytes = this.#sectors.reduce((sum, sector) => sum + sector.bytes, 0);
        if (bytes < FLASH_BYTES_MIN) {
            throw new DfuTrouble("small", `${bytes / 1024} kB`);
        }
        await this.#device.claimInterface(flash.interfaceNumber);
        await this.#device.selectAlternateInterface(flash.interfaceNumber, flash.alternateSetting);
        this.stage = "nothing";
        await this.#calm();
    }

    /** Writes an image, reads it back, and starts it; tells how much of it is done, from 0 to 1. */
    async write(address: number, image: Bytes, tell: (done: number) => void): Promise<void> {
        const end = address + image.length;
        const sectors = this.#sectors.filter((each) => each.address < end && each.address + each.bytes > address);
        const kept = this.#sectors.slice(-2);
        const last = sectors.at(-1);
        if (sectors[0]?.address !== address || !last || last.address + last.bytes < end || kept.includes(last)) {
            throw new DfuTrouble("place");
        }
        const blocks = Math.ceil(image.length / BLOCK_BYTES);
        let [done, total] = [0, sectors.length + 2 * blocks];
        const step = (): void => tell((done += 1) / total);
        for (const sector of sectors) {
            await this.#erase(sector.address);
            step();
        }
        await this.#tellPlace(SET_ADDRESS, address);
        for (let block = 0; block < blocks; block += 1) {
            await this.#download(FIRST_BLOCK + block, partOf(image, block));
            step();
        }
        await this.#compare(address, image, step);
        this.stage = "whole";
        await this.#leave(address);
    }

    async close(): Promise<void> {
        await inTime(this.#device.close());
    }

    /** From the order on the sector may be empty, unless the part is protected. */
    async #erase(address: number): Promise<void> {
        const before = this.stage;
        this.stage = "half";
        try {
            await this.#tellPlace(ERASE, address);
        } catch (error) {
            this.stage = error instanceof DfuTrouble && error.kind === "protected" ? before : this.stage;
            throw error;
        }
    }

    async #compare(address: number, image: Bytes, step: () => void): Promise<void> {
        await this.#calm();
        await this.#tellPlace(SET_ADDRESS, address);
        await this.#calm();
        for (let block = 0; block * BLOCK_BYTES < image.length; block += 1) {
            const wanted = partOf(image, block);
            const read = await this.#in(UPLOAD, FIRST_BLOCK + block, wanted.length);
            if (read.length !== wanted.length || read.some((byte, index) => byte !== wanted[index])) {
                throw new DfuTrouble("differs", `0x${(address + block * BLOCK_BYTES).toString(16)}`);
            }
            step();
        }
        await this.#calm();
    }

    /** An empty block ends the loader, which may be gone before it has answered. */
    async #leave(address: number): Promise<void> {
        await this.#tellPlace(SET_ADDRESS, address);
        await this.#out(DNLOAD, FIRST_BLOCK);
        const state = await this.#status().then((status) => status.state, (error: unknown) => {
            if (error instanceof DfuTrouble) {
                throw error;
            }
            return MANIFEST;
        });
        if (state !== MANIFEST) {
            throw new DfuTrouble("refused", `state ${state}`);
        }
    }

    /** Brings it to the state in which it takes orders. */
    async #calm(): Promise<void> {
        const { state } = await this.#status();
        if (state === ERROR) {
            await this.#out(CLRSTATUS, 0);
        } else if (state !== IDLE) {
            await this.#out(ABORT, 0);
        }
        const after = await this.#status();
        if (after.state !== IDLE) {
            throw new DfuTrouble("refused", `state ${after.state}`);
        }
    }

    /** An order with an address, the lowest byte first. */
    async #tellPlace(order: number, address: number): Promise<void> {
        const bytes = new Uint8Array(5);
        bytes[0] = order;
        new DataView(bytes.buffer).setUint32(1, address, true);
        await this.#download(0, bytes);
    }

    /** The first look at the status begins the work, those after it tell whether it is done. */
    async #download(block: number, data: Bytes): Promise<void> {
        await this.#out(DNLOAD, block, data);
        const end_ms = performance.now() + BUSY_MS;
        for (;;) {
            const { state, status, wait_ms } = await this.#status();
            if (state === DNLOAD_IDLE) {
                return;
            }
            if (state !== BUSY) {
                const kind = status === ERR_VENDOR ? "protected" : "refused";
                throw new DfuTrouble(kind, `status ${status}, state ${state}`);
            }
            if (performance.now() > end_ms) {
                throw new DfuTrouble("busy");
            }
            await new Promise((take) => window.setTimeout(take, Math.min(wait_ms, BUSY_MS)));
        }
    }

    async #status(): Promise<{ status: number; wait_ms: number; state: number }> {
        const [status = 0, low = 0, middle = 0, high = 0, state = 0] = await this.#in(GETSTATUS, 0, STATUS_BYTES);
        return { status, wait_ms: low + 256 * middle + 65_536 * high, state };
    }

    async #out(request: number, value: number, data?: Bytes): Promise<void> {
        const { status } = await inTime(this.#device.controlTransferOut(this.#setup(request, value), data));
        if (status !== "ok") {
            throw new DfuTrouble("refused", status ?? "");
        }
    }

    async #in(request: number, value: number, length: number): Promise<Uint8Array> {
        const { status, data } = await inTime(this.#device.controlTransferIn(this.#setup(request, value), length));
        if (status !== "ok" || data === undefined) {
            throw new DfuTrouble("refused", status ?? "");
        }
        return new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
    }

    #setup(request: number, value: number): UsbSetup {
        return { requestType: "class", recipient: "interface", request, value, index: this.#interface };
    }
}

/** The browser itself waits for a device without end. */
async function inTime<T>(work: Promise<T>): Promise<T> {
    let timer = 0;
    const late = new Promise<never>((_, fail) => {
        timer = window.setTimeout(() => fail(new DfuTrouble("busy")), BUSY_MS);
    });
    return Promise.race([work, late]).finally(() => window.clearTimeout(timer));
}

const partOf = (image: Bytes, block: number): Bytes =>
    image.slice(block * BLOCK_BYTES, (block + 1) * BLOCK_BYTES);

// A stand-in for navigator.usb: one STM32F405 whose loader speaks as ST's AN3156 and USB DFU 1.1 say. Work begins with
// the first look at the status after an order, and is done with the next one; a block is written only where the flash was
// erased; an upload needs the state dfuIDLE or dfuUPLOAD-IDLE.
// Tests change it by window.fakeLoader: `memory` is the flash, `name` that of the interface, `refuses` lets nobody choose
// it, `denies` are the browser's words for one that another window has, `pulled` is after how many orders it is gone, `hangs`
// after how many it answers no more, `stalls` which one it refuses, `guarded` whether it is protected against reading, `spoils`
// an address whose byte is written wrongly, `left` whether the image was started.
(() => {
    const BEGIN = 0x08000000;
    const BYTES = 1024 * 1024;
    const SECTORS = [...Array(4).fill(16), 64, ...Array(7).fill(128)].map((kilo) => kilo * 1024);
    const [IDLE, SYNC, BUSY, READY, MANIFEST, UPLOADING, ERROR] = [2, 3, 4, 5, 7, 9, 10];
    const BLOCK = 2048;

    class FakeLoader {
        configuration = null;
        memory = new Uint8Array(BYTES).fill(0xa5);
        name = "@Internal Flash  /0x08000000/04*016Kg,01*064Kg,07*128Kg";
        refuses = false;
        denies = "";
        pulled = Infinity;
        hangs = Infinity;
        stalls = -1;
        guarded = false;
        spoils = -1;
        left = false;
        orders = 0;
        erased = [];
        #state = IDLE;
        #status = 0;
        #pointer = BEGIN;
        #work = null;
        #isOpen = false;
        #isClaimed = false;

        async open() {
            this.#isOpen = true;
        }

        async close() {
            this.#isOpen = false;
        }

        async selectConfiguration() {
            const flash = { alternateSetting: 0, interfaceName: this.name, interfaceClass: 0xfe };
            const option = { alternateSetting: 1, interfaceName: "@Option Bytes  /0x1FFFC000/01*016 e", interfaceClass: 0xfe };
            this.configuration = { interfaces: [{ interfaceNumber: 0, alternates: [flash, option] }] };
        }

        async claimInterface() {
            if (this.denies) {
                throw new DOMException(this.denies, "NetworkError");
            }
            this.#isClaimed = true;
        }

        async selectAlternateInterface(number, alternate) {
            if (number !== 0 || alternate !== 0) {
                throw new DOMException("not the flash", "NotFoundError");
            }
        }

        async #begin({ requestType, recipient, index }) {
            this.orders += 1;
            if (this.orders > this.hangs) {
                await new Promise(() => undefined);
            }
            if (this.orders > this.pulled || this.left) {
                throw new DOMException("The device was disconnected.", "NotFoundError");
            }
            if (!this.#isOpen || !this.#isClaimed || requestType !== "class" || recipient !== "interface" || index !== 0) {
                throw new DOMException("Not possible.", "InvalidStateError");
            }
        }

        async controlTransferOut(setup, data = new Uint8Array()) {
            await this.#begin(setup);
            const { request, value } = setup;
            if (this.orders === this.stalls) {
                this.#state = ERROR;
                return { status: "stall" };
            }
            if (request === 4 && this.#state === ERROR) {
                [this.#state, this.#status] = [IDLE, 0];
            } else if (request === 6 && this.#state !== ERROR) {
                this.#state = IDLE;
            } else if (request === 1 && [IDLE, READY].includes(this.#state)) {
                this.#work = { value, data: data.slice() };
                this.#state = SYNC;
            } else {
                this.#state = ERROR;
                return { status: "stall" };
            }
            return { status: "ok" };
        }

        async controlTransferIn(setup, length) {
            await this.#begin(setup);
            const { request, value } = setup;
            if (request === 3) {
                return { status: "ok", data: new DataView(this.#look().buffer) };
            }
            if (request === 2 && [IDLE, UPLOADING].includes(this.#state) && value >= 2) {
                this.#state = UPLOADING;
                const from = this.#pointer - BEGIN + (value - 2) * BLOCK;
                return { status: "ok", data: new DataView(this.memory.slice(from, from + length).buffer) };
            }
            this.#state = ERROR;
            return { status: "stall" };
        }

        #look() {
            if (this.#state === BUSY) {
                [this.#state, this.#status] = this.guarded ? [ERROR, 11] : this.#do(this.#work) ? [READY, 0] : [ERROR, 8];
            } else if (this.#state === SYNC) {
                this.#state = BUSY;
                if (this.#work.data.length === 0) {
                    this.#state = MANIFEST;
                    setTimeout(() => (this.left = true));
                }
            }
            return Uint8Array.of(this.#status, 1, 0, 0, this.#state, 0);
        }

        #do({ value, data }) {
            if (value >= 2) {
                return this.#write(this.#pointer - BEGIN + (value - 2) * BLOCK, data);
            }
            const place = data.length === 5 ? new DataView(data.buffer).getUint32(1, true) : -1;
            const isThere = place >= BEGIN && place < BEGIN + BYTES;
            if (data[0] === 0x21 && isThere) {
                this.#pointer = place;
                return true;
            }
            return data[0] === 0x41 && isThere && this.#erase(place - BEGIN);
        }

        #erase(place) {
            let from = 0;
            const number = SECTORS.findIndex((bytes) => place < (from += bytes));
            this.memory.fill(0xff, from - SECTORS[number], from);
            this.erased.push(number);
            return true;
        }

        #write(from, data) {
            for (const [index, byte] of data.entries()) {
                this.memory[from + index] &= from + index === this.spoils ? byte ^ 1 : byte;
            }
            return true;
        }
    }

    const device = new FakeLoader();
    window.fakeLoader = device;
    Object.defineProperty(navigator, "usb", {
        value: {
            async requestDevice({ filters }) {
                const [{ vendorId, productId }] = filters;
                if (device.refuses || vendorId !== 0x0483 || productId !== 0xdf11) {
                    throw new DOMException("No device selected.", "NotFoundError");
                }
                return device;
            },
        },
        configurable: true,
    });
})();

// A stand-in for navigator.serial: one USB adapter, whose bytes go to a bridge (serial_bridge.py) over a WebSocket.
// Tests change it by window.fakeSerial: `busy` lets open() fail, pull() pulls the cable, `lastWords` does so as soon as
// these characters were sent, damage() is a character with a framing error, `opened` are the options that it was opened
// with, `said` holds what it was given to send, `choice_ms` is how long the user takes to choose it, stall() keeps back
// what is to be sent until resume().
(() => {
    const place = "PLACE";

    class FakePort extends EventTarget {
        readable = null;
        writable = null;
        busy = false;
        opened = [];
        lastWords = null;
        said = [];
        choice_ms = 0;
        #reader = null;
        #socket = null;
        #kept = null;

        getInfo() {
            return { usbVendorId: 0x0403, usbProductId: 0x6001 };
        }

        async open(options) {
            this.opened.push(options);
            if (this.busy) {
                throw new DOMException("Failed to open serial port.", "NetworkError");
            }
            if (this.#socket !== null) {
                throw new DOMException("The port is already open.", "InvalidStateError");
            }
            const socket = (this.#socket = new WebSocket(place));
            socket.binaryType = "arraybuffer";
            await new Promise((take, fail) => Object.assign(socket, { onopen: take, onerror: fail }));
            socket.onmessage = ({ data }) => this.#reader?.enqueue(new Uint8Array(data));
            this.#begin();
            this.#beginWriting(socket);
        }

        async close() {
            if (this.readable?.locked || this.writable?.locked) {
                throw new TypeError("Cannot close while a stream is locked.");
            }
            this.#end();
        }

        pull() {
            const reader = this.#reader;
            this.#end();
            reader.error(new DOMException("The device has been lost.", "NetworkError"));
            this.dispatchEvent(new Event("disconnect"));
        }

        damage() {
            const reader = this.#reader;
            this.#begin();
            reader.error(new DOMException("A framing error was detected.", "FramingError"));
        }

        stall() {
            this.#kept = [];
        }

        resume() {
            const kept = this.#kept;
            this.#kept = null;
            kept.forEach((send) => send());
        }

        #beginWriting(socket) {
            this.writable = new WritableStream({
                write: (data, { signal }) => (this.#kept === null ? this.#send(socket, data) : this.#keep(socket, data, signal)),
                abort: () => this.#beginWriting(socket),
            });
        }

        #keep(socket, data, signal) {
            return new Promise((take) => {
                const send = () => signal.aborted || take(this.#send(socket, data));
                this.#kept.push(send);
                signal.addEventListener("abort", take);
            });
        }

        #send(socket, data) {
            socket.send(data);
            this.said.push(...data);
            if (this.lastWords !== null && String.fromCharCode(...data).includes(this.lastWords)) {
                this.lastWords = null;
                this.pull();
            }
        }

        #begin() {
            this.readable = new ReadableStream({ start: (reader) => void (this.#reader = reader) });
        }

        #end() {
            this.#socket.close();
            this.#socket = this.#reader = this.readable = this.writable = null;
        }
    }

    const port = new FakePort();
    let isAllowed = false;
    window.fakeSerial = port;
    const serial = {
        getPorts: async () => (isAllowed ? [port] : []),
        requestPort: async () => {
            if (!navigator.userActivation.isActive) {
                throw new DOMException("Must be handling a user gesture.", "SecurityError");
            }
            if (port.refused) {
                throw new DOMException("No port selected by the user.", "NotFoundError");
            }
            await new Promise((take) => setTimeout(take, port.choice_ms));
            isAllowed = true;
            return port;
        },
    };
    Object.defineProperty(Navigator.prototype, "serial", { get: () => serial, configurable: true });
})();

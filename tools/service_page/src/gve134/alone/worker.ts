import type { Bytes } from "../../program_host";
import { isMachine, parseMachine, type NoMachine } from "../../machine_file";
import { unpacked } from "../../unpack";
import type { PortNews } from "../../unit_runner";
import { FileReader, type Opened } from "./file";
import { millOf, type Mill, type NoMill } from "./mill";
import { UnitRunner } from "./runner";

/**
 * What the page says to its workers. One reads files: it gets the program, then the files, vectors or machines, each
 * answered under its number. The other gets the unit, then files that were read, texts for the desk, and what a serial port does.
 */
export type Order =
    | { kind: "program"; bytes: Bytes }
    | { kind: "read"; id: number; name: string; text: string }
    | { kind: "judge"; id: number; bytes: Bytes }
    | { kind: "unit"; bytes: Bytes }
    | { kind: "file"; file: Opened }
    | { kind: "machine"; mill: Mill }
    | PortNews
    | string;

export type Read =
    | { id: number; opened: Opened }
    | { id: number; mill: Mill | NoMill | NoMachine }
    | { id: number; trouble: string };

let reader: FileReader | null = null;
let runner: UnitRunner | null = null;

/** An error that nobody catches tells the page. */
function fail(error: unknown): void {
    self.setTimeout(() => {
        throw error;
    });
}

function read({ id, name, text }: Extract<Order, { kind: "read" }>): Read {
    try {
        if (reader === null) {
            throw new Error("the program is not there");
        }
        return { id, opened: reader.open(name, text) };
    } catch (error) {
        return { id, trouble: error instanceof Error ? error.message : String(error) };
    }
}

/** What a machine file says of this unit, or why it does not serve it. */
function judged(bytes: Bytes): Mill | NoMill | NoMachine {
    const found = parseMachine(bytes);
    return isMachine(found) ? millOf(found) : found;
}

async function take(order: Order): Promise<void> {
    if (typeof order === "string") {
        runner?.hear(order);
    } else if (order.kind === "program") {
        reader = new FileReader(await unpacked(order.bytes));
    } else if (order.kind === "read") {
        self.postMessage(read(order));
    } else if (order.kind === "judge") {
        self.postMessage({ id: order.id, mill: judged(order.bytes) } satisfies Read);
    } else if (order.kind === "unit") {
        runner = new UnitRunner(await unpacked(order.bytes), (said) => self.postMessage(said), fail);
    } else if (order.kind === "file") {
        runner?.open(order.file);
    } else if (order.kind === "machine") {
        runner?.take(order.mill);
    } else {
        runner?.hearOfPort(order);
    }
}

/** What comes while a program is unpacked is done after that, in its order. */
let turn = Promise.resolve();
self.addEventListener("message", ({ data }: MessageEvent<Order>) => {
    turn = turn.then(() => take(data)).catch(fail);
});

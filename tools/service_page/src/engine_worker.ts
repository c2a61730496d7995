import { ProgramHost, type Bytes } from "./program_host";
import type { CurveRequest } from "./protocol";
import { Simulator } from "./simulator";
import type { StatusNames } from "./unit_messages";
import { unpacked } from "./unpack";
import { UnitRunner, type PortNews } from "./unit_runner";

/**
 * What the page asks a worker for: first the program, then checks and curves, each answered under its number. Another
 * worker gets the program and the unit; from then on what they say to each other is text, and bytes of a serial port.
 */
export type Order =
    | { kind: "program"; bytes: Bytes }
    | { kind: "check"; id: number; text: string }
    | { kind: "curve"; id: number; request: CurveRequest }
    | { kind: "unit"; bytes: Bytes; names: StatusNames }
    | PortNews
    | string;

export type Told = { id: number; answer: unknown } | { id: number; trouble: string };

type Question = Extract<Order, { id: number }>;

let simulator: Simulator | null = null;
let unit: UnitRunner | null = null;

function obey(order: Question): Told {
    try {
        if (simulator === null) {
            throw new Error("the simulator is not there");
        }
        const answer = order.kind === "check" ? simulator.check(order.text) : simulator.curve(order.request);
        return { id: order.id, answer };
    } catch (error) {
        return { id: order.id, trouble: error instanceof Error ? error.message : String(error) };
    }
}

/** What has come while a program was unpacked; each is done in a turn of its own, as if it had come then. */
const late: Order[] = [];
let isUnpacking = false;

function take(data: Order): void {
    if (typeof data === "string") {
        unit?.hear(data);
    } else if (data.kind === "program" || data.kind === "unit") {
        bring(data).catch(fail);
    } else if (data.kind === "check" || data.kind === "curve") {
        self.postMessage(obey(data));
    } else {
        unit?.hearOfPort(data);
    }
}

/** An error that nobody catches tells the page. */
function fail(error: unknown): void {
    self.setTimeout(() => {
        throw error;
    });
}

async function bring(data: Extract<Order, { kind: "program" | "unit" }>): Promise<void> {
    isUnpacking = true;
    const bytes = await unpacked(data.bytes);
    if (data.kind === "program") {
        simulator = new Simulator(new ProgramHost(bytes));
    } else if (simulator !== null) {
        unit = new UnitRunner(bytes, simulator, data.names, (said) => self.postMessage(said));
    }
    isUnpacking = false;
    self.setTimeout(catchUp);
}

function catchUp(): void {
    const data = isUnpacking ? undefined : late.shift();
    if (data !== undefined) {
        self.setTimeout(catchUp);
        take(data);
    }
}

self.addEventListener("message", ({ data }: MessageEvent<Order>) => {
    if (isUnpacking || late.length > 0) {
        late.push(data);
    } else {
        take(data);
    }
});

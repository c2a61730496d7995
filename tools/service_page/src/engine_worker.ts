import { ProgramHost, type Bytes } from "./program_host";
import type { CurveRequest } from "./protocol";
import { Simulator } from "./simulator";

/** What the page asks the worker for: first the program, then checks and curves, each answered under its number. */
export type Order =
    | { kind: "program"; bytes: Bytes }
    | { kind: "check"; id: number; text: string }
    | { kind: "curve"; id: number; request: CurveRequest };

export type Told = { id: number; answer: unknown } | { id: number; trouble: string };

let simulator: Simulator | null = null;

function obey(order: Exclude<Order, { kind: "program" }>): Told {
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

self.addEventListener("message", ({ data }: MessageEvent<Order>) => {
    if (data.kind === "program") {
        simulator = new Simulator(new ProgramHost(data.bytes));
    } else {
        self.postMessage(obey(data));
    }
});

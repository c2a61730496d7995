import { ALL_MOTORS, type Answer, type ToService, type Trouble } from "./protocol";
import { hex } from "./unit_messages";
import type { Exchange, Got } from "./unit_orders";
import { Refusal } from "./unit_place";

/** What the page asks for, with its last sign of life; `failed`: why the port that it wants could not be opened. */
export type Asked = ToService & { beat?: number; failed?: Trouble };
export type Order = Extract<Asked, { type: "request" | "speed" | "resume" | "reset" | "connect" | "disconnect" }>;
export type StopOrder = Extract<Asked, { type: "stop" }>;

export function nameOf(order: Order | StopOrder): string {
    return order.type === "request" ? order.message : order.type;
}

function motorOf(order: Order | StopOrder): number | null {
    if ("motor" in order) {
        return order.motor;
    }
    return order.type === "connect" || order.type === "disconnect" ? null : ALL_MOTORS;
}

/** What came of an order, and the messages by which. */
export function answerOf(order: Order | StopOrder, node: number, got: Got | Refusal, last: Exchange): Answer {
    const isGood = !(got instanceof Refusal);
    return {
        id: "id" in order ? order.id : null,
        from: 1,
        message: nameOf(order),
        node,
        motor: motorOf(order),
        request_bytes: null,
        answer_bytes: null,
        request_message: hex(last.request),
        answer_message: hex(last.answer),
        text: isGood ? got.text : null,
        values: isGood ? got.values : null,
        error: isGood ? null : got.trouble,
    };
}

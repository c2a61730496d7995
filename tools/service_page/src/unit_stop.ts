import type { Bytes } from "./program_host";
import { ALL_MOTORS } from "./protocol";
import * as messages from "./unit_messages";
import { pause } from "./unit_orders";
import { BROADCAST, LineTrouble, ONCE, Refusal, type Wait } from "./unit_place";

export const STOP = messages.request(messages.SET_COMMAND, ALL_MOTORS, "K");
/** So often a unit is asked that does not answer. */
const SILENT_ROUNDS = 4;
const PAUSE_MS = 20;
/** So long a unit is told to stop that answers and does not. */
const ANSWERING_MS = 12_000;

export interface Stopped {
    /** The nodes that have not confirmed. */
    left: number[];
    /** The last answer to K. */
    answer: Bytes;
}

/** What a stop speaks through. */
export interface StopTalk {
    ask(request: Bytes, wait: Wait, node: number): Promise<Bytes>;
    /** Whether the status that has come says that all motors brake or stand. */
    isStopped(node: number, status: Bytes): boolean;
    /** Is told of those that have not confirmed yet. */
    left(nodes: number[]): void;
}

/** Sends K to all units at once, then to each node until it has confirmed. */
export async function stopAll(talk: StopTalk, nodes: number[]): Promise<Stopped> {
    const found: Stopped = { left: [...nodes], answer: new Uint8Array() };
    const silent = new Map<number, number>();
    const end_ms = performance.now() + ANSWERING_MS;
    await talk.ask(STOP, ONCE, BROADCAST);
    let asked = [...nodes];
    while (asked.length > 0 && performance.now() < end_ms) {
        await pause(PAUSE_MS);
        for (const node of asked) {
            if (await confirms(talk, node, found, silent)) {
                found.left = found.left.filter((each) => each !== node);
                talk.left(found.left);
            }
        }
        asked = found.left.filter((node) => (silent.get(node) ?? 0) < SILENT_ROUNDS);
    }
    return found;
}

/**
 * Sends K; whether the unit has taken it, and says that its motors brake or stand. A motor that slows down because of
 * `\` does not take K: it is sent again until it does. A unit that does not know Get Status confirms by taking it.
 */
async function confirms(
    talk: StopTalk, node: number, found: Stopped, silent: Map<number, number>,
): Promise<boolean> {
    try {
        found.answer = await talk.ask(STOP, ONCE, node);
        messages.content(found.answer, messages.SET_COMMAND, ALL_MOTORS);
        return talk.isStopped(node, await talk.ask(Uint8Array.of(messages.GET_STATUS), ONCE, node));
    } catch (error) {
        if (!(error instanceof Refusal) || error.trouble.kind === "PortLost") {
            throw error;
        }
        if (error instanceof LineTrouble) {
            silent.set(node, (silent.get(node) ?? 0) + 1);
        }
        return error instanceof messages.UnknownMessage && found.answer[0] === messages.SET_COMMAND;
    }
}

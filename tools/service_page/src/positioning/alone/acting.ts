import { Refusal } from "../../unit_place";
import { AXES, type ToService } from "../protocol";
import { axisText } from "./axis_state";
import { CLOCK_HALF, type Instruction, type Unit } from "./client";
import { register, wordsOf, wordsOfValue } from "./table";

/** The method that sets the position of where the axis is. */
const HERE = 37;
const ALL: readonly number[] = AXES;

export type OfAxis = Extract<ToService, { type: "take" | "release" | "capture" | "control" | "measure" | "home" }>;

/** Does what is for one axis; what has come of it. */
export async function act(unit: Unit, order: OfAxis): Promise<string> {
    if (!ALL.includes(order.axis)) {
        throw new Refusal(`axis ${order.axis} is not possible`, "reload the page");
    }
    await actOn(unit, order);
    return axisText(await unit.axis(order.axis), unit.names);
}

async function actOn(unit: Unit, order: OfAxis): Promise<void> {
    const { axis } = order;
    if (order.type === "take") {
        await unit.instruct(axis, "POS_INIT", [0]);
    } else if (order.type === "release") {
        await unit.instruct(axis, "POS_RESET");
    } else if (order.type === "capture") {
        await unit.instruct(axis, "POS_CAPTURE");
    } else if (order.type === "control") {
        await unit.control(axis, order.feed, order.permitted);
    } else if (order.type === "measure") {
        await measure(unit, order);
    } else {
        await home(unit, order);
    }
}

/** With a feed the axis is taken if need be, and moves. */
async function measure(unit: Unit, { axis, um, accel, absolute, feed }: Extract<OfAxis, { type: "measure" }>): Promise<void> {
    const name: Instruction = absolute ? "POS_MODE_ABS" : "POS_MODE";
    const parameters = measureWords(um, accel, 0);
    if (feed !== undefined) {
        await unit.beTaken(axis);
    }
    await unit.instruct(axis, name, parameters);
    if (feed !== undefined) {
        await unit.control(axis, feed, true);
    }
}

async function home(unit: Unit, { axis, method, um, accel, feed }: Extract<OfAxis, { type: "home" }>): Promise<void> {
    const parameters = measureWords(um, accel, method);
    await unit.beTaken(axis);
    await unit.instruct(axis, "POS_HOME", parameters);
    if (method !== HERE) {
        await unit.control(axis, feed, true);
    }
}

/** SPACE, LEN and ACCEL, which stand side by side. */
function measureWords(um: number, accel: number, space: number): number[] {
    if (!Number.isInteger(um) || Math.abs(um) >= CLOCK_HALF) {
        throw new Refusal(`${um / 1000} mm: too far`, "a way has at most 2147483.647 mm");
    }
    return [space, ...wordsOfValue(um, wordsOf(register("LEN"))), accel];
}

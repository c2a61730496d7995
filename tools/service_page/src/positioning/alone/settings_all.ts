import { AXES, type Part } from "../protocol";
import { textOf, type AllSettings } from "../settings_file";
import { Refusal } from "../../unit_place";
import { has, stateText } from "./axis_state";
import type { Unit } from "./client";

export { textOf, type AllSettings };

const STEPS_PER_UM_MAX = 500;
const UM_PER_STEP_MAX = 10_000;
const PARTS: readonly Part[] = ["unit", "axis1", "axis2", "axis3", "axis4"];

/** All settings of a unit. */
export async function readAll(unit: Unit): Promise<AllSettings> {
    const found = [];
    for (const [axis, part] of PARTS.entries()) {
        found.push([part, await unit.settings(axis)]);
    }
    return Object.fromEntries(found) as AllSettings;
}

/** Writes those of some settings that are not as they were found; each is read back. */
export async function write(unit: Unit, wanted: Partial<AllSettings>, found: AllSettings): Promise<void> {
    for (const part of PARTS) {
        requireQuotient(part, { ...found[part], ...wanted[part] });
    }
    for (const [axis, part] of PARTS.entries()) {
        await unit.writeSettings(axis, wanted[part] ?? {}, found[part]);
    }
}

function requireQuotient(part: Part, { STEPS: steps = 1, MICROMETRES: um = 1 }: Record<string, number>): void {
    if (steps > STEPS_PER_UM_MAX * um || um > UM_PER_STEP_MAX * steps) {
        const cause = `${part}: ${steps} STEPS in ${um} MICROMETRES: the quotient is 1/${UM_PER_STEP_MAX} to ${STEPS_PER_UM_MAX}`;
        throw new Refusal(cause, "nothing was written");
    }
}

/** Refuses to write settings of parts while an axis that they concern is taken or moves. */
export async function requireFree(unit: Unit, parts: string[]): Promise<void> {
    for (const axis of AXES) {
        if (!parts.includes("unit") && !parts.includes(`axis${axis}`)) {
            continue;
        }
        const state = await unit.axis(axis);
        if (has(state, "DISP") || has(state, "JEDE")) {
            throw new Refusal(`axis ${axis} is ${stateText(state, unit.names)}, and settings wait for it`, "reset comes first");
        }
    }
}

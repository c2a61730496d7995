import { checkProgram } from "./api";
import { t } from "./i18n";
import type { MachineContent } from "./machine_file";
import type { MotorCurve } from "./protocol";
import { positionWords } from "./scale";
import { Cell } from "./signal";

/** What no motor of the machine must exceed. The unit knows nothing of it. */
type Limits = NonNullable<MachineContent["motors"][number]["limits"]>;

const limits = new Cell<readonly Limits[]>([]);

/** Calls the listener when other limits hold. */
export const onLimits = (listener: () => void): void => limits.onChange(listener);

export const setLimits = (machine: MachineContent | null): void =>
    limits.set((machine?.motors ?? []).map((motor) => motor.limits ?? {}));

/** The highest speed of a motor, steps/s. */
export const speedLimit = (motor: number): number => limits.value[motor - 1]?.speed_max_steps_per_s ?? Infinity;

/** V after `\`, steps/s. */
const START = 1000;

/** A speed above the limit, in a program. */
export interface TooFast {
    motor: number;
    line: number;
    column: number;
    command: string;
    limit: number;
}

/** The first S or V of these programs, by motor, that is above the limit, or move with the V that a program starts with. */
export async function tooFast(programs: readonly (readonly [motor: number, text: string])[]): Promise<TooFast | null> {
    for (const [motor, text] of programs) {
        const limit = speedLimit(motor);
        const { listing = [] } = limit === Infinity ? {} : await checkProgram(text);
        // The listing has what is stored, and so no reset.
        let isStart = text.replace(/\{[^}]*/g, "").includes("\\");
        for (const [line, column, command] of listing) {
            isStart &&= !command.startsWith("V");
            const isMove = isStart && /^[RYGH]/.test(command);
            if (Number(isMove ? START : /^[SV](\d+)$/.exec(command)?.[1]) > limit) {
                return { motor, line, column, command: isMove ? `${command} (V${START})` : command, limit };
            }
        }
    }
    return null;
}

/** Where a motor would leave its limits, in words; null: nowhere. */
export function beyondWords(motor: number, { before, position }: MotorCurve): string | null {
    const { position_min_steps: low = -Infinity, position_max_steps: high = Infinity } = limits.value[motor - 1] ?? {};
    const [lowest, highest] = position.reduce(([least, most], at) => [Math.min(least, at), Math.max(most, at)], [before, before]);
    if (highest > high) {
        return t("limits.highest", { position: positionWords(motor, highest) });
    }
    return lowest < low ? t("limits.lowest", { position: positionWords(motor, lowest) }) : null;
}

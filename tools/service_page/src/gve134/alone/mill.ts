import type { MachineContent, MachineMotor } from "../../machine_file";
import { AXES, type Machine, type MachineAxis } from "../protocol";

/** A reference run, as W has it, and where the axis is after it. */
interface Homing {
    way_steps: number;
    speed_steps_per_s: number;
    back_steps: number;
    back_speed_steps_per_s: number;
    position_steps?: number;
    /** Whether the switch opens when it is hit; it does if nothing is said. */
    opens?: boolean;
}

interface AxisPart {
    speed_steps_per_s: number;
    accel_steps_per_s2: number;
    jump_steps_per_s: number;
    homing?: Homing;
}

/** The part of a machine file for this unit, which has passed the schema. */
interface UnitPart {
    axes: Partial<Record<string, AxisPart>>;
    spindle?: { rpm: number };
    corner_deviation_mm?: number;
}

/** A machine with this unit: what the page is told of it, and what its axes are. */
export interface Mill {
    machine: Machine;
    axes: (AxisPart | null)[];
    followsCorners: boolean;
}

/** Why a machine file does not serve this unit; without a motor: the part for the unit is missing. */
export interface NoMill {
    motor: number | null;
    wanted: "steps_per_mm" | "steps_per_degree";
}

const NO_AXIS_SPEED = 200_000;
const ACCEL_UNIT = 1000;
const ACCEL_TOP = 8000;
/** Z goes first, out of the way of the others. */
const HOMING_ORDER = [2, 0, 1, 3];

/** What a machine says of this unit. */
export function millOf({ name, motors, gve134 }: MachineContent): Mill | NoMill {
    const part = gve134 as UnitPart | undefined;
    if (part === undefined) {
        return { motor: null, wanted: "steps_per_mm" };
    }
    const axes = AXES.map((letter) => part.axes[letter.toLowerCase()] ?? null);
    const lacking = axes.findIndex((axis, index) => axis !== null && scaleOf(motors[index], index) === null);
    if (lacking >= 0) {
        return { motor: lacking + 1, wanted: isLinear(lacking) ? "steps_per_mm" : "steps_per_degree" };
    }
    const told = axes.map((axis, index) => (axis === null ? null : axisOf(axis, motors[index], index)));
    const machine = { name, axes: told, rpm: part.spindle?.rpm ?? null };
    return { machine, axes, followsCorners: part.corner_deviation_mm !== undefined };
}

const isLinear = (index: number): boolean => index < AXES.length - 1;

function scaleOf(motor: MachineMotor | undefined, index: number): number | null {
    return (isLinear(index) ? motor?.steps_per_mm : motor?.steps_per_degree) ?? null;
}

function axisOf(axis: AxisPart, motor: MachineMotor | undefined, index: number): MachineAxis {
    const { position_min_steps: lowest = null, position_max_steps: highest = null } = motor?.limits ?? {};
    return {
        unit: isLinear(index) ? "mm" : "degree", steps_per_unit: scaleOf(motor, index) ?? 1, speed: axis.speed_steps_per_s,
        lowest, highest, homes: axis.homing !== undefined,
    };
}

/** The lines of the reference run of an axis, or of all that have one, as tools/gve134 gcode writes G28; null: there is none. */
export function homingText({ axes, followsCorners }: Mill, letter: string | null): string | null {
    const isMeant = (index: number): boolean => axes[index]?.homing !== undefined && (letter ?? AXES[index]) === AXES[index];
    const meant = HOMING_ORDER.filter(isMeant);
    if (meant.length === 0) {
        return null;
    }
    const speeds = axes.map((axis) => axis?.speed_steps_per_s ?? NO_AXIS_SPEED);
    const jumps = axes.map((axis) => axis?.jump_steps_per_s ?? 0);
    const begin = ["L0,0,0,0", "T1", "VK", "B200000", ...(followsCorners ? ["$1"] : []), `VL${speeds.join()}`, `VJ${jumps.join()}`];
    const accelOf = (index: number): number => Math.min(Math.floor((axes[index]?.accel_steps_per_s2 ?? 0) / ACCEL_UNIT), ACCEL_TOP);
    const runs = meant.flatMap((index, turn) => {
        const before = turn === 0 ? null : accelOf(meant[turn - 1] ?? index);
        return homingLines(axes, index, accelOf(index) === before ? [] : [`A${accelOf(index)}`]);
    });
    return `${[...begin, ...runs].join("\n")}\n`;
}

function homingLines(axes: Mill["axes"], index: number, accel: string[]): string[] {
    const { homing } = axes[index] ?? {};
    if (homing === undefined) {
        return [];
    }
    const opening = axes.reduce((bits, axis, each) => bits | (axis?.homing && axis.homing.opens !== false ? 1 << each : 0), 0);
    const { way_steps: way, speed_steps_per_s: speed, back_steps: back, back_speed_steps_per_s: slow } = homing;
    return [
        ";@wait 0.01", // at rest
        `SW2,${opening.toString(16).toUpperCase().padStart(2, "0")}`,
        ...accel,
        `W${AXES[index]}${[way, speed, back, slow].join()}`,
        `N${AXES[index]}${homing.position_steps ?? 0}`,
    ];
}

/* The parts of a machine that are edited in fields of their own. Pure. */
import type { MachineContent, MachineMotor } from "./machine_file";

/** undefined: there is none. NaN: what was typed is no number. */
export type Value = string | number | undefined;

export interface Part {
    read: (machine: MachineContent) => Value;
    /** The same machine with another value. */
    written: (machine: MachineContent, value: Value) => MachineContent;
}

export type Unit = "mm" | "degree";

type LimitName = keyof NonNullable<MachineMotor["limits"]>;
type NamesName = "input_names" | "output_names";

/** How far a step goes; `unit` is asked for when it is written. */
export function scalePart(index: number, unit: () => Unit): Part {
    return {
        read: ({ motors }) => motors[index]?.steps_per_mm ?? motors[index]?.steps_per_degree,
        written: (machine, value) =>
            ofMotor(machine, index, { steps_per_mm: undefined, steps_per_degree: undefined, [`steps_per_${unit()}`]: value }),
    };
}

export const unitOf = (machine: MachineContent, index: number): Unit =>
    machine.motors[index]?.steps_per_degree === undefined ? "mm" : "degree";

export const namePart = (index: number): Part => ({
    read: ({ motors }) => motors[index]?.name,
    written: (machine, value) => ofMotor(machine, index, { name: value }),
});

export const limitPart = (index: number, name: LimitName): Part => ({
    read: ({ motors }) => motors[index]?.limits?.[name],
    written: (machine, value) =>
        ofMotor(machine, index, { limits: changed({ ...machine.motors[index]?.limits, [name]: value }) }),
});

export const wiringPart = (names: NamesName, number: number): Part => ({
    read: (machine) => machine[names]?.[number],
    written: (machine, value) => whole({ ...machine, [names]: changed({ ...machine[names], [number]: value }) }),
});

function ofMotor(machine: MachineContent, index: number, change: Record<string, unknown>): MachineContent {
    const motors = machine.motors.map((motor, at) => (at === index ? whole<MachineMotor>({ ...motor, ...change }) : motor));
    return { ...machine, motors };
}

/** Without what is undefined; the rules judge whether that is what it should be. */
const whole = <T extends object>(told: object): T =>
    Object.fromEntries(Object.entries(told).filter(([, value]) => value !== undefined)) as T;

/** undefined: nothing is left. */
function changed(told: Record<string, Value>): Record<string, Value> | undefined {
    const left = whole<Record<string, Value>>(told);
    return Object.keys(left).length === 0 ? undefined : left;
}

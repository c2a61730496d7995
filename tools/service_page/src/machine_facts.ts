import { numberText, t } from "./i18n";
import type { MachineContent, MachineMotor } from "./machine_file";

const DIGITS = 20;

/** What is wired where, how far a step goes, and what is not to be exceeded. */
export function factsOf(machine: MachineContent): string[] {
    const motors = machine.motors.map((motor, index) => [index + 1, motorFacts(motor).join(", ")] as const);
    return [
        ...motors.filter(([, facts]) => facts !== "").map(([motor, facts]) => `${t("motor.one", { motor })}: ${facts}`),
        ...namedLines(machine),
    ];
}

/** The same, one on a line, after the name of the machine. */
export function factLines(machine: MachineContent): string[] {
    const motors = machine.motors.flatMap((motor, index) =>
        motorFacts(motor).map((fact) => `${t("motor.one", { motor: index + 1 })}: ${fact}`),
    );
    return [`${t("machine.name")}: ${machine.name}`, ...motors, ...namedLines(machine)];
}

function namedLines({ input_names, output_names }: MachineContent): string[] {
    const named = (key: "live.input" | "live.output", names: Record<string, string> = {}): string[] =>
        Object.entries(names).map(([number, name]) => `${t(key, { number })}: ${name}`);
    return [...named("live.input", input_names), ...named("live.output", output_names)];
}

function motorFacts({ name, steps_per_mm: mm, steps_per_degree: degree, limits = {} }: MachineMotor): string[] {
    const { position_min_steps: low, position_max_steps: high, speed_max_steps_per_s: speed } = limits;
    return [
        name ?? "",
        mm === undefined ? "" : t("machine.perMm", { steps: numberText(mm, DIGITS) }),
        degree === undefined ? "" : t("machine.perDegree", { steps: numberText(degree, DIGITS) }),
        low === undefined ? "" : t("machine.lowest", { steps: numberText(low) }),
        high === undefined ? "" : t("machine.highest", { steps: numberText(high) }),
        speed === undefined ? "" : t("machine.fastest", { steps: numberText(speed) }),
    ].filter((fact) => fact !== "");
}

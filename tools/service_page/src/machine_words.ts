import type { RuleError } from "machine-rules";
import { isMachineKey, type MachineKey, type MachineWords } from "./common/machine_words";
import { numberText } from "./language";
import type { NoMachine } from "./machine_file";

/** Something that is wrong with a machine file, and where. */
export interface Words {
    place: { motor: number | null; names: string[] };
    key: MachineKey;
    values: Record<string, string | number>;
}

/** More than four programs, notes and inputs of the greatest length. */
export const MACHINE_BYTES_MAX = 2_000_000;
const PROBLEMS_MAX = 5;
const LIMITS = ["minimum", "maximum", "exclusiveMinimum", "minLength", "maxLength", "minItems", "maxItems"];

/** What a rule of the schema says of a file. */
export function ruleWords({ instancePath, keyword, params }: RuleError, content: unknown): Words {
    const [, ...path] = instancePath.split("/");
    const [first, second, ...rest] = path;
    const isMotor = first === "motors" && second !== undefined;
    const names = isMotor ? rest : [first, second, ...rest].filter((name) => name !== undefined);
    const place = { motor: isMotor ? Number(second) + 1 : null, names };
    const key = `machine.rule.${keyword === "type" ? String(params["type"]) : keyword}`;
    const name = String(params["missingProperty"] ?? params["additionalProperty"] ?? "");
    const limit = LIMITS.includes(keyword) ? Number(params["limit"]) : "";
    const data = path.reduce((part, step) => Object(part)[step] as unknown, content);
    const value = typeof data === "number" ? String(data) : "";
    return { place, key: isMachineKey(key) ? key : "machine.rule.other", values: { name: name.slice(0, 40), limit, value } };
}

function rule(key: MachineKey, values: Words["values"], t: MachineWords): string {
    const shown = Object.entries(values).map(([name, value]) => [name, typeof value === "number" ? numberText(value) : value]);
    return t(key, Object.fromEntries(shown) as Record<string, string>);
}

/** In the language of the page: the place first. */
function sentence({ place: { motor, names }, key, values }: Words, t: MachineWords): string {
    const place = [...(motor === null ? [] : [t("machine.motor", { motor })]), ...names].join(", ");
    return `${place}${place === "" ? "" : ": "}${rule(key, values, t)}`;
}

/** What is wrong with a value that a machine does not take, beside the field of the value. */
export function ruleOf({ key, problems: [first] }: NoMachine, t: MachineWords): string {
    const { key: broken, values } = first ?? { key, values: {} };
    return rule(broken === "machine.limitsCrossed" ? "machine.crossed" : broken, values, t);
}

/** Why a file is no machine, in the language of the page. */
export function troubleOf({ key, problems }: NoMachine, t: MachineWords): string {
    const told = problems.slice(0, PROBLEMS_MAX).map((problem) => sentence(problem, t));
    const more = problems.length > PROBLEMS_MAX ? ["…"] : [];
    return [t(key), ...told, ...more].filter((words) => words !== "").join("; ");
}

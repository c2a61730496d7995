import type { RuleError } from "machine-rules";
import { isKey, numberText, t, type Key } from "./i18n";

/** Something that is wrong with a machine file, and where. */
export interface Words {
    place: { motor: number | null; names: string[] };
    key: Key;
    values: Record<string, string | number>;
}

const LIMITS = ["minimum", "maximum", "exclusiveMinimum", "minLength", "maxLength", "minItems", "maxItems"];

/** What a rule of the schema says of a file. */
export function ruleWords({ instancePath, keyword, params, data }: RuleError): Words {
    const [, first, second, ...rest] = instancePath.split("/");
    const isMotor = first === "motors" && second !== undefined;
    const names = isMotor ? rest : [first, second, ...rest].filter((name) => name !== undefined);
    const place = { motor: isMotor ? Number(second) + 1 : null, names };
    const key = `machine.rule.${keyword === "type" ? String(params["type"]) : keyword}`;
    const name = String(params["missingProperty"] ?? params["additionalProperty"] ?? "");
    const limit = LIMITS.includes(keyword) ? numberText(Number(params["limit"])) : "";
    const value = typeof data === "number" ? String(data) : "";
    return { place, key: isKey(key) ? key : "machine.rule.other", values: { name: name.slice(0, 40), limit, value } };
}

/** In the language of the page: the place first. */
export function sentence({ place: { motor, names }, key, values }: Words): string {
    const place = [...(motor === null ? [] : [t("machine.motor", { motor })]), ...names].join(", ");
    return `${place}${place === "" ? "" : ": "}${t(key, values)}`;
}

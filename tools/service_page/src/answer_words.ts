import { told, troubleText } from "./common/told";
import { isKey, numberText, t } from "./i18n";
import type { Answer, FoundUnit } from "./protocol";

type Values = NonNullable<Answer["values"]>;

/** One phrase for each motor of a table by motor numbers. */
function perMotor(
    table: Record<string, number>,
    key: "answer.position" | "answer.store" | "answer.sendAll",
): string {
    const phrases = Object.entries(table).map(([motor, value]) => t(key, { motor, value: numberText(value) }));
    return phrases.join(", ");
}

function sent(values: Values): string {
    const words = { commands: numberText(values.commands ?? 0), messages: numberText(values.messages ?? 1) };
    const overflow = values.overflow ? [t("answer.overflow")] : [];
    return [t("answer.send", words), ...overflow, ...(values.notes ?? []).map(told)].join("; ");
}

function sentToAll(commands: Record<string, number>, values: Values): string {
    const overflow = values.overflow ? [t("answer.overflow")] : [];
    const start = t(values.together ? "answer.together" : "answer.apart");
    return [perMotor(commands, "answer.sendAll"), start, ...overflow, ...(values.notes ?? []).map(told)].join("; ");
}

function foundWords(found: FoundUnit[]): string {
    const units = found.map(({ node, version, remark }) => `${node} (${[version, told(remark)].filter(Boolean).join(", ")})`);
    return units.length > 0 ? t("answer.found", { units: units.join(", ") }) : t("scan.none");
}

/** What the values of an answer say; null where its text says as much. */
function valueWords(message: string, values: Values): string | null {
    if (values.found) {
        return foundWords(values.found);
    }
    if (values.sent) {
        return sentToAll(values.sent, values);
    }
    if (values.everywhere && message === "store") {
        return t("answer.toldToStore");
    }
    if (values.alone !== undefined) {
        return t("answer.alone", { text: values.alone });
    }
    if (values.positions) {
        return perMotor(values.positions, "answer.position");
    }
    if (values.stored) {
        return perMotor(values.stored, "answer.store");
    }
    if (values.version !== undefined) {
        return t("answer.version", { version: values.version, date: values.date ?? "" });
    }
    if (message === "send" && values.commands !== undefined) {
        return sent(values);
    }
    if (values.steps !== undefined) {
        return t("answer.progress", { steps: numberText(values.steps), command: values.command ?? 0 });
    }
    if (values.speed !== undefined) {
        const motors = values.motors?.join(", ") ?? "";
        return t("answer.speed", { speed: numberText(values.speed), motors });
    }
    return values.points?.length === 0 ? t("answer.noTable") : null;
}

/** An answer in the language of the page. */
export function answerWords(answer: Answer): string {
    if (answer.error) {
        return troubleText(answer.error);
    }
    const words = answer.values ? valueWords(answer.message, answer.values) : null;
    const fixed = `answer.${answer.message}.done`;
    const nobody = answer.values?.everywhere ? `${t("answer.everywhere")} ` : "";
    return nobody + (words ?? (isKey(fixed) ? t(fixed) : told(answer.text ?? t("log.done"))));
}

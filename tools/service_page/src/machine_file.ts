/*
 * A machine in one file (.rkm), as tools/rkm04_tools/machine/README.md tells it. A file is taken as a whole or not at
 * all, so that nothing of it is lost when it is saved again. Pure.
 */
import validate from "machine-rules";
import type { MachineKey } from "./common/machine_words";
import { decodeProgram, encodeProgram, type FileForm } from "./file_form";
import { formatInputs, parseInputs } from "./inputs_text";
import { ruleWords, type Words } from "./machine_words";

const FORMAT = "rkm04-machine";
const VERSION = 1;

export interface MachineMotor {
    name?: string;
    program: string;
    steps_per_mm?: number;
    steps_per_degree?: number;
    limits?: { position_min_steps?: number; position_max_steps?: number; speed_max_steps_per_s?: number };
}

/** What has passed the schema. */
export interface MachineContent {
    format: typeof FORMAT;
    version: number;
    name: string;
    notes?: string;
    motors: MachineMotor[];
    inputs?: string;
    input_names?: Record<string, string>;
    output_names?: Record<string, string>;
    /** What a GVE134 unit needs to know: kept as it is. */
    gve134?: object;
}

/** A string of JSON, with the colon that follows a name. */
const STRING = /"[^"\\]*(?:\\.[^"\\]*)*"\s*:?/g;
/** Half of a character that takes two units. */
const HALF = /\p{Cs}/u;

/** Why a content is none; `problems` are to be shown in its words. */
export interface NoMachine {
    key: MachineKey;
    problems: Words[];
}

const no = (key: MachineKey, problems: Words[] = []): NoMachine => ({ key, problems });

export const isMachine = (found: MachineContent | NoMachine): found is MachineContent => "motors" in found;

export const newMachine = (name: string): MachineContent => ({
    format: FORMAT,
    version: VERSION,
    name,
    notes: "",
    motors: Array.from({ length: 4 }, () => ({ program: "" })),
});

/** Reads a file. */
export function parseMachine(bytes: Uint8Array): MachineContent | NoMachine {
    try {
        return judgedText(new TextDecoder("utf-8", { fatal: true }).decode(bytes));
    } catch (error) {
        return no(error instanceof SyntaxError ? "machine.notJson" : "machine.notUtf8");
    }
}

/** Refuses what JSON.parse() takes and would not be saved again. */
function judgedText(text: string): MachineContent | NoMachine {
    let names = -1; // the whole has one, which is empty
    let isText = true;
    const content: unknown = JSON.parse(text, function (this: unknown, _, value: unknown) {
        names += Array.isArray(this) ? 0 : 1;
        isText &&= typeof value !== "string" || !HALF.test(value);
        return value;
    });
    const written = (text.match(STRING) ?? []).filter((part) => part.endsWith(":")).length;
    return written > names ? no("machine.twice") : isText ? judged(content) : no("machine.half");
}

/** A content that is a machine, or why it is none. */
export function judged(content: unknown): MachineContent | NoMachine {
    const { format, version } = Object(content) as { format?: unknown; version?: unknown };
    if (format !== FORMAT || !Number.isInteger(version) || Number(version) < 1) {
        return no("machine.notMachine");
    }
    if (Number(version) > VERSION) {
        return no("machine.later");
    }
    if (!validate(content)) {
        return no("machine.wrong", (validate.errors ?? []).map((error) => ruleWords(error, content)));
    }
    const machine = content as MachineContent;
    const problems = [...crossed(machine)];
    return problems.length > 0 ? no("machine.wrong", problems) : machine;
}

/** What a schema cannot say. */
function* crossed({ motors, inputs = "" }: MachineContent): Generator<Words> {
    for (const [index, { limits = {}, program }] of motors.entries()) {
        const { position_min_steps: low = -Infinity, position_max_steps: high = Infinity } = limits;
        const place = { motor: index + 1, names: [] };
        if (low > high) {
            yield { place, key: "machine.limitsCrossed", values: {} };
        }
        if (program.includes("\0")) {
            yield { place, key: "machine.noText", values: {} };
        }
    }
    if (parseInputs(inputs) === null) {
        yield { place: { motor: null, names: ["inputs"] }, key: "machine.inputs", values: {} };
    }
}

/** A program for the editor. */
export function programOf(machine: MachineContent, motor: number, name: string): { text: string; form: FileForm } {
    const text = machine.motors[motor - 1]?.program ?? "";
    const found = decodeProgram(name, new TextEncoder().encode(text));
    if (typeof found !== "object") {
        throw new Error(`the program of motor ${motor} is no text`);
    }
    return found;
}

/** The same machine with programs as the editor has them, and inputs as they are now. */
export function withPrograms(
    machine: MachineContent, programs: { text: string; form: FileForm }[], inputs: string,
): MachineContent {
    const motors = machine.motors.map((motor, index) => {
        const edited = programs[index];
        return edited === undefined ? motor : { ...motor, program: written(edited) };
    });
    const changed = { ...machine, motors };
    const now = parseInputs(inputs);
    const isSame = now !== null && formatInputs(now) === formatInputs(parseInputs(machine.inputs ?? "") ?? []);
    if (isSame) {
        return changed;
    }
    return { ...changed, inputs: now === null ? inputs : now.map((change) => `${change.join(",")}\n`).join("") };
}

export const toText = (machine: MachineContent): string => `${JSON.stringify(machine, null, 2)}\n`;

/** With the ends of line that the program had. */
function written({ text, form }: { text: string; form: FileForm }): string {
    return new TextDecoder().decode(encodeProgram({ ...form, encoding: "utf-8" }, text).bytes);
}

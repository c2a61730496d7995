import { ProgramHost, type Bytes } from "./program_host";
import { MOTORS, type Curve, type CurveRequest, type MotorCurve, type Problem, type Verdict } from "./protocol";

const PROBLEMS_MAX = 100;
/** Characters: more than 700 commands with comments. */
export const TEXT_MAX = 200_000;
/** What a simulation may take; only programs that never wait need more for a minute. */
const REAL_SECONDS = "0.5";
/** States in which only a message makes the program go on, in words. */
const STATES: Record<string, string> = {
    idle: "done",
    held: "held, waits for ]",
    stopped: "stopped by K",
    ended: "stopped by X",
    failed: "error",
};

export interface Checked {
    commands: { line: number; column: number; ordinal: number; opcode: string; text: string }[];
    stored: number;
    problems: Problem[];
    more: number;
}

interface Summary {
    seconds: number;
    ended: "idle" | "real" | "time";
    motors: {
        motor: number; moves: number; pulses: number; peak_speed: number; state: string; error: string; place: number; held: boolean;
    }[];
}

type Told = "t" | "speed" | "position" | "before" | "steps" | "command" | "commands" | "commands_cut";

interface Lines {
    motors: ({ motor: number } & Pick<MotorCurve, Told>)[];
    outputs: Curve["outputs"];
}

/** Answers as the service does, with the same program compiled for WebAssembly. */
export class Simulator {
    readonly #host: ProgramHost;

    constructor(host: ProgramHost) {
        this.#host = host;
    }

    check(text: string): Verdict {
        const { commands, problems, more, stored } = this.read(text);
        const told = problems.slice(0, PROBLEMS_MAX);
        const resets = commands.some((each) => each.opcode === "RESET");
        const isGood = problems.every(({ severity }) => severity !== "error");
        const listing = isGood ? commands.filter(({ ordinal }) => ordinal > 0).map(listed) : [];
        return { problems: told, more: problems.length - told.length + more, commands: stored, listing, resets };
    }

    curve({ programs, inputs, seconds, points, range }: CurveRequest): Curve {
        const checked = new Map(Object.entries(programs).map(([motor, text]) => [Number(motor), this.read(text)]));
        for (const [motor, { problems }] of checked) {
            const first = problems.find(({ severity }) => severity === "error");
            if (first) {
                return refusal(`motor ${motor}, line ${first.line}, column ${first.column}: ${first.message}`);
            }
        }
        const files = new Map<string, Bytes>();
        const words = ["sim", "--for", seconds.toFixed(6), "--real", REAL_SECONDS];
        words.push("--curve", "/curve.json", "--points", String(points));
        if (range) {
            words.push("--from", Math.max(0, range[0]).toFixed(6), "--to", Math.max(0, range[1]).toFixed(6));
        }
        for (const [motor, text] of Object.entries(programs)) {
            files.set(`${motor}.rks`, encode(text));
            words.push("--motor", `${motor}=/${motor}.rks`);
        }
        if (inputs.length > 0) {
            const rows = inputs.map(([ms, input, level]) => `${ms.toFixed(6)},${input},${level}\n`);
            files.set("inputs.csv", encode(rows.join("")));
            words.push("--inputs", "/inputs.csv");
        }
        try {
            const told = JSON.parse(this.#host.run(words, files)) as Summary;
            const lines = JSON.parse(new TextDecoder().decode(files.get("curve.json"))) as Lines;
            return joined(told, lines, checked);
        } catch (error) {
            return refusal(error instanceof Error ? error.message : String(error));
        }
    }

    /** All that the parser says of a program. */
    read(text: string): Checked {
        if (text.length > TEXT_MAX) {
            throw new Error(`the text is too long; ${TEXT_MAX} characters are the most`);
        }
        return JSON.parse(this.#host.run(["check", "-"], new Map(), encode(text))) as Checked;
    }
}

function encode(text: string): Bytes {
    return new TextEncoder().encode(text);
}

function refusal(error: string): Curve {
    return { seconds: 0, ended: false, motors: {}, outputs: [], error };
}

const listed = ({ line, column, text }: Checked["commands"][number]): [number, number, string] => [line, column, text];

/** With the places of commands in the program, where `[` stands before it in the memory, and `]` after it. */
function placed<T extends Pick<MotorCurve, "command" | "commands">>(line: T, held: boolean, stored: number): T {
    const ordinalOf = (place: number): number => Math.min(Math.max(place - (held ? 1 : 0), 0), stored);
    const commands = line.commands.map(([at, place]): [number, number] => [at, ordinalOf(place)]);
    return { ...line, command: ordinalOf(line.command), commands };
}

/** The summary and the lines, for the motors that have a program. */
function joined(told: Summary, lines: Lines, checked: Map<number, Checked>): Curve {
    const motors: Record<string, MotorCurve> = {};
    for (const motor of MOTORS) {
        const one = told.motors.find((each) => each.motor === motor);
        const line = lines.motors.find((each) => each.motor === motor);
        const program = checked.get(motor);
        if (one && line && program) {
            const at = program.commands.find(({ ordinal }) => ordinal === one.place && ordinal > 0);
            const words = at ? `at ${at.text}, line ${at.line}` : one.state;
            const { moves, pulses, state } = one;
            const ended = { peak: one.peak_speed, state_text: STATES[state] ?? words, error: one.error || null };
            motors[motor] = { ...placed(line, one.held, program.stored), moves, pulses, ...ended };
        }
    }
    const { seconds, ended } = told;
    const cut = ended === "real";
    return { seconds, ended: ended === "idle", cut, motors, outputs: lines.outputs, error: null };
}

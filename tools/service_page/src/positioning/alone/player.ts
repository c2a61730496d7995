import { ProgramHost, type Bytes } from "../../program_host";
import type { MotorCurve } from "../../protocol";
import type { AxisName } from "../protocol";
import { nameOf, type AxisValues } from "./axis_state";

const SCRIPT = "script.csv";
const INPUTS = "inputs.csv";
const CURVE = "curve.json";
const POINTS = 2000;
/** No script is computed for longer. */
const REAL_SECONDS = 10;

/** What a script makes of an axis at its end. */
export interface PlayedAxis extends Pick<AxisValues, "position_um" | "position_steps" | "error" | "status"> {
    axis: number;
    moves: number;
    pulses: number;
    peak_speed: number;
    state: AxisName;
}

/** A line that was refused, or has read an axis. */
export interface PlayedLine extends Pick<AxisValues, "position_um" | "error" | "status"> {
    line: number;
    axis: number;
    instruction: string;
    result: number;
    state: AxisName;
}

export interface Played {
    seconds: number;
    ended: "idle" | "limit" | "real";
    executed: number;
    axes: PlayedAxis[];
    told: PlayedLine[];
    curves: MotorCurve[];
}

export interface Script {
    text: string;
    inputs: string;
    seconds: number;
}

/** The program positioning-host, which plays scripts in virtual time. */
export class Player {
    readonly #host: ProgramHost;

    constructor(bytes: Bytes) {
        this.#host = new ProgramHost(bytes, "positioning-host");
    }

    /** Fails with the line that the program complains with. */
    play({ text, inputs, seconds }: Script): Played {
        const files = new Map([[SCRIPT, encode(text)]]);
        const words = ["sim", `/${SCRIPT}`, "--for", seconds.toFixed(6), "--real", String(REAL_SECONDS)];
        words.push("--curve", `/${CURVE}`, "--points", String(POINTS));
        if (inputs.trim() !== "") {
            files.set(INPUTS, encode(inputs));
            words.push("--inputs", `/${INPUTS}`);
        }
        const told = JSON.parse(this.#host.run(words, files)) as Played;
        const { motors } = JSON.parse(new TextDecoder().decode(files.get(CURVE))) as { motors: MotorCurve[] };
        const named = <One extends PlayedAxis | PlayedLine>(one: One): One => ({ ...one, state: nameOf(one) });
        return { ...told, axes: told.axes.map(named), told: told.told.map(named), curves: motors };
    }
}

const encode = (text: string): Bytes => new TextEncoder().encode(text);

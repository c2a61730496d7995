import { checkProgram, computeCurve } from "./api";
import { moveOf, type Settings } from "./commission_programs";
import { told } from "./common/told";

/** Of the time that is computed, in seconds. */
const LONGEST = 60;
const POINTS = 4000;
/** The service drops a computation when the same page asks for another. */
const PAGE = crypto.randomUUID();

/** What S, V and A mean for a move, as the firmware plans it. */
export interface Ramp {
    /** The highest speed, steps/s, and when and after which steps it is reached. */
    peak: number;
    seconds: number;
    steps: number;
    /** Of the whole move; null: it takes longer than is computed. */
    whole_seconds: number | null;
    /** What the parser warns of. */
    remark: string;
}

/** The values are not possible; the message is why. */
export class NotPossible extends Error {}

/** The ramp of a move of so many steps; null: a later call has taken the place of this one. */
export async function computeRamp(settings: Settings, steps: number): Promise<Ramp | null> {
    const text = moveOf(settings, steps);
    const { problems } = await checkProgram(text);
    const words = problems[0] ? told(problems[0].message) : "";
    if (problems[0]?.severity === "error") {
        throw new NotPossible(words);
    }
    const request = { programs: { "1": text }, inputs: [], seconds: LONGEST, points: POINTS, page: PAGE };
    const curve = await computeCurve(request);
    const motor = curve?.motors["1"];
    if (curve === null || motor === undefined) {
        return null;
    }
    const peak = Math.max(...motor.speed);
    const at = motor.speed.indexOf(peak);
    return {
        peak: Math.round(peak),
        seconds: motor.t[at] ?? 0,
        steps: motor.position[at] ?? 0,
        whole_seconds: curve.ended ? curve.seconds : null,
        remark: words,
    };
}

import { NoEngine, engine } from "./engine";
import type { Curve, CurveRequest, Example, Trouble, Verdict } from "./protocol";
import { told, troubleText } from "./common/told";

const SUPERSEDED = 409;

/** The service has answered that it does not do this; the message is why. */
export class Refused extends Error {}

async function post<T>(path: string, body: unknown): Promise<T | null> {
    const response = await fetch(path, {
        method: "POST",
        headers: { "Content-Type": "application/json" },
        body: JSON.stringify(body),
    });
    if (response.status === SUPERSEDED) {
        return null;
    }
    const answer = (await response.json()) as T & { error?: Trouble | null };
    if (!response.ok) {
        throw new Refused(answer.error ? troubleText(answer.error) : `${path}: ${response.status}`);
    }
    return answer;
}

/** What the page does itself where there is no service. */
async function alone<T>(work: Promise<T>): Promise<T> {
    return work.catch((error: unknown) => {
        throw error instanceof NoEngine ? new Refused(told(error.message)) : error;
    });
}

/** What the firmware's parser says of a program. */
export async function checkProgram(text: string): Promise<Verdict> {
    const answer = engine ? await alone(engine.check(text)) : await post<Verdict>("/api/check", { text });
    return answer ?? { problems: [] };
}

/** What programs would do; null if a later call took the place of this one. */
export function computeCurve(request: CurveRequest): Promise<Curve | null> {
    return engine ? alone(engine.curve(request)) : post<Curve>("/api/curve", request);
}

export async function fetchExamples(): Promise<Example[]> {
    if (engine) {
        return engine.examples;
    }
    const response = await fetch("/api/examples");
    return response.ok ? ((await response.json()) as Example[]) : [];
}

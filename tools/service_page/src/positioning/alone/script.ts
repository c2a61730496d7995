import { Chart, type Range } from "../../chart";
import { toChartData } from "../../curve";
import { byId, make } from "../../dom";
import { told as inWords } from "../../common/told";
import { numberText } from "../../language";
import { MOTORS, type Curve, type Example } from "../../protocol";
import { language, named, t } from "../i18n";
import { mmText } from "../numbers";
import type { Played, PlayedAxis, PlayedLine, Script } from "./player";
import type { PlayerTold } from "./worker";

const TEXT_MAX = 1_000_000;
const TOLD_MAX = 50;
const ALL = new Set<number>(MOTORS);

/** A script, and what it would do: it is played in a worker of its own, in virtual time. No unit is asked. */
export class ScriptPanel {
    readonly #play: (id: number, script: Script) => void;
    readonly #text = byId("script-text", HTMLTextAreaElement);
    readonly #inputs = byId("script-inputs", HTMLTextAreaElement);
    readonly #seconds = byId("script-seconds", HTMLInputElement);
    readonly #examples: readonly ScriptExample[];
    readonly #chooser = byId("script-example", HTMLSelectElement);
    readonly #file = byId("script-file", HTMLInputElement);
    readonly #charts = (["speed", "position"] as const).map((quantity) => {
        const range = (): Range => [0, this.#played?.seconds ?? 1];
        const host = byId(`script-curve-${quantity}`, HTMLElement);
        return { quantity, chart: new Chart({ host, quantity, group: "script", range, showsTime: true }) };
    });
    #played: Played | null = null;
    #trouble = "";
    #asked = 0;
    #isPlaying = false;
    #isOld = false;

    /** `play` gives a script to the worker; what comes of it is for `hear`. */
    constructor(examples: readonly ScriptExample[], play: (id: number, script: Script) => void) {
        this.#examples = examples;
        this.#play = play;
        byId("script", HTMLElement).hidden = false;
        byId("script-play", HTMLButtonElement).addEventListener("click", () => this.#press());
        byId("script-open", HTMLButtonElement).addEventListener("click", () => this.#file.click());
        this.#file.addEventListener("change", () => void this.#open());
        this.#chooser.addEventListener("change", () => this.#take(Number(this.#chooser.value)));
        [this.#text, this.#inputs].forEach((field) => field.addEventListener("input", () => this.#age()));
        language.watch(() => {
            this.#nameExamples();
            this.#show();
        });
        this.#take(0);
    }

    /** What the worker has made of a script. */
    hear(told: PlayerTold): void {
        if (told.id !== this.#asked) {
            return;
        }
        this.#isPlaying = false;
        this.#played = "trouble" in told ? null : told.played;
        this.#trouble = "trouble" in told ? told.trouble : "";
        this.#show();
    }

    #nameExamples(): void {
        const rows = this.#examples.map(({ name }, index) => make("option", { value: String(index) }, name));
        this.#chooser.replaceChildren(make("option", { value: "-1" }, t("script.examples")), ...rows);
    }

    #take(index: number): void {
        const example = this.#examples[index];
        if (example !== undefined) {
            [this.#text.value, this.#inputs.value] = [example.text, example.inputs];
            this.#age();
        }
        this.#chooser.value = "-1";
    }

    async #open(): Promise<void> {
        const file = this.#file.files?.[0];
        this.#file.value = "";
        if (file !== undefined && file.size <= TEXT_MAX) {
            this.#text.value = await file.text();
            this.#age();
        } else if (file !== undefined) {
            this.#trouble = t("script.large");
            this.#show();
        }
    }

    #age(): void {
        this.#isOld = this.#played !== null || this.#isPlaying;
        this.#trouble = "";
        this.#show();
    }

    #press(): void {
        const [text, inputs] = [this.#text.value, this.#inputs.value];
        if (!this.#seconds.reportValidity()) {
            return;
        }
        this.#isOld = false;
        this.#trouble = text.length > TEXT_MAX || inputs.length > TEXT_MAX ? t("script.large") : "";
        this.#isPlaying = this.#trouble === "";
        if (this.#isPlaying) {
            this.#asked += 1;
            this.#play(this.#asked, { text, inputs, seconds: Number(this.#seconds.value) });
        }
        this.#show();
    }

    #show(): void {
        const words = byId("script-words", HTMLElement);
        words.dataset.kind = this.#trouble === "" ? "none" : "bad";
        words.textContent = inWords(this.#trouble) || (this.#isPlaying ? t("script.playing") : this.#isOld ? t("script.old") : this.#endText());
        const played = this.#isOld || this.#isPlaying || this.#trouble !== "" ? null : this.#played;
        byId("script-axes", HTMLElement).replaceChildren(...(played?.axes ?? []).filter(isUsed).map((axis) => item(axisText(axis), axis.error !== 0)));
        const told = (played?.told ?? []).slice(0, TOLD_MAX).map((line) => item(lineText(line), line.result !== 0));
        const more = (played?.told.length ?? 0) - TOLD_MAX;
        byId("script-told", HTMLElement).replaceChildren(...told, ...(more > 0 ? [item(t("script.more", { count: more }), true)] : []));
        const curve = curveOf(played);
        this.#charts.forEach(({ quantity, chart }) => chart.setData(toChartData(curve, quantity, ALL)));
        byId("script", HTMLElement).dataset.played = String(played !== null);
    }

    #endText(): string {
        if (this.#played === null) {
            return "";
        }
        const { ended, seconds, executed } = this.#played;
        return t(`script.${ended}`, { seconds: numberText(seconds, 3), lines: numberText(executed) });
    }
}

/** A script with its inputs. */
export interface ScriptExample extends Pick<Example, "name" | "text"> {
    inputs: string;
}

const isUsed = ({ moves, status, error }: PlayedAxis): boolean => moves > 0 || status !== 0 || error !== 0;

const item = (words: string, isBad: boolean): HTMLElement => make("li", isBad ? { class: "is-bad" } : {}, words);

/** State and error in words. */
function stateText({ state, error }: { state: string; error: number }): string {
    const words = `${state} · ${named("is", state)}`;
    return error === 0 ? words : `${words}: ${t("axis.error", { number: error, words: named("error", error) })}`;
}

function axisText(axis: PlayedAxis): string {
    const { moves, pulses, position_um, position_steps, peak_speed } = axis;
    return t("script.axis", {
        axis: axis.axis, mm: mmText(position_um), steps: numberText(position_steps), moves: numberText(moves),
        pulses: numberText(pulses), peak: numberText(peak_speed, 1), state: stateText(axis),
    });
}

function lineText(line: PlayedLine): string {
    if (line.instruction === "READ") {
        return t("script.read", { line: line.line, axis: line.axis, mm: mmText(line.position_um), state: stateText(line) });
    }
    if (line.instruction === "SETTING") {
        return t("script.setting", { line: line.line, words: named("exception", line.result) });
    }
    return t("script.refused", { line: line.line, instruction: line.instruction, axis: line.axis, words: named("error", line.result) });
}

function curveOf(played: Played | null): Curve {
    const motors = Object.fromEntries((played?.curves ?? []).map((one, index) => [String(index + 1), one]));
    return { seconds: played?.seconds ?? 0, ended: true, motors, outputs: [], error: null };
}

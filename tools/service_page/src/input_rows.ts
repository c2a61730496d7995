import type { Range } from "./chart";
import { byId, styleValue } from "./dom";
import { readProgram, saveBytes } from "./files";
import { language, t } from "./i18n";
import { parseInputs, type InputChange } from "./inputs_text";

const INPUTS = 8;
const ROW_PX = 17;
const LEVEL_PX = 11;
const NEAR_PX = 5;
const FONT = "11px system-ui, sans-serif";
const TYPES = [{ description: "CSV", accept: { "text/csv": [".csv"] } }];

export interface InputRowsParts {
    /** The changes as they are written; null: what is written is not understood. */
    changes: () => InputChange[] | null;
    set: (changes: InputChange[]) => void;
    /** The part of the time that is seen, in seconds, and where it lies, in pixels from the left edge. */
    scale: () => { range: Range; left: number; width: number };
}

/** A row for each input over the time of the curves: a click changes its level from there on. And their file. */
export class InputRows {
    readonly #canvas = byId("input-rows", HTMLCanvasElement);
    readonly #trouble = byId("inputs-trouble", HTMLElement);
    readonly #parts: InputRowsParts;

    constructor(parts: InputRowsParts) {
        this.#parts = parts;
        const file = byId("inputs-file", HTMLInputElement);
        this.#canvas.addEventListener("click", ({ offsetX, offsetY }) => this.#click(offsetX, Math.floor(offsetY / ROW_PX) + 1));
        byId("inputs-open", HTMLButtonElement).addEventListener("click", () => file.click());
        byId("inputs-save", HTMLButtonElement).addEventListener("click", () => void this.#save());
        byId("inputs-box", HTMLDetailsElement).addEventListener("toggle", () => this.draw());
        file.addEventListener("change", () => void this.#open(file));
        language.onChange(() => this.draw());
    }

    draw(): void {
        const canvas = this.#canvas;
        const { range, left, width } = this.#parts.scale();
        const ratio = window.devicePixelRatio;
        canvas.width = Math.round(canvas.clientWidth * ratio);
        canvas.height = Math.round(INPUTS * ROW_PX * ratio);
        const context = canvas.getContext("2d");
        if (context === null || canvas.clientWidth === 0) {
            return;
        }
        context.scale(ratio, ratio);
        context.font = FONT;
        context.textBaseline = "middle";
        context.textAlign = "right";
        context.lineWidth = 1.5;
        const changes = this.#parts.changes() ?? [];
        for (let input = 1; input <= INPUTS; input += 1) {
            const low = (input - 0.5) * ROW_PX + LEVEL_PX / 2;
            context.fillStyle = styleValue("--muted");
            context.fillText(t("live.input", { number: input }), left - 6, (input - 0.5) * ROW_PX);
            context.strokeStyle = styleValue("--text");
            context.beginPath();
            let level = levelAt(changes, input, 1000 * range[0]);
            context.moveTo(left, low - level * LEVEL_PX);
            for (const [ms, number, next] of changes) {
                if (number === input && ms > 1000 * range[0] && ms <= 1000 * range[1]) {
                    const x = left + (width * (ms / 1000 - range[0])) / (range[1] - range[0]);
                    context.lineTo(x, low - level * LEVEL_PX);
                    context.lineTo(x, low - next * LEVEL_PX);
                    level = next;
                }
            }
            context.lineTo(left + width, low - level * LEVEL_PX);
            context.stroke();
        }
    }

    /** A click at a change takes it away, another one makes one. */
    #click(x: number, input: number): void {
        const changes = this.#parts.changes();
        const { range, left, width } = this.#parts.scale();
        if (changes === null) {
            this.#say(t("machine.inputs"));
            return;
        }
        if (x < left || x > left + width || input < 1 || input > INPUTS) {
            return;
        }
        const ms_per_px = (1000 * (range[1] - range[0])) / width;
        const ms = Math.max(Math.round(1000 * range[0] + (x - left) * ms_per_px), 0);
        const near = changes.filter(([at, number]) => number === input && Math.abs(at - ms) <= NEAR_PX * ms_per_px);
        const made: InputChange = [ms, input, levelAt(changes, input, ms) === 1 ? 0 : 1];
        const kept = changes.filter((change) => !near.includes(change));
        this.#say("");
        this.#parts.set(near.length > 0 ? kept : [...changes, made].sort((a, b) => a[0] - b[0]));
    }

    async #open(input: HTMLInputElement): Promise<void> {
        const file = input.files?.[0];
        if (file) {
            const found = await readProgram(file);
            const changes = typeof found === "object" ? parseInputs(found.text) : null;
            this.#say(changes === null ? `${file.name}: ${t("machine.inputs")}; ${t("machine.notOpened")}` : "");
            if (changes !== null) {
                this.#parts.set(changes);
            }
        }
        input.value = "";
    }

    async #save(): Promise<void> {
        const changes = this.#parts.changes();
        this.#say(changes === null ? t("machine.inputs") : "");
        if (changes !== null) {
            const text = changes.map((change) => `${change.join(",")}\n`).join("");
            await saveBytes("inputs.csv", new TextEncoder().encode(text), TYPES);
        }
    }

    #say(words: string): void {
        this.#trouble.textContent = words;
        this.#trouble.hidden = words === "";
    }
}

/** All inputs start at 0. */
function levelAt(changes: InputChange[], input: number, ms: number): number {
    return changes.filter(([at, number]) => number === input && at <= ms).at(-1)?.[2] ?? 0;
}

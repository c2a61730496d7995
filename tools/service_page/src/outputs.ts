import type { Range } from "./chart";
import { styleValue } from "./dom";
import { t } from "./i18n";

type Change = [seconds: number, output: number, level: number];

const ROW_PX = 15;
const BAR_PX = 8;
const FONT = "11px system-ui, sans-serif";

/** The stretches of time in which each output is on; outputs that never change are left out. */
export function stretches(changes: Change[], end: number): Map<number, Range[]> {
    const found = new Map<number, Range[]>();
    const since = new Map<number, number>();
    for (const [seconds, output, level] of changes) {
        const list = found.get(output) ?? [];
        found.set(output, list);
        const start = since.get(output);
        if (level === 1 && start === undefined) {
            since.set(output, seconds);
        } else if (level === 0 && start !== undefined) {
            list.push([start, seconds]);
            since.delete(output);
        }
    }
    for (const [output, start] of since) {
        found.get(output)?.push([start, end]);
    }
    return new Map([...found].sort(([a], [b]) => a - b));
}

/** The part of a stretch that is seen, from 0 to 1 of what is seen; turned round if nothing of it is. */
function clipped([start, end]: Range, [from, to]: Range): Range {
    return [(Math.max(start, from) - from) / (to - from), (Math.min(end, to) - from) / (to - from)];
}

/** A row of bars for each output that the programs set, under the plots and in their scale of time. */
export class OutputRows {
    readonly #canvas: HTMLCanvasElement;
    #rows = new Map<number, Range[]>();

    constructor(canvas: HTMLCanvasElement) {
        this.#canvas = canvas;
    }

    setChanges(changes: Change[], end: number): void {
        this.#rows = stretches(changes, end);
        this.#canvas.hidden = this.#rows.size === 0;
        this.#canvas.style.height = `${this.#rows.size * ROW_PX}px`;
    }

    /** Draws the part of the time between two places, in pixels from the left edge. */
    draw(range: Range, left: number, width: number): void {
        const canvas = this.#canvas;
        const ratio = window.devicePixelRatio;
        canvas.width = Math.round(canvas.clientWidth * ratio);
        canvas.height = Math.round(this.#rows.size * ROW_PX * ratio);
        const context = canvas.getContext("2d");
        if (context === null || this.#rows.size === 0) {
            return;
        }
        context.scale(ratio, ratio);
        context.font = FONT;
        context.textBaseline = "middle";
        context.textAlign = "right";
        [...this.#rows].forEach(([output, on], row) => {
            const middle = (row + 0.5) * ROW_PX;
            context.fillStyle = styleValue("--muted");
            context.fillText(t("plan.output", { output }), left - 6, middle);
            context.fillStyle = styleValue("--grid");
            context.fillRect(left, middle - 0.5, width, 1);
            context.fillStyle = styleValue("--output");
            for (const bar of on) {
                const [start, end] = clipped(bar, range).map((part) => left + width * part) as Range;
                if (end >= start) {
                    context.fillRect(start, middle - BAR_PX / 2, Math.max(end - start, 1), BAR_PX);
                }
            }
        });
    }

}

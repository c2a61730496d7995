import uPlot from "uplot";
import { styleValue } from "./dom";
import { shortNumber } from "./i18n";
import { MOTORS } from "./protocol";

const AXIS_WIDTH = 62;
const MARGIN_Y = 0.08;
const SPAN_MIN = 10;
const FONT = "12px system-ui, sans-serif";
const DRAG_MIN_PX = 6;

export type Range = [from: number, to: number];

export interface ChartOptions {
    host: HTMLElement;
    /** Charts with the same group have one cursor. */
    group: string;
    /** The part of the x axis that is to be seen. */
    range: () => Range;
    showsTime: boolean;
    onCursor?: (x: number | null) => void;
    onSelect?: (range: Range) => void;
    onDoubleClick?: () => void;
}

/** Values of the four motors over one common x; null where a motor has none. */
export type ChartData = [x: number[], ...motors: (number | null)[][]];

const NO_DATA: ChartData = [[], ...MOTORS.map(() => [])];

/** Zero is always in sight, and the line never touches the frame. */
function rangeOfValues(_chart: uPlot, least: number | null, most: number | null): Range {
    const low = Math.min(0, least ?? 0);
    const high = Math.max(0, low + SPAN_MIN, most ?? 0);
    const margin = (high - low) * MARGIN_Y;
    return [low - (low < 0 ? margin : margin / 2), high + margin];
}

const secondsOf = (_plot: uPlot, ticks: number[]): string[] => ticks.map((tick) => `${shortNumber(tick)} s`);

const noWords = (_plot: uPlot, ticks: number[]): string[] => ticks.map(() => "");

/** A plot of four motors that fills its host and follows its size and the colours of the page. */
export class Chart {
    readonly #plot: uPlot;
    readonly #options: ChartOptions;

    constructor(options: ChartOptions) {
        this.#options = options;
        this.#plot = new uPlot(this.#plotOptions(), NO_DATA as uPlot.AlignedData, options.host);
        new ResizeObserver(() => this.#fit()).observe(options.host);
        matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.redraw());
    }

    setData(data: ChartData): void {
        this.#plot.setData(data as uPlot.AlignedData, false);
        this.redraw();
    }

    /** Draws again, with the range as it is now; values are fitted to what is in sight. */
    redraw(): void {
        const [min, max] = this.#options.range();
        this.#plot.setScale("x", { min, max });
        this.#plot.redraw(false, true);
    }

    /** The x under a point of the screen. */
    xAt(client_x: number): number {
        return this.#plot.posToVal(client_x - this.#plot.over.getBoundingClientRect().left, "x");
    }

    /** Where the x axis lies, in pixels from the left edge of the host. */
    get span(): { left: number; width: number } {
        const { left, width } = this.#plot.bbox;
        return { left: left / window.devicePixelRatio, width: width / window.devicePixelRatio };
    }

    get surface(): HTMLElement {
        return this.#plot.over;
    }

    #fit(): void {
        const { clientWidth: width, clientHeight: height } = this.#options.host;
        if (width > 0 && height > 0) {
            this.#plot.setSize({ width, height });
        }
    }

    #plotOptions(): uPlot.Options {
        const axis = {
            stroke: () => styleValue("--muted"),
            font: FONT,
            grid: { stroke: () => styleValue("--grid"), width: 1 },
            ticks: { show: false },
            gap: 6,
            values: (_plot: uPlot, ticks: number[]) => ticks.map(shortNumber),
        };
        const time = { ...axis, size: this.#options.showsTime ? 26 : 6, space: 70, values: secondsOf };
        return {
            width: 400,
            height: 120,
            padding: [8, 18, 0, 0],
            legend: { show: false },
            scales: { x: { time: false }, y: { range: rangeOfValues } },
            series: [{}, ...MOTORS.map((motor) => this.#series(motor))],
            axes: [
                this.#options.showsTime ? time : { ...time, values: noWords },
                { ...axis, size: AXIS_WIDTH, space: 15 },
            ],
            cursor: this.#cursor(),
            hooks: {
                setCursor: [(plot) => this.#tellCursor(plot)],
                setSelect: [(plot) => this.#select(plot)],
            },
        };
    }

    #series(motor: number): uPlot.Series {
        return {
            label: `${motor}`,
            stroke: () => styleValue(`--motor-${motor}`),
            width: 2,
            pxAlign: 0,
            spanGaps: false,
            points: { show: false },
        };
    }

    #cursor(): uPlot.Cursor {
        const { onSelect, onDoubleClick } = this.#options;
        return {
            y: false,
            points: { show: false },
            sync: { key: this.#options.group, scales: ["x", null] },
            drag: { x: onSelect !== undefined, y: false, setScale: false },
            bind: {
                dblclick: () => () => {
                    onDoubleClick?.();
                    return null;
                },
            },
        };
    }

    #tellCursor(plot: uPlot): void {
        const left = plot.cursor.left ?? -1;
        this.#options.onCursor?.(left < 0 ? null : plot.posToVal(left, "x"));
    }

    #select(plot: uPlot): void {
        const { left, width } = plot.select;
        if (width === 0) {
            return;
        }
        plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
        if (width >= DRAG_MIN_PX) {
            this.#options.onSelect?.([plot.posToVal(left, "x"), plot.posToVal(left + width, "x")]);
        }
    }
}

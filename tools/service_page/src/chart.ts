import uPlot from "uplot";
import { extent, type Quantity } from "./curve";
import { styleValue } from "./dom";
import { axisNumber } from "./language";
import { MOTORS } from "./protocol";

const AXIS_WIDTH = 74;
const MARGIN_Y = 0.08;
const SPAN_MIN = { speed: 10, position: 4 };
/** Distances between the numbers of an axis of whole steps or steps/s: 1, 2, 5, 10 and so on. */
const WHOLE = Array.from({ length: 36 }, (_, i) => (10 ** Math.floor(i / 3)) * ([1, 2, 5][i % 3] ?? 1));
/** The same of mm and degrees. */
const FINE = [...[0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5], ...WHOLE];
const FINE_PART = 0.01;
const FONT = "12px system-ui, sans-serif";
const DRAG_MIN_PX = 6;

export type Range = [from: number, to: number];

export interface ChartMarks {
    at: number | null;
    motor: number;
    parts: Range[];
}

export interface ChartOptions {
    host: HTMLElement;
    /** Of speeds 0 is always in sight; positions are seen wherever they are. */
    quantity: Quantity;
    /** Charts with the same group have one cursor. */
    group: string;
    /** The part of the x axis that is to be seen. */
    range: () => Range;
    showsTime: boolean;
    /** Each motor has two lines, first a broad and pale one, and values of any fraction, as mm have. */
    isDouble?: boolean;
    /** Whether values are mm or degrees. */
    isFine?: () => boolean;
    onCursor?: (x: number | null) => void;
    onSelect?: (range: Range) => void;
    onClick?: (x: number) => void;
    /** What is drawn below the lines: a moment, and parts of the time in the colour of a motor. */
    marks?: () => ChartMarks;
    onDoubleClick?: () => void;
}

/** Values of the four motors over one common x; null where a motor has none. */
export type ChartData = [x: number[], ...motors: (number | null)[][]];

const BROAD_PX = 6;
/** Of a colour #rrggbb. */
const PALE = "59";
const FAINT = "26";

const noData = (lines: number): ChartData => [[], ...Array.from({ length: lines }, () => [])];

/** The y axis follows what is seen; the line never touches the frame. */
function rangeOfValues(seen: Range | null, quantity: Quantity, isFine: boolean): Range {
    const [least, most] = seen ?? [0, 0];
    const zero = quantity === "speed";
    const low = zero ? Math.min(0, least) : least;
    const high = zero ? Math.max(0, most) : most;
    const span_min = SPAN_MIN[quantity] * (isFine ? FINE_PART : 1);
    const missing = Math.max(span_min - (high - low), 0);
    const margin = (high - low + missing) * MARGIN_Y;
    return [low - margin - (zero ? 0 : missing / 2), high + margin + (zero ? missing : missing / 2)];
}

const numbersOf = (ticks: number[], distance: number, unit = ""): string[] =>
    ticks.map((tick) => axisNumber(tick, distance) + unit);

const noWords = (_plot: uPlot, ticks: number[]): string[] => ticks.map(() => "");

/** A plot of four motors that fills its host and follows its size and the colours of the page. */
export class Chart {
    readonly #plot: uPlot;
    readonly #options: ChartOptions;
    #data: ChartData;

    constructor(options: ChartOptions) {
        this.#options = options;
        this.#data = noData(MOTORS.length * (options.isDouble ? 2 : 1));
        this.#plot = new uPlot(this.#plotOptions(), this.#data as uPlot.AlignedData, options.host);
        if (options.onClick) {
            this.#listenToClicks(options.onClick);
        }
        new ResizeObserver(() => this.#fit()).observe(options.host);
        matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.redraw());
    }

    setData(data: ChartData): void {
        this.#data = data;
        this.#plot.setData(data as uPlot.AlignedData, false);
        this.redraw();
    }

    /** Draws again, with the range as it is now; values are fitted to what is in sight. */
    redraw(): void {
        const { range, quantity, isFine } = this.#options;
        const [min, max] = range();
        const [low, high] = rangeOfValues(extent(this.#data, [min, max]), quantity, isFine?.() === true);
        this.#plot.setScale("x", { min, max });
        this.#plot.setScale("y", { min: low, max: high });
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
            values: (_: uPlot, ticks: number[], _axis: number, _space: number, distance: number) =>
                numbersOf(ticks, distance),
        };
        const time: uPlot.Axis = {
            ...axis,
            size: this.#options.showsTime ? 26 : 6,
            space: 84,
            values: (_, ticks, _axis, _space, distance) => numbersOf(ticks, distance, " s"),
        };
        return {
            width: 400,
            height: 120,
            padding: [8, 18, 0, 0],
            legend: { show: false },
            scales: { x: { time: false }, y: { auto: false } },
            series: [{}, ...this.#broad(), ...MOTORS.map((motor) => this.#series(motor))],
            axes: [
                this.#options.showsTime ? time : { ...time, values: noWords },
                { ...axis, size: AXIS_WIDTH, space: 15, ...(this.#options.isDouble ? {} : { incrs: () => (this.#options.isFine?.() ? FINE : WHOLE) }) },
            ],
            cursor: this.#cursor(),
            hooks: {
                setCursor: [(plot) => this.#tellCursor(plot)],
                setSelect: [(plot) => this.#select(plot)],
                drawAxes: [(plot) => this.#drawMarks(plot)],
            },
        };
    }

    #drawMarks({ ctx, bbox, valToPos }: uPlot): void {
        const { at, motor, parts } = this.#options.marks?.() ?? { at: null, motor: 1, parts: [] };
        const left = (x: number): number => Math.min(Math.max(valToPos(x, "x", true), bbox.left), bbox.left + bbox.width);
        ctx.save();
        ctx.fillStyle = styleValue(`--motor-${motor}`) + FAINT;
        for (const [from, to] of parts) {
            if (left(to) > bbox.left && left(from) < bbox.left + bbox.width) {
                ctx.fillRect(left(from), bbox.top, Math.max(left(to) - left(from), window.devicePixelRatio), bbox.height);
            }
        }
        const { min = 0, max = 0 } = this.#plot.scales["x"] ?? {};
        if (at !== null && min !== null && max !== null && at >= min && at <= max) {
            ctx.fillStyle = styleValue("--output");
            ctx.fillRect(left(at) - window.devicePixelRatio, bbox.top, 2 * window.devicePixelRatio, bbox.height);
        }
        ctx.restore();
    }

    #listenToClicks(onClick: (x: number) => void): void {
        let down_px = 0;
        this.surface.addEventListener("mousedown", ({ clientX }) => (down_px = clientX));
        this.surface.addEventListener("click", ({ clientX, detail }) => {
            if (detail === 1 && Math.abs(clientX - down_px) < DRAG_MIN_PX) {
                onClick(this.xAt(clientX));
            }
        });
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

    #broad(): uPlot.Series[] {
        const stroke = (motor: number) => (): string => styleValue(`--motor-${motor}`) + PALE;
        return this.#options.isDouble ? MOTORS.map((motor) => ({ ...this.#series(motor), width: BROAD_PX, stroke: stroke(motor) })) : [];
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

import { byId, styleValue } from "../dom";
import { fetchCourse } from "./api";
import { cornersOf, thinned, type Corners } from "./corners";
import { language, numberText, t } from "./i18n";
import { isOpen } from "./job";
import type { Unit } from "./unit";
import { View, type Place } from "./view";

const LEVELS = 16;
const ZOOM = 1.4;
const GRID_PX = 60;
const NO_WAY: Place = [0, 0, 0];

/** The path that is planned, coloured by its speed; the one that was made; and where the axes are. */
export class PathView {
    readonly #unit: Unit;
    readonly #canvas = byId("canvas", HTMLCanvasElement);
    readonly #view = new View();
    #planned: Corners = { corners: [], every: 1 };
    #plan: Path2D[] = [];
    #made: Place[] = [];
    #madePath = new Path2D();
    #number: number | null = null;
    /** Where the program begins, pulses. */
    #base: Place = NO_WAY;
    #stood = "";
    #scales: Place = [1, 1, 1];
    #isMoved = false;
    #isDue = false;

    constructor(unit: Unit) {
        this.#unit = unit;
        unit.link.on("made", ({ places }) => {
            this.#made = places.map(placeOf);
            this.#rebuild();
        });
        unit.link.on("live", ({ made }) => this.#goOn(made.map(placeOf)));
        unit.watch(() => this.#show());
        language.onChange(() => this.#draw());
        new ResizeObserver(() => this.#resize()).observe(byId("canvas-box", HTMLElement));
        matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.#draw());
        this.#listen();
    }

    #listen(): void {
        for (const radio of document.querySelectorAll<HTMLInputElement>("input[name=view]")) {
            radio.addEventListener("change", () => {
                this.#view.choose(radio.value === "xy");
                this.#rebuild();
                this.#fit();
            });
        }
        const on = (id: string, act: () => void): void => byId(id, HTMLButtonElement).addEventListener("click", act);
        on("zoom-in", () => this.#zoom(ZOOM));
        on("zoom-out", () => this.#zoom(1 / ZOOM));
        on("fit", () => this.#fit());
        this.#canvas.addEventListener("wheel", (event) => {
            event.preventDefault();
            this.#zoom(event.deltaY < 0 ? ZOOM : 1 / ZOOM, event.offsetX, event.offsetY);
        }, { passive: false });
        this.#canvas.addEventListener("pointerdown", (event) => this.#canvas.setPointerCapture(event.pointerId));
        this.#canvas.addEventListener("pointermove", (event) => {
            if (event.buttons === 1) {
                this.#isMoved = true;
                this.#view.drag(event.movementX, event.movementY);
                if (!this.#view.isFlat) {
                    this.#rebuild();
                }
                this.#draw();
            }
        });
        this.#canvas.addEventListener("dblclick", () => this.#fit());
    }

    #zoom(factor: number, x?: number, y?: number): void {
        this.#isMoved = true;
        this.#view.zoom(factor, x, y);
        this.#draw();
    }

    #resize(): void {
        const { clientWidth, clientHeight } = this.#canvas;
        this.#view.width = Math.max(clientWidth, 1);
        this.#view.height = Math.max(clientHeight, 1);
        this.#canvas.width = clientWidth * devicePixelRatio;
        this.#canvas.height = clientHeight * devicePixelRatio;
        if (!this.#isMoved) {
            this.#fit();
        }
        this.#draw();
    }

    #show(): void {
        const { file = null, machine = null } = this.#unit.state.value ?? {};
        const scales = [0, 1, 2].map((axis) => machine?.axes[axis]?.steps_per_unit ?? 1);
        if (scales.join() !== this.#scales.join()) {
            this.#scales = placeOf(scales);
            this.#rebuild();
            this.#fit();
        }
        if (file !== null && file.number !== this.#number) {
            this.#number = file.number;
            void this.#load(file.number);
        }
        this.#settle();
        this.#draw();
    }

    /** A job begins where it began; a program that is only open, where the axes stand. */
    #settle(): void {
        const job = this.#unit.state.value?.job ?? null;
        const isOfFile = job !== null && job.file === this.#number;
        const positions = this.#unit.last.value?.positions;
        let base = isOfFile ? placeOf(job.begin) : this.#base;
        if (!isOpen(job) && this.#unit.doing === "rest" && positions) {
            const stands = positions.join();
            base = this.#stood !== "" && this.#stood === stands && isOfFile ? base : placeOf(positions);
            base = isOfFile && this.#stood === "" ? placeOf(job.begin) : base;
            this.#stood = stands;
        } else if (isOpen(job)) {
            this.#stood = "";
        }
        if (base.join() !== this.#base.join()) {
            this.#base = base;
            this.#rebuild();
            if (!this.#isMoved) {
                this.#fit();
            }
        }
    }

    async #load(number: number): Promise<void> {
        const rows = await fetchCourse(number).catch(() => new Float32Array());
        if (number === this.#number) {
            this.#planned = cornersOf(rows, this.#unit.state.value?.file?.absolute_from ?? []);
            this.#isMoved = false;
            this.#rebuild();
            this.#fit();
        }
    }

    /** A way that has become long is thinned out. */
    #goOn(places: Place[]): void {
        this.#go(places);
        const kept = thinned(this.#made);
        if (kept !== this.#made) {
            [this.#made, this.#madePath] = [[], new Path2D()];
            this.#go(kept);
        }
    }

    #go(places: Place[]): void {
        for (const place of places) {
            const [u, v] = this.#view.flat(this.#scaled(place));
            if (this.#made.length === 0) {
                this.#madePath.moveTo(u, v);
            } else {
                this.#madePath.lineTo(u, v);
            }
            this.#made.push(place);
        }
    }

    #scaled([x, y, z]: Place): Place {
        const [a, b, c] = this.#scales;
        return [x / a, y / b, z / c];
    }

    /** The corners of the plan, with seconds: NaN where no way leads to it. */
    *#ways(): Generator<[place: Place, seconds: number]> {
        for (const { at, isRelative, seconds } of this.#planned.corners) {
            const parts = at.map((part, axis) => part + (isRelative[axis] ? (this.#base[axis] ?? 0) : 0));
            yield [this.#scaled(placeOf(parts)), seconds];
        }
    }

    #rebuild(): void {
        const ways: { from: Place; to: Place; speed: number }[] = [];
        let before = NO_WAY;
        for (const [place, seconds] of this.#ways()) {
            if (!Number.isNaN(seconds)) {
                const [x, y, z] = before;
                ways.push({ from: before, to: place, speed: Math.hypot(place[0] - x, place[1] - y, place[2] - z) / seconds });
            }
            before = place;
        }
        const fastest = ways.reduce((most, { speed }) => Math.max(most, speed), 0);
        this.#plan = Array.from({ length: LEVELS }, () => new Path2D());
        for (const { from, to, speed } of ways) {
            const path = this.#plan[Math.min(LEVELS - 1, Math.floor((speed / fastest) * LEVELS))];
            path?.moveTo(...this.#view.flat(from));
            path?.lineTo(...this.#view.flat(to));
        }
        const made = this.#made;
        [this.#made, this.#madePath] = [[], new Path2D()];
        this.#go(made);
        this.#canvas.dataset.plan = String(ways.length);
        this.#draw();
    }

    #fit(): void {
        this.#isMoved = false;
        const view = this.#view;
        const made = this.#made.map((place) => view.flat(this.#scaled(place)));
        const plan = [...this.#ways()].map(([place]) => view.flat(place));
        const now = this.#unit.last.value?.positions;
        view.fit([...plan, ...made, ...(now ? [view.flat(this.#scaled(placeOf(now)))] : [])]);
        this.#draw();
    }

    #draw(): void {
        this.#canvas.dataset.made = String(this.#made.length);
        if (!this.#isDue) {
            this.#isDue = true;
            requestAnimationFrame(() => {
                this.#isDue = false;
                this.#paint();
            });
        }
    }

    #paint(): void {
        const context = this.#canvas.getContext("2d");
        if (context === null) {
            return;
        }
        const ratio = devicePixelRatio;
        context.setTransform(1, 0, 0, 1, 0, 0);
        context.clearRect(0, 0, this.#canvas.width, this.#canvas.height);
        context.scale(ratio, ratio);
        this.#paintGrid(context);
        this.#view.apply(context, ratio);
        context.lineCap = context.lineJoin = "round";
        context.lineWidth = 1.6 / this.#view.scale;
        const [slow, fast] = [styleValue("--plan-slow"), styleValue("--plan-fast")];
        this.#plan.forEach((path, level) => {
            context.strokeStyle = mixed(slow, fast, level / (LEVELS - 1));
            context.stroke(path);
        });
        context.strokeStyle = styleValue("--made");
        context.lineWidth = 3 / this.#view.scale;
        context.stroke(this.#madePath);
        context.setTransform(ratio, 0, 0, ratio, 0, 0);
        this.#paintNow(context);
        if (!this.#view.isFlat) {
            this.#paintAxes(context);
        }
    }

    #paintNow(context: CanvasRenderingContext2D): void {
        const last = this.#unit.last.value;
        if (last === null) {
            return;
        }
        const [x, y] = this.#view.pixel(this.#view.flat(this.#scaled(placeOf(last.positions))));
        const isKnown = this.#unit.now !== null;
        context.strokeStyle = styleValue(isKnown ? "--now" : "--muted");
        context.lineWidth = 3;
        context.setLineDash(isKnown ? [] : [3, 4]);
        context.beginPath();
        context.arc(x, y, 7, 0, 2 * Math.PI);
        context.stroke();
        context.setLineDash([]);
    }

    #paintGrid(context: CanvasRenderingContext2D): void {
        const label = byId("scale", HTMLElement);
        if (!this.#view.isFlat) {
            label.textContent = "";
            return;
        }
        const step = niceAbove(GRID_PX / this.#view.scale);
        const [[left, low], [right, high]] = this.#view.corners;
        context.lineWidth = 1;
        context.strokeStyle = styleValue("--border");
        const line = (at: number, isUpright: boolean): void => {
            const [x, y] = this.#view.pixel([at, at]);
            context.globalAlpha = Math.abs(at) < step / 2 ? 1 : 0.45;
            context.beginPath();
            context.moveTo(isUpright ? x : 0, isUpright ? 0 : y);
            context.lineTo(isUpright ? x : this.#view.width, isUpright ? this.#view.height : y);
            context.stroke();
        };
        for (let at = Math.ceil(left / step) * step; at <= right; at += step) {
            line(at, true);
        }
        for (let at = Math.ceil(low / step) * step; at <= high; at += step) {
            line(at, false);
        }
        context.globalAlpha = 1;
        const unit = this.#unit.state.value?.machine ? "mm" : t("jog.pulses");
        const { every } = this.#planned;
        const more = every > 1 ? ` · ${t("path.every", { every: numberText(every) })}` : "";
        label.textContent = t("path.grid", { size: `${numberText(step, 6)} ${unit}` }) + more;
    }

    /** Which way the axes go. */
    #paintAxes(context: CanvasRenderingContext2D): void {
        const [x, y] = [44, this.#view.height - 40];
        context.font = "600 12px system-ui, sans-serif";
        context.lineWidth = 2;
        (["X", "Y", "Z"] as const).forEach((name, axis) => {
            const [u, v] = this.#view.flat(placeOf([0, 1, 2].map((each) => (each === axis ? 1 : 0))));
            context.strokeStyle = context.fillStyle = styleValue(`--motor-${axis + 1}`);
            context.beginPath();
            context.moveTo(x, y);
            context.lineTo(x + 26 * u, y - 26 * v);
            context.stroke();
            context.fillText(name, x + 36 * u - 4, y - 36 * v + 4);
        });
    }
}

const placeOf = ([x = 0, y = 0, z = 0]: readonly number[]): Place => [x, y, z];

/** 1, 2 or 5 times a power of ten. */
function niceAbove(size: number): number {
    const power = 10 ** Math.floor(Math.log10(size));
    return power * ([1, 2, 5, 10].find((each) => each * power >= size) ?? 10);
}

/** A colour between two, which are written as #rrggbb. */
function mixed(from: string, to: string, share: number): string {
    const parts = (colour: string): number[] => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
    const others = parts(to);
    const both = parts(from).map((part, index) => Math.round(part + ((others[index] ?? part) - part) * share));
    return `rgb(${both.join(", ")})`;
}

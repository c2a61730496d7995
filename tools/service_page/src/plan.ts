import { Refused, computeCurve } from "./api";
import { Chart, type Range } from "./chart";
import { told } from "./common/told";
import { singleSteps, toChartData, valueAt, type Quantity } from "./curve";
import { byId, debounced, make } from "./dom";
import { language, numberText, t } from "./i18n";
import { InputRows } from "./input_rows";
import { formatInputs, parseInputs, type InputChange } from "./inputs_text";
import { OutputRows } from "./outputs";
import type { Programs } from "./programs";
import { MOTORS, type Curve, type CurveRequest, type MotorCurve } from "./protocol";
import { beyondWords, onLimits } from "./limits";
import { keep, recall } from "./storage";
import { inUnits, isLeftOut, isScaled, onScale, positionWords, speedWords } from "./scale";
import { Stepping } from "./stepping";
import { Zoom } from "./zoom";

const POINTS = 2000;
const TYPING_MS = 25;
const ZOOMING_MS = 150;

/** Names this page to the service, which drops a computation when the same page asks for another. */
const PAGE = crypto.randomUUID();

/** What the programs would do: two plots that follow the text, without any unit. */
export class Plan {
    readonly #root = byId("plan", HTMLElement);
    readonly #status = byId("plan-status", HTMLElement);
    readonly #inputs = byId("plan-inputs", HTMLInputElement);
    readonly #seconds = byId("plan-seconds", HTMLSelectElement);
    readonly #outputs = new OutputRows(byId("plan-outputs", HTMLCanvasElement));
    readonly #inputRows = new InputRows({
        changes: () => parseInputs(this.#inputs.value),
        set: (changes) => this.setInputs(changes),
        scale: () => ({ range: this.#zoom.range, ...this.#charts.position.span }),
    });
    readonly #zoom = new Zoom(() => this.#zoomed());
    readonly #shown = new Set<number>(MOTORS);
    readonly #programs: () => Record<string, string>;
    readonly #legend: Map<number, HTMLElement>;
    readonly #charts: { speed: Chart; position: Chart };
    readonly #refresh = debounced(TYPING_MS, () => void this.#compute());
    readonly #refine = debounced(ZOOMING_MS, () => void this.#computePart());
    #curve: Curve | null = null;
    /** What is drawn: the whole, or a part with all its detail. */
    #drawn: Curve | null = null;
    /** What is wrong with the programs. */
    #trouble: string | null = null;
    /** Why nothing could be computed, whatever the programs are. */
    #unknown: string | null = null;
    #isComputing = false;
    #isStale = false;
    readonly #inputsChanged: () => void;
    #count = 0;
    /** The simulation command by command. */
    #stepping: Stepping | null = null;

    /** `changed` is called when the inputs are others. */
    constructor(programs: () => Record<string, string>, changed: () => void) {
        this.#programs = programs;
        this.#inputsChanged = changed;
        this.#legend = this.#addLegend();
        this.#charts = { speed: this.#chart("speed", false), position: this.#chart("position", true) };
        this.#inputs.value = recall("inputs", "");
        this.#seconds.value = recall("seconds", "60");
        this.#inputs.addEventListener("input", () => this.#settingsChanged());
        this.#seconds.addEventListener("change", () => this.#settingsChanged());
        byId("zoom-in", HTMLButtonElement).addEventListener("click", () => this.#zoom.by(3));
        byId("zoom-out", HTMLButtonElement).addEventListener("click", () => this.#zoom.by(-3));
        byId("zoom-reset", HTMLButtonElement).addEventListener("click", () => this.#zoom.reset());
        language.onChange(() => this.#draw());
        onScale(() => this.#draw());
        onLimits(() => this.#draw());
        new ResizeObserver(() => this.#drawOutputs()).observe(this.#root);
        matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.#drawOutputs());
    }

    /** To be called once, when the programs are there. */
    follow(programs: Programs): void {
        const stepping = new Stepping(programs, (range) => this.#request(range));
        this.#stepping = stepping;
        stepping.setCurve(this.#curve);
        stepping.at.onChange(() => this.#redraw());
    }

    /** To be called when a program has changed; the curve follows shortly. */
    programsChanged(): void {
        this.#refresh();
    }

    /** To be called when the parser has seen a program. */
    programsChecked(): void {
        this.#stepping?.show();
        this.#redraw();
    }

    /** To be called when another program has taken the place of one: all of it is to be seen. */
    programReplaced(): void {
        this.#zoom.leave();
        this.#refresh();
    }

    /** Takes over the inputs that belong to an example. */
    setInputs(changes: InputChange[]): void {
        this.#inputs.value = formatInputs(changes);
        this.#settingsChanged();
    }

    /** What the programs that are there now would do; null: not known. */
    get curve(): Curve | null {
        return this.#isOld ? null : this.#curve;
    }

    /** What the inputs do, as it is written. */
    get inputs(): string {
        return this.#inputs.value;
    }

    #settingsChanged(): void {
        keep("inputs", this.#inputs.value);
        this.#inputsChanged();
        keep("seconds", this.#seconds.value);
        this.#inputs.setAttribute("aria-invalid", String(parseInputs(this.#inputs.value) === null));
        this.#refresh();
    }

    #request(range?: Range): CurveRequest {
        return {
            programs: this.#programs(),
            inputs: parseInputs(this.#inputs.value) ?? [],
            seconds: Number(this.#seconds.value),
            points: POINTS,
            page: PAGE,
            ...(range ? { range } : {}),
        };
    }

    /** One computation at a time, so that a slow one is shown too before the next begins. */
    async #compute(): Promise<void> {
        if (this.#isComputing) {
            this.#isStale = true;
            return;
        }
        this.#isComputing = true;
        this.#unknown = null;
        try {
            await this.#fetch(this.#request());
        } catch (error) {
            this.#unknown = error instanceof Refused ? error.message : t("state.noService");
        }
        this.#isComputing = false;
        this.#draw();
        if (this.#isStale) {
            this.#isStale = false;
            await this.#compute();
        } else if (this.#zoom.part) {
            this.#refine();
        }
    }

    async #fetch(request: CurveRequest): Promise<void> {
        if (Object.keys(request.programs).length === 0) {
            this.#curve = null;
            this.#trouble = null;
            this.#zoom.leave();
            return;
        }
        const curve = await computeCurve(request);
        if (curve === null) {
            return;
        }
        this.#trouble = curve.error;
        if (curve.error === null) {
            this.#curve = curve;
            this.#zoom.setWhole(curve.seconds);
        }
    }

    /** Fills a part that was zoomed into with all its detail. */
    async #computePart(): Promise<void> {
        const range = this.#zoom.part;
        if (range === null || this.#isComputing) {
            return;
        }
        const detail = await computeCurve(this.#request(range)).catch(() => null);
        if (detail?.error === null && this.#zoom.part === range && !this.#isComputing) {
            this.#plot(detail);
        }
    }

    get #isOld(): boolean {
        return this.#trouble !== null || this.#unknown !== null;
    }

    #zoomed(): void {
        this.#draw();
        this.#refine();
    }

    /** Draws the same again, with the marks as they are now. */
    #redraw(): void {
        [this.#charts.speed, this.#charts.position].forEach((chart) => chart.redraw());
    }

    #draw(): void {
        if (this.#curve) {
            this.#plot(this.#curve);
        } else {
            this.#plot({ seconds: 1, ended: true, motors: {}, outputs: [], error: null });
        }
        this.#count += 1;
        this.#root.dataset.state = this.#isOld ? "old" : this.#curve ? "new" : "empty";
        this.#root.dataset.drawn = String(this.#count);
        this.#root.dataset.range = this.#zoom.range.join(" ");
        this.#stepping?.setCurve(this.#isOld ? null : this.#curve);
        this.#tell(null);
    }

    #plot(curve: Curve): void {
        const motors = Object.values(curve.motors);
        this.#drawn = curve;
        this.#root.dataset.steps = String(singleSteps(curve, this.#zoom.range));
        this.#root.dataset.points = String(motors.reduce((sum, motor) => sum + motor.t.length, 0));
        this.#root.dataset.pulses = String(motors.reduce((sum, motor) => sum + motor.pulses, 0));
        this.#charts.speed.setData(inUnits(toChartData(curve, "speed", this.#shown)));
        this.#charts.position.setData(inUnits(toChartData(curve, "position", this.#shown)));
        this.#drawOutputs();
    }

    #drawOutputs(): void {
        this.#outputs.setChanges(this.#curve?.outputs ?? [], this.#curve?.seconds ?? 0);
        const { left, width } = this.#charts.position.span;
        this.#outputs.draw(this.#zoom.range, left, width);
        this.#inputRows.draw();
    }

    /** Says what is under the cursor, or what the whole is. */
    #tell(seconds: number | null): void {
        this.#status.classList.toggle("is-old", this.#isOld);
        this.#status.title = told(this.#trouble ?? "");
        this.#status.textContent = this.#title(seconds);
        for (const [motor, words] of this.#legend) {
            const one = (seconds === null ? this.#curve : this.#drawn)?.motors[motor];
            words.replaceChildren(...(one ? this.#lines(motor, one, seconds) : []).map((line) => make("span", {}, line)));
            words.classList.toggle("is-bad", one !== undefined && (one.error !== null || beyondWords(motor, one) !== null));
            words.title = one ? this.#hint(motor, one) : "";
        }
    }

    #title(seconds: number | null): string {
        if (seconds !== null && this.#curve) {
            return t("plan.cursor", { seconds: numberText(seconds, 3) });
        }
        if (this.#unknown !== null) {
            return t("plan.unknown", { cause: told(this.#unknown) });
        }
        if (this.#trouble !== null) {
            return t(this.#curve ? "plan.old" : "plan.none");
        }
        if (this.#curve === null) {
            return t("plan.empty");
        }
        const end = this.#curve.ended ? "plan.ends" : this.#curve.cut ? "plan.cut" : "plan.goesOn";
        return t(end, { seconds: numberText(this.#curve.seconds, 3) });
    }

    #lines(motor: number, one: MotorCurve, seconds: number | null): string[] {
        if (seconds === null) {
            const peak = t("plan.peak", { speed: speedWords(motor, one.peak) });
            const pulses = t("plan.pulses", { pulses: numberText(one.pulses) });
            return [wrongWords(motor, one) ?? pulses, isLeftOut(motor) ? t("scale.none") : peak];
        }
        const speed = valueAt(one, "speed", seconds) ?? 0;
        const position = valueAt(one, "position", seconds);
        return [speedWords(motor, speed), position === null ? "–" : positionWords(motor, position)];
    }

    #hint(motor: number, one: MotorCurve): string {
        const moves = t("plan.moves", { moves: numberText(one.moves) });
        return [moves, told(one.error ?? one.state_text ?? ""), beyondWords(motor, one) ?? ""].filter((part) => part !== "").join("; ");
    }

    /** A legend of the motors, which also switches them on and off. */
    #addLegend(): Map<number, HTMLElement> {
        const host = byId("plan-motors", HTMLElement);
        const words = MOTORS.map((motor) => {
            const box = make("input", { type: "checkbox", checked: "" });
            const values = make("span", { class: "legend-words" });
            box.addEventListener("change", () => {
                this.#shown[box.checked ? "add" : "delete"](motor);
                this.#draw();
            });
            const name = make("b", {}, `M${motor}`);
            host.append(make("label", { style: `--c: var(--motor-${motor})` }, box, name, values));
            return [motor, values] as const;
        });
        return new Map(words);
    }

    #chart(quantity: Quantity, showsTime: boolean): Chart {
        const chart = new Chart({
            host: byId(`plan-${quantity}`, HTMLElement),
            quantity,
            group: "plan",
            range: () => this.#zoom.range,
            isFine: isScaled,
            showsTime,
            onCursor: (seconds) => {
                this.#tell(seconds);
                this.#stepping?.hover(seconds);
            },
            onClick: (seconds) => this.#stepping?.choose(seconds),
            marks: () => ({ at: this.#stepping?.at.value ?? null, ...(this.#stepping?.stretches() ?? { motor: 1, parts: [] }) }),
            onSelect: (range) => this.#zoom.show(range),
            onDoubleClick: () => this.#zoom.reset(),
        });
        chart.surface.addEventListener("wheel", (event) => this.#wheel(event, chart), { passive: false });
        return chart;
    }

    /** The wheel zooms; where there is nothing more to widen, it scrolls the page. */
    #wheel(event: WheelEvent, chart: Chart): void {
        if (event.deltaY > 0 && this.#zoom.part === null) {
            return;
        }
        event.preventDefault();
        this.#zoom.by(Math.sign(-event.deltaY), chart.xAt(event.clientX));
    }
}

/** What ends the program of a motor wrongly, or leads it beyond its limits. */
const wrongWords = (motor: number, one: MotorCurve): string | null =>
    one.error ? told(one.error) : beyondWords(motor, one);

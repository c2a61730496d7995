import type { ChartData } from "./chart";
import { toChartData, type Quantity } from "./curve";
import { byId, make } from "./dom";
import { numberText, t } from "./i18n";
import { factsOf } from "./machine_facts";
import type { MachineContent } from "./machine_file";
import { MOTORS, type Curve } from "./protocol";
import { inUnits, isLeftOut } from "./scale";

const SVG = "http://www.w3.org/2000/svg";
const [WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM] = [680, 150, 70, 8, 8, 20];

export interface Printed {
    machine: MachineContent | null;
    programs: string[];
    inputs: string;
    /** What the programs would do; null: not known, as they have errors. */
    curve: Curve | null;
    /** The headings of the curves. */
    headings: Record<Quantity, string>;
}

/** The machine on paper: made anew whenever the page is printed, by its button or by the browser. */
export class PrintView {
    readonly #root = byId("print", HTMLElement);
    readonly #content: () => Printed;

    constructor(content: () => Printed) {
        this.#content = content;
        byId("machine-print", HTMLButtonElement).addEventListener("click", () => window.print());
        window.addEventListener("beforeprint", () => this.#build());
    }

    #build(): void {
        const { machine, programs, inputs, curve, headings } = this.#content();
        this.#root.replaceChildren(
            make("h1", {}, machine?.name ?? t("machine.unnamed")),
            ...(machine?.notes ? [make("p", { class: "notes" }, machine.notes)] : []),
            ...listed(t("machine.details"), machine === null ? [] : factsOf(machine)),
            ...MOTORS.flatMap((motor) => program(motor, machine?.motors[motor - 1]?.name, programs[motor - 1] ?? "")),
            ...(inputs.trim() === "" ? [] : [make("h2", {}, t("print.inputs")), make("pre", {}, inputs)]),
            make("h2", {}, t("plan.title")),
            ...(curve === null ? [make("p", {}, t("print.noCurve"))] : curves(curve, headings)),
        );
    }
}

function listed(title: string, facts: string[]): HTMLElement[] {
    const items = facts.map((fact) => make("li", {}, fact));
    return facts.length === 0 ? [] : [make("h2", {}, title), make("ul", {}, ...items)];
}

function program(motor: number, name: string | undefined, text: string): HTMLElement[] {
    const title = [t("motor.one", { motor }), name ?? ""].filter((part) => part !== "").join(" · ");
    return text.trim() === "" ? [] : [make("h2", {}, title), make("pre", {}, text)];
}

function curves(curve: Curve, headings: Record<Quantity, string>): HTMLElement[] {
    const drawnMotors = MOTORS.filter((motor) => curve.motors[motor] !== undefined && !isLeftOut(motor));
    const names = drawnMotors.map((motor) => make("span", { class: `m${motor}` }, t("motor.one", { motor })));
    const plots = (["speed", "position"] as const).flatMap((quantity) => {
        const data = inUnits(toChartData(curve, quantity, new Set(MOTORS)));
        const figure = make("figure", {}, make("figcaption", {}, headings[quantity]));
        figure.append(drawn(data, curve.seconds));
        return [figure];
    });
    return [make("p", { class: "names" }, ...names), ...plots];
}

/** The lines of the motors, with the least and the greatest value beside them. */
function drawn([xs, ...lines]: ChartData, seconds: number): SVGElement {
    const values = lines.flat().filter((value) => value !== null);
    const low = values.reduce((least, value) => Math.min(least, value), 0);
    const high = values.reduce((most, value) => Math.max(most, value), 0);
    const x = (time: number): number => LEFT + (time / (seconds || 1)) * (WIDTH - LEFT - RIGHT);
    const y = (value: number): number => HEIGHT - BOTTOM - ((value - low) / (high - low || 1)) * (HEIGHT - TOP - BOTTOM);
    const svg = element("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}` });
    for (const value of new Set([low, 0, high])) {
        svg.append(
            element("line", { class: "axis", x1: LEFT, x2: WIDTH - RIGHT, y1: y(value), y2: y(value) }),
            element("text", { x: LEFT - 6, y: y(value) + 4, "text-anchor": "end" }, numberText(value, 3)),
        );
    }
    for (const [part, anchor] of [[0, "start"], [0.5, "middle"], [1, "end"]] as const) {
        const words = `${numberText(seconds * part, 3)} s`;
        svg.append(element("text", { x: x(seconds * part), y: HEIGHT - 4, "text-anchor": anchor }, words));
    }
    lines.forEach((line, index) => {
        const points = line.flatMap((value, at) => (value === null ? [] : [`${x(xs[at] ?? 0).toFixed(1)},${y(value).toFixed(1)}`]));
        svg.append(element("polyline", { class: `m${index + 1}`, points: points.join(" ") }));
    });
    return svg;
}

function element(tag: string, attributes: Record<string, string | number>, text = ""): SVGElement {
    const made = document.createElementNS(SVG, tag);
    Object.entries(attributes).forEach(([name, value]) => made.setAttribute(name, String(value)));
    made.textContent = text;
    return made;
}

import { Refused, computeCurve } from "./api";
import type { Range } from "./chart";
import { valueAt } from "./curve";
import { byId } from "./dom";
import { language, numberText, t } from "./i18n";
import { MOTORS, type Curve, type CurveRequest } from "./protocol";
import type { Programs } from "./programs";
import { onScale, positionWords } from "./scale";
import { Cell } from "./signal";

/** Of a part of the time that is asked for because the whole has more commands than are told. */
const POINTS = 20_000;
const PARTS_MAX = 20;
/** So many stretches of one line are drawn. */
const STRETCHES_MAX = 400;

/** Names the computations of this part of the page to the service: they do not end those of the curves. */
const PAGE = crypto.randomUUID();

type Begun = Curve["motors"][string]["commands"];

/** A moment of the simulation: its time, and how many commands of each motor have begun, by index. */
interface Moment {
    seconds: number;
    begun: number[];
}

/**
 * The simulation command by command. It is the same computation as the curves, so it goes back as well as on; a moment
 * is a place in it. Its lines are marked in the programs, and the line of the cursor in the curves.
 */
export class Stepping {
    /** The moment that is looked at; null: none. */
    readonly at = new Cell<number | null>(null);
    readonly #programs: Programs;
    readonly #request: (range: Range) => CurveRequest;
    readonly #words = byId("steps-words", HTMLElement);
    #curve: Curve | null = null;
    /** The commands of each motor, as far as they are known, and from when on they are not. */
    #trails: { begun: Begun; cut: number | null }[] = [];
    #moment: Moment | null = null;
    #hovered: number | null = null;
    /** What came of the last order, if it is more than the moment. */
    #news = "";
    #cursor: number | null = null;
    #isBusy = false;

    constructor(programs: Programs, request: (range: Range) => CurveRequest) {
        this.#programs = programs;
        this.#request = request;
        const press = (id: string, work: () => Promise<void>): void =>
            byId(id, HTMLButtonElement).addEventListener("click", () => void this.#do(work));
        press("steps-start", async () => this.#go({ seconds: 0, begun: MOTORS.map(() => 0) }));
        press("steps-back", async () => this.#back());
        press("steps-one", () => this.#on());
        press("steps-cursor", () => this.#run(() => new Map([[this.#shown, [this.#programs.line]]]), "steps.notReached"));
        press("steps-run", () => this.#run(() => this.#breaks(), "steps.noBreak"));
        programs.onMove = (line) => {
            this.#cursor = line;
            this.at.set(this.at.value);
        };
        programs.shown.onChange(() => {
            this.#cursor = null;
            this.show();
        });
        language.onChange(() => this.show());
        onScale(() => this.show());
    }

    /** Takes over a curve; a moment that is looked at stays at its time. */
    setCurve(curve: Curve | null): void {
        if (curve === this.#curve) {
            return;
        }
        this.#curve = curve;
        this.#trails = MOTORS.map((motor) => {
            const { commands = [], commands_cut: cut = null } = curve?.motors[motor] ?? {};
            return { begun: commands, cut };
        });
        this.#news = "";
        this.#moment = curve === null || this.#moment === null ? null : this.#momentAt(this.#moment.seconds);
        this.show();
    }

    /** The cursor is in a curve; null: it has left. */
    hover(seconds: number | null): void {
        this.#hovered = seconds;
        this.show();
    }

    /** Looks at a moment. */
    choose(seconds: number): void {
        if (this.#curve !== null) {
            this.#go(this.#momentAt(Math.min(Math.max(seconds, 0), this.#curve.seconds)));
        }
    }

    /** When the line of the cursor is run, for the motor that is shown. */
    stretches(): { motor: number; parts: Range[] } {
        const motor = this.#shown;
        const listing = this.#programs.verdict(motor)?.listing ?? [];
        const { begun } = this.#trail(motor);
        const parts: Range[] = [];
        begun.forEach(([from, ordinal], index) => {
            if (this.#cursor !== null && listing[ordinal - 1]?.[0] === this.#cursor && parts.length < STRETCHES_MAX) {
                const to = begun[index + 1]?.[0] ?? this.#curve?.seconds ?? from;
                const last = parts.at(-1);
                if (last?.[1] === from) {
                    last[1] = to;
                } else {
                    parts.push([from, to]);
                }
            }
        });
        return { motor, parts };
    }

    get #shown(): number {
        return this.#programs.shown.value;
    }

    #trail(motor: number): { begun: Begun; cut: number | null } {
        return this.#trails[motor - 1] ?? { begun: [], cut: null };
    }

    #momentAt(seconds: number): Moment {
        const begun = this.#trails.map((trail) => countUpTo(trail.begun, seconds));
        return { seconds, begun };
    }

    /** One order at a time; what is pressed meanwhile is not meant. */
    async #do(work: () => Promise<void>): Promise<void> {
        if (this.#isBusy || this.#curve === null) {
            return;
        }
        this.#isBusy = true;
        this.#news = "";
        try {
            await work();
        } catch (error) {
            this.#news = t("plan.unknown", { cause: error instanceof Refused ? error.message : t("state.noService") });
        }
        this.#isBusy = false;
        this.show();
    }

    #go(moment: Moment): void {
        this.#moment = moment;
        this.show();
    }

    get #now(): Moment {
        return this.#moment ?? { seconds: 0, begun: MOTORS.map(() => 0) };
    }

    /** To the beginning of a command of a motor, by its index; the others are where they are then. */
    #goTo(motor: number, index: number): void {
        const seconds = this.#trail(motor).begun[index]?.[0] ?? 0;
        const begun = this.#momentAt(seconds).begun;
        begun[motor - 1] = index + 1;
        this.#go({ seconds, begun });
    }

    async #on(): Promise<void> {
        const next = this.#now.begun[this.#shown - 1] ?? 0;
        if (await this.#has(this.#shown, next)) {
            this.#goTo(this.#shown, next);
        } else {
            this.#news = t("steps.noMore", { motor: this.#shown });
        }
    }

    #back(): void {
        const last = (this.#now.begun[this.#shown - 1] ?? 0) - 1;
        if (last >= 1) {
            this.#goTo(this.#shown, last - 1);
        } else {
            this.#go({ seconds: 0, begun: MOTORS.map(() => 0) });
        }
    }

    #breaks(): Map<number, number[]> {
        return new Map(MOTORS.map((motor) => [motor, this.#programs.breaks(motor)] as const).filter(([, at]) => at.length > 0));
    }

    /** Goes to the next moment at which one of these lines, by motor, begins. */
    async #run(wanted: () => Map<number, number[]>, otherwise: "steps.notReached" | "steps.noBreak"): Promise<void> {
        let best: { motor: number; index: number; seconds: number } | null = null;
        for (const [motor, lines] of wanted()) {
            const firsts = this.#firsts(motor, lines);
            let index = this.#now.begun[motor - 1] ?? 0;
            while (await this.#has(motor, index)) {
                const [seconds, ordinal] = this.#trail(motor).begun[index] ?? [0, 0];
                if (best !== null && seconds >= best.seconds) {
                    break;
                }
                if (firsts.includes(ordinal)) {
                    best = { motor, index, seconds };
                    break;
                }
                index += 1;
            }
        }
        if (best === null) {
            this.#news = t(otherwise, { seconds: numberText(this.#curve?.seconds ?? 0, 3) });
            return;
        }
        this.#programs.shown.set(best.motor);
        this.#goTo(best.motor, best.index);
    }

    /** The ordinals with which lines begin. */
    #firsts(motor: number, lines: number[]): number[] {
        const listing = this.#programs.verdict(motor)?.listing ?? [];
        return lines.map((line) => listing.findIndex((each) => each[0] === line) + 1).filter((ordinal) => ordinal > 0);
    }

    /** Whether a command of a motor begins within the time; asks for more of the time where it is not known yet. */
    async #has(motor: number, index: number): Promise<boolean> {
        const curve = this.#curve;
        for (let part = 0; part < PARTS_MAX; part += 1) {
            const { begun, cut } = this.#trail(motor);
            if (index < begun.length || cut === null || curve === null) {
                return index < begun.length;
            }
            const more = await computeCurve({ ...this.#request([cut, curve.seconds]), points: POINTS, page: PAGE });
            const one = more?.motors[motor];
            if (one === undefined || this.#curve !== curve) {
                return false;
            }
            const known = begun.filter(([seconds]) => seconds < cut);
            this.#trails[motor - 1] = { begun: [...known, ...one.commands], cut: one.commands_cut };
        }
        return false;
    }

    /** Shows the moment, by what is known of the programs. */
    show(): void {
        const moment = this.#hovered === null ? this.#moment : this.#momentAt(this.#hovered);
        for (const motor of MOTORS) {
            const command = moment === null ? undefined : this.#command(motor, moment);
            this.#programs.markSimulated(motor, command?.[0] ?? null, this.#hovered === null && motor === this.#shown);
        }
        const seconds = this.#moment?.seconds ?? null;
        if (this.at.value !== seconds) {
            this.at.set(seconds);
        }
        this.#words.textContent = this.#news || (moment === null ? t("steps.none") : this.#describe(moment));
    }

    #command(motor: number, { seconds, begun }: Moment): [line: number, column: number, text: string] | undefined {
        const trail = this.#trail(motor);
        if (trail.cut !== null && seconds >= trail.cut) {
            return undefined;
        }
        const ordinal = trail.begun[(begun[motor - 1] ?? 0) - 1]?.[1] ?? 0;
        return this.#programs.verdict(motor)?.listing?.[ordinal - 1];
    }

    #describe(moment: Moment): string {
        const motor = this.#shown;
        const { cut } = this.#trail(motor);
        const words = [t("plan.cursor", { seconds: numberText(moment.seconds, 4) })];
        const command = this.#command(motor, moment);
        const one = this.#curve?.motors[motor];
        if (command !== undefined) {
            words.push(t("steps.line", { motor, line: command[0], command: command[2] }));
        } else if (cut !== null && moment.seconds >= cut) {
            words.push(t("steps.many"));
        }
        if (one !== undefined) {
            words.push(positionWords(motor, valueAt(one, "position", moment.seconds) ?? one.before));
        }
        return words.join(" · ");
    }
}

/** How many of these have begun at a time. */
function countUpTo(begun: Begun, seconds: number): number {
    let [low, high] = [0, begun.length];
    while (low < high) {
        const middle = (low + high) >> 1;
        if ((begun[middle]?.[0] ?? Infinity) <= seconds) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

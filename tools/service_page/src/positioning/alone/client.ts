import { LineTrouble, Refusal } from "../../unit_place";
import { AXES } from "../protocol";
import {
    AXIS_READ, UNIT_READ, axisState, errorText, has, hasFault, stateText, unitState, type AxisState, type Names,
} from "./axis_state";
import { AXIS_STEP, images, instructions, register, settingRows, valueOf, wordsOf, wordsOfValue, type RegisterRow } from "./table";
import { ExceptionRefusal, wrongUnit, type Wire } from "./wire";

const PRODUCT = "POS4";
const LAYOUT = 1;
const NUMBERS = 256;
/** A clock that goes by so much or more has gone back. */
export const CLOCK_HALF = 2 ** 31;
const CLOCK = 2 ** 32;
const PAIR = ["STEPS", "MICROMETRES"];

export type SettingValues = Record<string, number>;
export type Instruction = keyof typeof instructions;

/** The unit has started anew: axes are free, positions count from 0. */
export class Restarted extends LineTrouble {
    constructor(where: string, wasExecuted = false) {
        const what = wasExecuted ? "the last instruction may have been executed before that; " : "";
        const next = `its axes are free, positions count from 0, and what moved stood at once; ${what}look at the unit`;
        super("Restarted", `${where} HAS RESTARTED`, next);
    }
}

/** A unit at the end of a line. An instruction is executed once, however often its request had to be sent. */
export class Unit {
    readonly wire: Wire;
    readonly names: Names;
    #uptime_ms: number | null = null;
    #isKnown = false;

    constructor(wire: Wire, names: Names) {
        this.wire = wire;
        this.names = names;
    }

    /** What the unit tells of itself; also whether it is one, and has not restarted. */
    async read(): Promise<Record<string, number>> {
        await this.requireKnown();
        const values = unitState(await this.wire.read(UNIT_READ.first, UNIT_READ.words));
        this.#noteUptime(values.uptime ?? 0);
        return values;
    }

    /** Refuses what is another device, or a unit with other registers. */
    async requireKnown(): Promise<void> {
        if (this.#isKnown) {
            return;
        }
        const told = await this.wire.identify().catch((error: unknown) => {
            throw error instanceof ExceptionRefusal ? wrongUnit(this.wire.name) : error;
        });
        const [layout] = told.includes(PRODUCT) ? await this.wire.read(register("LAYOUT").number, 1) : [];
        if (layout !== LAYOUT) {
            throw wrongUnit(this.wire.name);
        }
        this.#isKnown = true;
    }

    /** The same for a stop, which goes out to a unit that does not answer, too. */
    async requireNoOther(): Promise<void> {
        await this.requireKnown().catch((error: unknown) => {
            if (error instanceof LineTrouble && error.trouble.kind === "WrongUnit") {
                throw error;
            }
        });
    }

    /** Tells a unit that has restarted since it was looked at first. */
    async requireSameStart(wasExecuted = false): Promise<void> {
        const row = register("UPTIME");
        this.#noteUptime(valueOf(row, await this.wire.read(row.number, wordsOf(row))), wasExecuted);
    }

    #noteUptime(uptime_ms: number, wasExecuted = false): void {
        const before = this.#uptime_ms;
        this.#uptime_ms = uptime_ms;
        if (before !== null && (uptime_ms - before + CLOCK) % CLOCK >= CLOCK_HALF) {
            throw new Restarted(this.wire.name, wasExecuted);
        }
    }

    async axis(number: number): Promise<AxisState> {
        await this.requireKnown();
        return axisState(number, await this.wire.read(AXIS_STEP * number + AXIS_READ.first, AXIS_READ.words));
    }

    async axes(): Promise<AxisState[]> {
        const found = [];
        for (const axis of AXES) {
            found.push(await this.axis(axis));
        }
        return found;
    }

    // ---- instructions ----

    /** Gives an instruction once, with its parameters in the same request, and sees it done. */
    async instruct(axis: number, name: Instruction, parameters: readonly number[] = []): Promise<AxisState> {
        const before = await this.axis(axis);
        await this.requireSameStart();
        const word = (((before.done >> 8) + 1) % NUMBERS) * NUMBERS + instructions[name];
        const base = AXIS_STEP * axis;
        const place = base + register("INSTRUCTION").number;
        const [found, wasRepeated] = await this.wire.writeAndRead(place, [word, ...parameters], base + AXIS_READ.first, AXIS_READ.words);
        if (wasRepeated) {
            await this.requireSameStart(true);
        }
        const state = axisState(axis, found);
        if (state.done !== word) {
            const cause = `axis ${axis}: ${name} is not what was done last`;
            throw new Refusal(cause, "another master has given an instruction meanwhile");
        }
        if (state.result !== 0) {
            throw new Refusal(`axis ${axis}: ${name} was refused: ${errorText(state.result, this.names)}`, "", { kind: "Refused" });
        }
        return state;
    }

    /** POS_CONTROL: a feed in 1/65 536 mm/min, the permission; what is left out stays. */
    async control(axis: number, feed?: number, permitted?: boolean): Promise<AxisState> {
        const [control, feedRow] = [register("CONTROL"), register("FEED")];
        const base = AXIS_STEP * axis;
        const feedWords = feed === undefined ? [] : wordsOfValue(feed, wordsOf(feedRow));
        const words = [...(permitted === undefined ? [] : [Number(permitted)]), ...feedWords];
        await this.requireKnown();
        if (words.length > 0) {
            const place = base + (permitted === undefined ? feedRow : control).number;
            const begins = permitted !== false && feed !== 0;
            const [found] = await this.wire.writeAndRead(place, words, base + control.number, 1 + wordsOf(feedRow), begins);
            const isPermitted = permitted === undefined || ((found[0] ?? 0) & 1) === Number(permitted);
            const isFed = feedWords.every((word, index) => found[1 + index] === word);
            if (!isPermitted || !isFed) {
                await this.#refuseControl(axis);
            }
        }
        return this.axis(axis);
    }

    async #refuseControl(axis: number): Promise<never> {
        const state = await this.axis(axis);
        if (!has(state, "DISP")) {
            await this.requireSameStart(true);
            throw new Refusal(`axis ${axis} is not taken`, "init comes first");
        }
        const cause = `axis ${axis}: in the state ${stateText(state, this.names)} it takes no feed`;
        throw new Refusal(cause, "init and a measure come first");
    }

    /** Takes an axis that nobody has; an error is not cleared by the way. */
    async beTaken(axis: number): Promise<void> {
        const state = await this.axis(axis);
        if (hasFault(state)) {
            throw new Refusal(`axis ${axis}: ${errorText(state.error, this.names)}`, "nothing was moved: init clears it");
        }
        if (!has(state, "DISP")) {
            await this.instruct(axis, "POS_INIT", [0]);
        }
    }

    /** MP = 0 of axes; of all in one request, with feed 0 too. */
    async takePermission(axes: ReadonlySet<number>): Promise<void> {
        const { first, words } = images.FAST_OUT;
        if (axes.size === AXES.length) {
            await this.wire.write(first, Array.from({ length: words * AXES.length }, () => 0));
            return;
        }
        for (const axis of axes) {
            await this.wire.write(first + words * (axis - 1), [0]);
        }
    }

    // ---- settings ----

    /** All settings of the unit (0) or of an axis. */
    async settings(axis: number): Promise<SettingValues> {
        await this.requireKnown();
        const own = settingRows.filter(({ scope }) => scope === (axis === 0 ? "U" : "A"));
        const first = own[0]?.number ?? 0;
        const last = own.at(-1);
        const count = last === undefined ? 0 : last.number + wordsOf(last) - first;
        const words = await this.wire.read(AXIS_STEP * axis + first, count);
        return Object.fromEntries(own.map((row) => [row.name, valueOf(row, words, row.number - first)]));
    }

    /** Writes settings that are not as they were found; each is read back. */
    async writeSettings(axis: number, wanted: SettingValues, found: SettingValues): Promise<void> {
        const differ = Object.keys(wanted).filter((name) => wanted[name] !== found[name]);
        const all = { ...found, ...wanted };
        // Each of the pair is held against the other, so they go in one request.
        const pair = differ.some((name) => PAIR.includes(name)) ? [PAIR] : [];
        const others = differ.filter((name) => !PAIR.includes(name)).map((name) => [name]);
        for (const names of [...pair, ...others]) {
            await this.#set(axis, names.map(register), all);
        }
    }

    async #set(axis: number, rows: RegisterRow[], values: SettingValues): Promise<void> {
        const words = rows.flatMap((row) => wordsOfValue(values[row.name] ?? 0, wordsOf(row)));
        const place = AXIS_STEP * axis + (rows[0]?.number ?? 0);
        await this.wire.write(place, words);
        const found = await this.wire.read(place, words.length);
        if (found.some((word, index) => word !== words[index])) {
            const names = rows.map(({ name }) => name).join(", ");
            throw new Refusal(`${this.wire.name}: ${names}: ${words.join(" ")} was written and ${found.join(" ")} is read`, "");
        }
    }

    /** 1 keeps all settings without power, 2 takes the delivered ones. */
    async store(value: 1 | 2): Promise<void> {
        await this.requireKnown();
        await this.wire.write(register("STORE").number, [value]);
    }
}

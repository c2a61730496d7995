import type { Refusal } from "../../unit_place";
import type { Job, Phase, Progress } from "../protocol";
import type { Opened } from "./file";
import type { Sender } from "./sender";
import { stands, type Positions } from "./told";

const UNDER_WAY: Phase[] = ["sending", "finishing", "waits"];

/** A file that was started: how far it is, and what the unit executes of it now. */
export class Work {
    readonly file: Opened;
    readonly sender: Sender;
    phase: Phase = "sending";
    /** What a person is asked. */
    text = "";
    /** What has stopped it. */
    trouble: Refusal | null = null;
    readonly #begin: Positions;
    /** The vector of its course that is executed; null: it is not known. */
    #at: number | null = 0;

    constructor(file: Opened, sender: Sender, begin: Positions) {
        this.file = file;
        this.sender = sender;
        this.#begin = begin;
    }

    /** Whether it is being sent, or its last vectors are executed. */
    get isUnderWay(): boolean {
        return UNDER_WAY.includes(this.phase);
    }

    /** Whether it is, or may be gone on with. */
    get isOpen(): boolean {
        return this.isUnderWay || this.phase === "held";
    }

    get told(): Job {
        const { number, name } = this.file.state;
        return {
            file: number, name, phase: this.phase, text: this.text, trouble: this.trouble?.trouble ?? null, begin: this.#begin,
        };
    }

    /** Takes in positions; the corners that the axes have passed since the last ones. */
    see(positions: Positions, isAtRest: boolean): Positions[] {
        const { course } = this.file;
        const { executed } = this.sender;
        if (course === null || executed === null) {
            return [];
        }
        if (isAtRest) {
            executed.stood(positions);
        }
        const done = this.sender.look(positions);
        const before = this.#at;
        this.#at = done === null ? null : (course.counts[done] ?? 0);
        if (this.#at === null || before === null) {
            return [];
        }
        const corners: Positions[] = [];
        let place = executed.place;
        for (let number = this.#at; number > before; number -= 1) {
            corners.push(place);
            place = place.map((at, axis) => at - (course.parts[4 * (number - 1) + axis] ?? 0));
        }
        return corners.reverse();
    }

    /** How far it is; `factor`: of speed; null: not known. */
    progress(flags: number, factor: number | null): Progress | null {
        const { course } = this.file;
        if (course === null || course.lines.length === 0) {
            return null;
        }
        const taken = course.counts[this.sender.sent] ?? 0;
        const at = this.#at;
        if (at === null) {
            return { at: null, line: null, level: null, sent: taken, left_s: null };
        }
        const left_s = course.seconds.subarray(at).reduce((sum, each) => sum + each, 0) / (factor ?? 1);
        const line = at < taken || !stands(flags) ? (course.lines[at] ?? null) : null;
        return { at, line, level: taken - at, sent: taken, left_s: factor === null ? null : Math.round(10 * left_s) / 10 };
    }
}

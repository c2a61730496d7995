import { checkProgram } from "./api";
import type { Link } from "./link";
import { MOTORS, type Answer, type UnitState } from "./protocol";
import { Cell } from "./signal";

const [HOLD, RELEASE] = ["[", "]"];
/** What may change the memories. */
const CHANGE = ["send", "send_all", "reset", "connect", "disconnect"];

/** A command that is stored of a program. */
interface Command {
    ordinal: number;
    line: number;
    text: string;
}

/** How the program of a motor here compares with that in its memory. */
export type Found =
    | { kind: "same" | "none" | "unknown" | "wrong" }
    | { kind: "other"; ordinal: number; line: number | null; here: string; there: string };

/** What is found of each motor; null: its answer is awaited. */
type Findings = ReadonlyMap<number, Found | null>;

const NOTHING: Findings = new Map();

/** Reads the memories of the unit's motors, and compares them with the programs that are here. */
export class Memories {
    /** Empty: nothing was asked for, or what was found may not be so any more. */
    readonly found = new Cell<Findings>(NOTHING);
    readonly #link: Link;
    readonly #asked = new Map<number, number>();
    #here: Record<string, string> = {};
    #place = "";

    constructor(link: Link) {
        this.#link = link;
        link.on("answer", (answer) => void this.#hear(answer));
        link.on("state", (state) => this.#setPlace(state));
        link.isOpen.onChange((isOpen) => !isOpen && this.#giveUp());
    }

    /** What was found is not so any more. */
    forget(): void {
        if (this.found.value.size > 0) {
            this.#asked.clear();
            this.found.set(NOTHING);
        }
    }

    /** Reads all four; `here` has the texts of those motors that have a program. */
    ask(here: Record<string, string>): void {
        this.#asked.clear();
        this.#here = here;
        const found = MOTORS.map((motor): [number, Found | null] => {
            const id = this.#link.nextId();
            this.#asked.set(id, motor);
            const isSent = this.#link.send({ type: "request", id, message: "program", motor });
            return [motor, isSent ? null : { kind: "unknown" }];
        });
        this.found.set(new Map(found));
    }

    /** Another unit, or perhaps another. */
    #setPlace({ port, node, connected, away }: UnitState): void {
        const place = JSON.stringify([port, node, connected, away]);
        if (place !== this.#place) {
            this.#place = place;
            this.forget();
        }
    }

    /** No more answers come. */
    #giveUp(): void {
        this.#asked.clear();
        const found = [...this.found.value].map(([motor, each]) => [motor, each ?? { kind: "unknown" }] as const);
        this.found.set(new Map(found));
    }

    async #hear({ id, from, message, error, values }: Answer): Promise<void> {
        if (CHANGE.includes(message)) {
            this.forget();
        }
        const motor = id !== null && (from === undefined || from === this.#link.client) ? this.#asked.get(id) : undefined;
        if (motor === undefined || id === null) {
            return;
        }
        const told = error === null ? (values?.program ?? "") : null;
        const found = await compared(this.#here[motor] ?? "", told);
        if (this.#asked.delete(id)) {
            this.found.set(new Map(this.found.value).set(motor, found));
        }
    }
}

/** `told` is what the unit holds; null: it has not told it. */
async function compared(text: string, told: string | null): Promise<Found> {
    const [here, there] = await Promise.all([listed(text), told === null ? null : listed(told)]);
    if (here === null || there === null) {
        return { kind: there === null ? "unknown" : "wrong" };
    }
    const [ours, theirs] = [withoutHold(here), withoutHold(there)];
    const first = Array.from({ length: Math.max(ours.length, theirs.length) }, (_, index) => index)
        .find((index) => ours[index]?.text !== theirs[index]?.text);
    if (first === undefined) {
        return { kind: ours.length === 0 ? "none" : "same" };
    }
    const [our, their] = [ours[first], theirs[first]];
    const ordinal = our?.ordinal ?? first + 1;
    return { kind: "other", ordinal, line: our?.line ?? null, here: our?.text ?? "", there: their?.text ?? "" };
}

/** The commands that are stored of a program; null: it has errors, or nobody reads it now. */
async function listed(text: string): Promise<Command[] | null> {
    if (text.trim() === "") {
        return [];
    }
    const verdict = await checkProgram(text).catch(() => null);
    if (verdict === null || verdict.problems.some(({ severity }) => severity === "error")) {
        return null;
    }
    return (verdict.listing ?? []).map(([line, , command], index) => ({ ordinal: index + 1, line, text: command }));
}

/** Without the `[` and `]` that sending adds: to a program in several messages, or to let motors start together. */
function withoutHold(commands: Command[]): Command[] {
    const isHold = ({ text }: Command): boolean => text === HOLD || text === RELEASE;
    const own = commands.findIndex((command) => !isHold(command));
    const leading = own < 0 ? commands : commands.slice(0, own);
    const release = leading.map(({ text }) => text).lastIndexOf(RELEASE);
    if (release >= 0) {
        return commands.slice(release + 1);
    }
    const inside = commands.slice(1, -1);
    const isWrapped = commands[0]?.text === HOLD && commands.at(-1)?.text === RELEASE && !inside.some(isHold);
    return isWrapped ? inside : commands;
}

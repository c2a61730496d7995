import type { Bytes } from "../../program_host";
import { LineTrouble, Refusal } from "../../unit_place";
import { DONE } from "./answers";
import type { FromService } from "../protocol";
import { DeskState } from "./desk_state";
import { AFTER_RESET, NOTHING_KNOWN, knownAfter, knownWithout, percentOf } from "./known";
import { OutOfStep, Restarted, UnitLink } from "./link";
import { Looks, Made } from "./looks";
import { RUN, stands } from "./told";
import { Wire, type BytePort } from "./wire";
import type { Work } from "./work";

const LOOK_MS = 100;
/** From one look at the inputs to the next while a file is sent. */
const INPUTS_MS = 600;

/** The port, the unit at its end, and what is seen of it. */
export class UnitConnection {
    readonly state: DeskState;
    /** Null where no port is open. */
    link: UnitLink | null = null;
    /** The last file that was started there. */
    job: Work | null = null;
    /** A motion by hand is under way, as far as is known. */
    isJogging = false;
    looks = new Looks();
    look_due_ms = 0;
    readonly made = new Made();
    readonly #bytes: Bytes;
    readonly #tell: (told: FromService) => void;
    readonly #mind: () => void;
    #inputs_due_ms = 0;
    /** Of a port that was lost: it knows a unit that has started anew since. */
    #lost: Wire | null = null;

    /** `bytes` is the module; `mind` is called while the line is used, and may throw what ends that. */
    constructor(bytes: Bytes, tell: (told: FromService) => void, mind: () => void) {
        this.#bytes = bytes;
        this.#tell = tell;
        this.#mind = mind;
        this.state = new DeskState(tell);
    }

    get port(): BytePort | null {
        return this.link?.wire.port ?? null;
    }

    open(port: BytePort): void {
        const isBack = this.#lost?.port.name === port.name && this.#lost.port.baud === port.baud;
        const wire = isBack && this.#lost !== null ? this.#lost : new Wire(this.#bytes, port);
        wire.port = port;
        wire.look = this.#mind;
        wire.onSent = ([first = ""]) => this.state.change({ reference: first.startsWith("W") });
        wire.onAnswer = (commands, answer) => {
            const learn = answer === null ? knownWithout : answer.code === DONE ? knownAfter : null;
            this.state.heard_ms = answer === null ? this.state.heard_ms : performance.now();
            this.state.known = learn === null ? this.state.known : commands.reduce(learn, this.state.known);
        };
        wire.onLost = () => (this.state.known = NOTHING_KNOWN);
        this.link = new UnitLink(wire);
        [this.looks, this.job] = [new Looks(), null];
        this.beginWay();
    }

    /** Forgets the port; what was being sent there is not gone on with. */
    drop(why: Refusal): void {
        if (this.job?.isOpen) {
            this.endJob(why);
        }
        if (this.link !== null) {
            this.#lost = why instanceof LineTrouble ? this.link.wire : null;
        }
        this.link = null;
        this.isJogging = false;
    }

    /** Forgets the way that was made. */
    beginWay(): void {
        this.made.clear();
        this.#tell(this.made.told);
    }

    async look(link: UnitLink, pause_ms = LOOK_MS): Promise<void> {
        const now_ms = performance.now();
        this.look_due_ms = now_ms + pause_ms;
        const isWithInputs = this.job?.isUnderWay !== true || now_ms >= this.#inputs_due_ms;
        if (isWithInputs) {
            this.#inputs_due_ms = now_ms + INPUTS_MS;
        }
        const seen = await this.looks.look(link, isWithInputs);
        const isAtRest = stands(seen.flags) && (seen.flags & RUN) === 0;
        this.isJogging &&= !isAtRest;
        const { job } = this;
        const corners = job?.isOpen ? job.see(seen.positions, isAtRest) : [];
        const percent = percentOf(this.state.known);
        const progress = job?.isOpen ? job.progress(seen.flags, percent === null ? null : percent / 100) : null;
        const made = this.made.go(corners, seen.positions).map((place) => place.slice(0, 3));
        const { stood_s = 0 } = link.wire.port;
        this.#tell({ type: "live", ...seen, progress, made, stood_s });
    }

    /** Keeps what says that there is no connection. */
    note(got: unknown): void {
        if (got instanceof OutOfStep && this.job?.isOpen) {
            this.endJob(got);
        }
        if (!(got instanceof Refusal)) {
            this.state.change({ error: null });
        } else if (got instanceof Restarted) {
            this.restart();
        } else if (got instanceof LineTrouble && this.link !== null) {
            this.state.change({ error: got.trouble, reference: false });
        }
    }

    /** The unit has started anew: what it was told is gone. */
    restart(): void {
        this.looks = new Looks();
        this.isJogging = false;
        if (this.job?.isOpen) {
            this.endJob(new Refusal("the unit has restarted", "the job is gone"));
        }
        this.state.known = this.link === null ? NOTHING_KNOWN : AFTER_RESET;
        this.state.change({ restarted: true, wanted: null });
    }

    /** Tells in which phase the job is. */
    enter(phase: Work["phase"], text = ""): void {
        if (this.job !== null) {
            [this.job.phase, this.job.text] = [phase, text];
            this.state.change({ job: this.job.told });
        }
    }

    /** Tells how it has ended; null: well. */
    endJob(trouble: Refusal | null): void {
        if (this.job !== null) {
            this.job.trouble = trouble;
            this.enter(trouble === null ? "done" : "failed");
        }
    }
}

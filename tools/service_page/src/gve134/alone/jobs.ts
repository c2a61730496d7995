import { Refusal } from "../../unit_place";
import * as acts from "./acts";
import type { Opened } from "./file";
import { commandsOf } from "./job_text";
import { stepTowards } from "./known";
import { Restarted, type UnitLink } from "./link";
import { Interrupted, Sender, endOf } from "./sender";
import type { UnitConnection } from "./seen_unit";
import { RUN, positionsText } from "./told";
import { Work } from "./work";

/** From one look to the next while a file is sent; and while nothing is sent. */
const SENDING_LOOK_MS = 250;
const LOOK_MS = 100;
const POLL_MS = 50;
/** Commands to change the speed that are sent in a turn. */
const OVERRIDE_STEPS = 4;

export const STOPPED = new Refusal("a stop went ahead of this", "send it again if it is still wanted", { kind: "Stopped" });
/** A job was left between two of its commands, and can be gone on with. */
export const HELD = new Refusal("halted", "Go on goes on with the job, Delete ends it", { kind: "Stopped" });
const CUT = new Refusal(
    "halted in the middle of a command, of which the end is not known, and the rest was not sent",
    "look at the unit, and begin anew", { kind: "Stopped" },
);

/** Sends files. `beside` is called between two commands of one, and throws HELD where a halt is wanted. */
export class Jobs {
    readonly #line: UnitConnection;
    readonly #beside: (link: UnitLink) => Promise<void>;
    #isReady = false;

    constructor(line: UnitConnection, beside: (link: UnitLink) => Promise<void>) {
        this.#line = line;
        this.#beside = beside;
    }

    /** Sends a file, and waits for its end. */
    async begin(link: UnitLink, file: Opened): Promise<string> {
        const { state } = this.#line;
        const { name } = file.state;
        if (file.course === null) {
            throw new Refusal(`${name} has errors`, "nothing was sent");
        }
        if (state.now.restarted) {
            throw new Refusal(`${name}: the unit has restarted`, "take note of that first");
        }
        acts.requireFree(await link.flags());
        const begin = await link.positions();
        await link.order(`XM${state.now.wanted ?? Math.round(state.now.known.percent ?? 100)}`);
        state.change({ wanted: null });
        this.#line.beginWay();
        const hands = { between: () => this.#between(link), askPerson: (text: string) => this.#askPerson(link, text) };
        this.#line.job = new Work(file, new Sender(link, name, commandsOf(file.text), hands), begin);
        return this.#work(link);
    }

    /** Lets the axes go on, and the job that was halted or interrupted. */
    async goOn(link: UnitLink): Promise<string> {
        const { job } = this.#line;
        const isJob = job?.isOpen === true;
        if (isJob) {
            await this.#requireOwn(link, job);
        }
        const text = await acts.go(link, isJob);
        return isJob ? this.#work(link) : text;
    }

    /** Ends a job that another program has used the unit beside; who has only halted it changes nothing. */
    async #requireOwn(link: UnitLink, job: Work): Promise<void> {
        const left = job.trouble instanceof Interrupted ? job.trouble.left : null;
        if (left !== null && left.flags === (await link.flags()) && left.positions.join() === (await link.positions()).join()) {
            await link.connect(); // what was counted until now is known
            return;
        }
        try {
            await link.requireOwn();
        } catch (error) {
            throw this.#ended(job, error);
        }
    }

    /** The person whom the job waits for is ready. */
    resume(): string {
        if (this.#line.job?.phase !== "waits") {
            throw new Refusal("no job waits for anybody", "look at the unit");
        }
        this.#isReady = true;
        return "the job goes on";
    }

    /** Deletes the queue, and gives up the job that was halted. */
    async delete(link: UnitLink): Promise<string> {
        const text = await acts.deleteQueue(link);
        if (this.#line.job?.isOpen) {
            this.#line.endJob(new Refusal("deleted", "the rest was not sent"));
        }
        return text;
    }

    /** Brings a wanted speed about, a few steps at a time where vectors are queued: XM would give all the last V. */
    async override(link: UnitLink): Promise<void> {
        const { state, job, looks } = this.#line;
        const { wanted } = state.now;
        if (wanted === null) {
            return;
        }
        try {
            const isFree = job?.isUnderWay !== true && looks.flags !== null && (looks.flags & RUN) === 0;
            const isDone = isFree ? (await link.order(`XM${wanted}`)) && true : await this.#step(link, wanted);
            if (isDone && state.now.wanted === wanted) {
                state.change({ wanted: null });
            }
        } catch (error) {
            state.change({ wanted: null });
            throw error;
        }
    }

    /** Goes some steps; whether that is all. */
    async #step(link: UnitLink, wanted: number): Promise<boolean> {
        for (let step = 0; step < OVERRIDE_STEPS; step += 1) {
            const { factor } = this.#line.state.known;
            if (factor === null) {
                const cause = `the speed that the vectors have is not known, so it cannot become ${wanted} % while they are made`;
                throw new Refusal(cause, "type XU or XD to change it by a sixteenth");
            }
            const command = stepTowards(factor, wanted);
            if (command === null) {
                return true;
            }
            await link.order(command);
        }
        return false;
    }

    async #work(link: UnitLink): Promise<string> {
        const line = this.#line;
        const job = line.job as Work;
        try {
            job.trouble = null;
            line.enter("sending");
            await job.sender.send();
            line.enter("finishing");
            await job.sender.finish();
        } catch (error) {
            throw this.#ended(job, error);
        }
        await line.look(link);
        line.endJob(null);
        return `${job.file.state.name}: ${job.sender.sent} vectors made; the axes stand at ${positionsText(await link.positions())}`;
    }

    /** What has ended the work, for now or for good. */
    #ended(job: Work, error: unknown): unknown {
        const line = this.#line;
        if (!(error instanceof Refusal)) {
            return error;
        }
        if (error === HELD || error instanceof Interrupted) {
            job.trouble = error === HELD ? null : error;
            line.enter("held");
            return error;
        }
        const ended = error === STOPPED ? CUT : endOf(error, job.sender.sentText, error instanceof Restarted);
        if (line.job === job && job.isOpen) {
            line.endJob(ended);
        }
        return ended;
    }

    /** Between two commands: the unit is looked at, too. */
    async #between(link: UnitLink): Promise<void> {
        await this.#beside(link);
        if (performance.now() >= this.#line.look_due_ms) {
            await this.#line.look(link, this.#line.job?.phase === "sending" ? SENDING_LOOK_MS : LOOK_MS);
        }
    }

    async #askPerson(link: UnitLink, text: string): Promise<void> {
        this.#isReady = false;
        this.#line.enter("waits", text);
        while (!this.#isReady) {
            await link.wire.pause(POLL_MS);
            await this.#between(link);
        }
        this.#line.enter("sending");
    }
}

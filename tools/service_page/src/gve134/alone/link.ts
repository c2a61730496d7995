import { LineTrouble, Refusal } from "../../unit_place";
import {
    DAMAGED, DONE, NO_VALUES, answerText, answerWords, encoded, isMemoryWrite, isReset, parsed, type Answer,
} from "./answers";
import { flagsText, stands, type Positions } from "./told";
import {
    BARE, MEMORY_MS, PACKET_OVER_MS, PATIENCE_MS, encodedRequest, packetOf, requestOf, type Heard, type Request, type Wire,
} from "./wire";

const RESET_MS = 500;
const ATTEMPTS = 4;
const INDEX_ATTEMPTS = 8;
/** Before each attempt to connect; one of them is long enough for a packet that was cut off. */
const CONNECT_PAUSE_MS = [0, 200, PACKET_OVER_MS, 200];
const LONG_ATTEMPTS = 20;
const INDEX_MODULUS = 256;
const HALT_MS = 30_000;
const HALT_REPEAT_MS = [300, 300, 500, 1000, 2000, 4000];
const POLL_MS = 50;
const VERSION: Request = { commands: ["?"], form: /^IP134/, counts: 1, patience_ms: PATIENCE_MS };
const INDEX = requestOf("@");
const PATIENT_INDEX = requestOf("@", PACKET_OVER_MS);
const NOTHING_OR_INDEX = /^\d{0,3}$/;
const BARE_INDEX = /^[0-9A-F],\d{1,3}$/;

/** The unit does not do what it was asked for. */
export class Refused extends Refusal {
    constructor(what: string, answer: Answer, why = answerWords(answer)) {
        super(`${what}: ${why} (answer ${answerText(answer)})`, "");
    }
}

/** The unit has started anew, so that its queue, positions and settings are gone. */
export class Restarted extends LineTrouble {
    constructor(where: string, isPossible: boolean) {
        const what = isPossible ? "executed before that or not at all" : "not executed";
        const gone = "its queue, positions and settings are gone, and what moved stood at once";
        super("UnitRestarted", `${where} HAS RESTARTED: ${gone}`, `the command under way was ${what}, and nothing was sent after it`);
    }
}

/** The unit has not told that its axes stand. */
export class NotConfirmed extends LineTrouble {
    constructor(cause: string) {
        super("NotConfirmed", cause, "use the emergency stop");
    }
}

/**
 * The host's end of the line, by the rules of firmware/gve134/docs/line.md: no command is executed twice, and none is
 * sent again to a unit that has restarted. tools/rkm04_tools/gve134/link.py says how, state by state.
 */
export class UnitLink {
    readonly wire: Wire;
    version = "";
    /** Answers that got lost. */
    repairs = 0;
    /** Whether the unit was found to have started anew when it was connected to again. */
    restarted = false;
    #isReady = false;
    #index = 0;

    constructor(wire: Wire) {
        this.wire = wire;
    }

    get #name(): string {
        return this.wire.port.isVirtual ? "the virtual unit" : this.wire.port.name;
    }

    // ---- commands ----

    /** Has a command executed once, and returns the answer. */
    ask(command: string): Promise<Answer> {
        return this.#settle(requestOf(command, isMemoryWrite(command) ? MEMORY_MS : PATIENCE_MS));
    }

    /** The same; what is refused is an error that begins with `what`. */
    async order(command: string, what = command): Promise<Answer> {
        const answer = await this.ask(command);
        if (answer.code !== DONE) {
            throw new Refused(what, answer);
        }
        return answer;
    }

    async byte(command: string): Promise<number> {
        return parseInt((await this.order(command)).values, 16);
    }

    async positions(isLatched = false): Promise<Positions> {
        return (await this.order(isLatched ? "PL" : "P4")).values.split(",").map(Number);
    }

    /** ST6. */
    flags(): Promise<number> {
        return this.byte("SR6");
    }

    /** Has a packet taken, or refused, once. */
    sendPacket(commands: string[]): Promise<Answer> {
        return this.#settle(packetOf(commands));
    }

    /** Sends a packet once; null: it came damaged, and nothing of it was taken. */
    async tryPacket(commands: string[]): Promise<Answer | null> {
        await this.#getReady();
        return this.#forgetting(() => this.#attempt(packetOf(commands)));
    }

    /** Has W executed once, which is answered when the axes stand; until then the unit answers nothing. */
    async askLong(command: string, wait_ms: number): Promise<Answer> {
        await this.#getReady();
        const request = requestOf(command);
        return this.#forgetting(async () => {
            for (let attempt = 0; attempt < ATTEMPTS; attempt += 1) {
                const answer = (await this.wire.exchange(request)) ?? (await this.#waitLong(wait_ms));
                if (answer !== null && answer.code !== DAMAGED) {
                    return this.#counted(request, answer);
                }
                const repaired = await this.#repair(request, false);
                if (repaired !== null) {
                    return repaired;
                }
            }
            throw this.#unanswered(this.wire.heard);
        });
    }

    /** Sends J, and connects to the unit that then starts anew. */
    async reset(command: string): Promise<Answer> {
        let answer: Answer = { code: DONE, inta: false, values: "" };
        try {
            answer = await this.ask(command);
        } catch (error) {
            if (!(error instanceof Restarted)) {
                throw error;
            }
        }
        await this.wire.pause(RESET_MS);
        await this.connect();
        this.restarted = false;
        return answer;
    }

    /** A command as files and people have it. */
    execute(command: string): Promise<Answer> {
        return isReset(command) ? this.reset(command) : this.ask(command);
    }

    // ---- connecting ----

    /** Finds out whether a unit is there, and how it stands with checksums and its index. */
    async connect(): Promise<void> {
        this.#isReady = this.restarted = false;
        const heard: Heard = { damaged: 0, echoes: 0, bare: false, other: "" };
        for (const pause_ms of CONNECT_PAUSE_MS) {
            await this.wire.pause(pause_ms);
            if ((await this.#switchSums()) && (await this.#askVersion())) {
                this.#index = await this.#findIndex();
                this.#isReady = true;
                return;
            }
            heard.damaged += this.wire.heard.damaged;
            heard.echoes += this.wire.heard.echoes;
            heard.other ||= this.wire.heard.other;
        }
        throw this.#unanswered(heard);
    }

    /** Brings checksums about, in whatever state they are. */
    async #switchSums(): Promise<boolean> {
        if (await this.#switched(true)) {
            return true;
        }
        if (!this.wire.heard.bare) {
            return false;
        }
        if (this.version !== "") {
            if (!((await this.#hasNoSums()) || (await this.#hasNoSums()))) { // one may get lost
                return false;
            }
            this.restarted = true;
        }
        return this.#switched(false);
    }

    async #switched(isWithSum: boolean): Promise<boolean> {
        this.wire.sums = true;
        this.wire.write(encoded("%+", isWithSum));
        return (await this.wire.wait(NO_VALUES, PATIENCE_MS))?.code === DONE;
    }

    async #askVersion(): Promise<boolean> {
        const answer = (await this.wire.exchange(VERSION)) ?? (await this.wire.exchange(VERSION));
        this.version = answer?.values ?? "";
        return this.version !== "";
    }

    // ---- an answer, come what may ----

    async #settle(request: Request): Promise<Answer> {
        await this.#getReady();
        return this.#forgetting(async () => {
            for (let attempt = 0; attempt < ATTEMPTS; attempt += 1) {
                const answer = await this.#attempt(request);
                if (answer !== null) {
                    return answer;
                }
            }
            throw this.#unanswered(this.wire.heard);
        });
    }

    /** Sends once; null: it was not executed. */
    async #attempt(request: Request): Promise<Answer | null> {
        const answer = await this.wire.exchange(request);
        if (answer !== null && answer.code !== DAMAGED) {
            return this.#counted(request, answer);
        }
        return this.#repair(request, this.wire.heard.bare);
    }

    #counted(request: Request, answer: Answer): Answer {
        this.#index = (this.#index + request.counts) % INDEX_MODULUS;
        return answer;
    }

    /** Whatever is thrown inside leaves nothing known of the unit. */
    async #forgetting<T>(work: () => Promise<T>): Promise<T> {
        try {
            return await work();
        } catch (error) {
            this.#isReady = false;
            throw error;
        }
    }

    /** Connects if need be. What was asked for is not for a unit that has restarted since. */
    async #getReady(): Promise<void> {
        if (!this.#isReady) {
            await this.connect();
            if (this.restarted) {
                throw new Restarted(this.#name, false);
            }
        }
    }

    /** Finds out what has become of a request; null: it was not executed. */
    async #repair(request: Request, wasRefused: boolean): Promise<Answer | null> {
        this.repairs += 1;
        const last = await this.#lastAnswer(request);
        const index = await this.#findIndex(last === null ? 3 : 2, !wasRefused);
        const done = (index - this.#index + INDEX_MODULUS) % INDEX_MODULUS;
        if (done > request.counts) {
            throw new LineTrouble(
                "OutOfStep",
                `${this.#name} has counted commands that were not sent from here, or was restarted; what was sent last may have been executed`,
                "look at the unit, and see that nothing else uses this line",
            );
        }
        this.#index = index;
        return done < request.counts || request.counts === 0 ? null : this.#executed(request, last);
    }

    #lastAnswer({ form }: Request): Promise<Answer | null> {
        return this.wire.exchange({ commands: [">"], form, counts: 0, patience_ms: PATIENCE_MS });
    }

    /** The answer to what was executed; null: a packet that was not taken after all. */
    async #executed(request: Request, first: Answer | null): Promise<Answer | null> {
        let last = first;
        for (let attempt = 0; attempt < ATTEMPTS && last === null; attempt += 1) {
            last = await this.#lastAnswer(request);
        }
        if (last !== null && last.code !== DAMAGED) {
            return last;
        }
        if (last !== null && request.commands.length > 1 && last.values !== "") {
            return null;
        }
        const command = request.commands[request.commands.length - 1] ?? "";
        throw new LineTrouble(
            "EndUnknown", `${this.#name} has executed ${command} or refused it, and the answer was lost for good`,
            "look at the unit before anything is sent again",
        );
    }

    /** Asks for the index until so many answers in succession agree: all but one could still be late ones. */
    async #findIndex(needed = 2, isPossible = false): Promise<number> {
        let [index, agree] = [-1, 0];
        for (let attempt = 0; attempt < INDEX_ATTEMPTS; attempt += 1) {
            const answer = await this.wire.exchange(attempt > 0 ? PATIENT_INDEX : INDEX);
            if (answer?.code === DONE) {
                const told = Number(answer.values);
                [agree, index] = [told === index ? agree + 1 : 1, told];
                if (agree === needed) {
                    return index;
                }
            } else if (this.wire.heard.bare) {
                await this.#refuseRestarted(isPossible);
            }
        }
        throw this.#unanswered(this.wire.heard);
    }

    async #refuseRestarted(isPossible: boolean): Promise<void> {
        if (await this.#hasNoSums()) {
            this.version = ""; // so that connecting to it is no news any more
            throw new Restarted(this.#name, isPossible);
        }
    }

    /** Asks without a checksum: only a unit without them, as after a restart, has an answer to that. */
    async #hasNoSums(): Promise<boolean> {
        this.wire.write(encoded("@", false));
        const until = performance.now() + PATIENCE_MS;
        for (let left = PATIENCE_MS; left > 0; left = until - performance.now()) {
            if ((await this.wire.lines(left)).some((line) => BARE_INDEX.test(line) && parsed(line, true) === null)) {
                return true;
            }
        }
        return false;
    }

    /** Waits for what ends when the axes stand; null: its answer cannot be read, or the unit never got it. */
    async #waitLong(wait_ms: number): Promise<Answer | null> {
        const end = performance.now() + wait_ms;
        for (let asked = 1; asked < LONG_ATTEMPTS; asked += 1) {
            this.wire.write(encodedRequest(INDEX, true));
            const answer = await this.wire.wait(NOTHING_OR_INDEX, end - performance.now());
            if (answer !== null) {
                for (let late = answer.values === "" ? asked : 0; late > 0; late -= 1) {
                    await this.wire.wait(INDEX.form, PATIENCE_MS);
                }
                return answer.values === "" ? answer : null;
            }
            if (this.wire.heard.bare) {
                return null;
            }
            if (this.wire.heard.damaged + this.wire.heard.echoes === 0) {
                break;
            }
        }
        throw new NotConfirmed(`${this.#name}: no answer for a long time, and it is NOT KNOWN whether the axes move`);
    }

    // ---- halting ----

    /** Sends H until it is answered, in whatever state the line is, and sees the axes stand. */
    async halt(): Promise<{ flags: number; positions: Positions; restarted: boolean }> {
        this.#isReady = false;
        const begun = performance.now();
        let isWithSum = true;
        for (let attempt = 0; !(await this.#haltOnce(isWithSum, HALT_REPEAT_MS[attempt] ?? POLL_MS));) {
            if (performance.now() - begun > HALT_MS) {
                throw new NotConfirmed(`${this.#name}: H has no answer in ${HALT_MS / 1000} s`);
            }
            isWithSum = !isWithSum;
            attempt = Math.min(attempt + 1, HALT_REPEAT_MS.length - 1);
        }
        await this.connect();
        const { restarted } = this;
        const flags = await this.flags();
        if (!stands(flags)) {
            throw new NotConfirmed(`${this.#name}: the unit tells that it is ${flagsText(flags)}`);
        }
        return { flags, positions: await this.positions(), restarted };
    }

    /** Whether H was answered, by an answer with or without a checksum: several may be under way. */
    async #haltOnce(isWithSum: boolean, wait_ms: number): Promise<boolean> {
        this.wire.write(encoded("H", isWithSum));
        const until = performance.now() + wait_ms;
        for (let left = wait_ms; left > 0; left = until - performance.now()) {
            for (const line of await this.wire.lines(left)) {
                const isHalted = [true, false].some((sums) => {
                    const answer = parsed(line, sums);
                    return answer?.code === DONE && answer.inta && answer.values === "";
                });
                if (isHalted || (isWithSum && BARE.test(line))) {
                    return isHalted;
                }
            }
        }
        return false;
    }

    /** Asks again and again until no axis moves. */
    async untilStands(tell: () => Promise<void> = async () => undefined): Promise<number> {
        for (;;) {
            const flags = await this.flags();
            if (stands(flags)) {
                return flags;
            }
            await tell();
            await this.wire.pause(POLL_MS);
        }
    }

    #unanswered({ other, echoes, damaged }: Heard): LineTrouble {
        const where = this.#name;
        if (other !== "" && this.version === "") {
            return new LineTrouble("OtherDevice", `${where}: another device answers, ${other.slice(0, 40)}`, "choose the port of a GVE134");
        }
        if (echoes > 0 && damaged === 0) {
            return new LineTrouble(
                "NoAnswer", `${where}: only what is sent comes back, no unit answers`, "are TX and RX connected to each other?",
            );
        }
        if (damaged > 0) {
            const cause = `${where}: what comes back is damaged or not from a GVE134`;
            return new LineTrouble("GarbledAnswer", cause, "check the rate, the cable, and which device is at this port");
        }
        const next = "check power, cable (TX and RX crossed) and rate; a unit that waits for its axes answers nothing but HALT";
        return new LineTrouble("NoAnswer", `${where}: the unit does not answer`, next);
    }
}

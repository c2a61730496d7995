import { LineTrouble, Refusal } from "../../unit_place";
import { BOUNDS, DONE, NOT_WHILE_MOVING, NO_ROOM, answerWords, type Answer } from "./answers";
import type { Executed } from "./executed";
import { goesInPackets, isVector, stepsOf, type Asked, type Command } from "./job_text";
import { OutOfStep, Refused, Restarted, type UnitLink } from "./link";
import { INTA, INTCOM, RUN, causesOf, flagsText, positionsText, type Positions } from "./told";

const PACKET_COMMANDS_MAX = 64;
const PACKET_COMMANDS_FIRST = 32;
const PACKET_COMMANDS_MIN = 8;
const PACKET_GROWTH = 2;
/** What H may have to wait for: a packet on the line. */
const PACKET_SECONDS = 0.15;
const PACKET_BYTES_MIN = 300;
const BITS_PER_BYTE = 10;
/** What the line has around a command: !, address, checksum and CR. */
const AROUND_BYTES = 6;
const NO_ROOM_MS = 10;
const POLL_MS = 50;
const LONG_MS = 86_400_000;
/** What is refused so often while nothing moves is refused for good. */
const WAITS_MAX = 3;
/** What may stand first in a file for a unit that was interrupted. */
const BEGINS_ANEW = ["D", "G", "J", "H", "R"];

/** The unit has stopped the axes by itself. `left`: how they stand then. */
export class Interrupted extends Refusal {
    readonly left: { flags: number; positions: Positions };

    constructor(cause: string, next: string, left: Interrupted["left"]) {
        super(cause, next);
        this.left = left;
    }
}

/** What the job needs of who has begun it. */
export interface Hands {
    /** Called between commands and while something is waited for; what it throws ends a call of `send` or `finish`. */
    between: () => Promise<void>;
    /** Shows a text until a person is ready. */
    askPerson: (text: string) => Promise<void>;
}

/**
 * A vector file on its way to the unit: in order, in packets where it can be, with its room, as tools/gve134 send does
 * it (tools/rkm04_tools/gve134/sending.py says why). A call of `send` or `finish` goes on where one has ended.
 */
export class Sender {
    /** Vectors that the unit has taken. */
    sent = 0;
    executed: Executed | null = null;
    #inta = false;
    readonly #link: UnitLink;
    readonly #name: string;
    readonly #hands: Hands;
    readonly #commands: Iterator<Command>;
    #hasBegun = false;
    #pending: Command[] = [];
    /** Commands that are not pending any more, and not known to have been executed. */
    #begun: Command[] = [];
    #underWay: Command[] = [];
    #size = PACKET_COMMANDS_FIRST;
    #waits = 0;
    #probesFrom: Positions | null = null;
    /** The vector that probes. */
    #probed: number[] = [];

    constructor(link: UnitLink, name: string, commands: Iterator<Command>, hands: Hands) {
        this.#link = link;
        this.#name = name;
        this.#commands = commands;
        this.#hands = hands;
    }

    /** Sends all of it; returns when the unit has taken the last command. */
    async send(): Promise<void> {
        if (!this.#hasBegun) {
            await this.#begin();
        }
        this.#pending.unshift(...this.#begun.splice(0));
        this.#link.wire.takeSlept_s();
        for (;;) {
            const count = this.#fill();
            if (count > 1) {
                await this.#sendRun(count);
            } else if (this.#ahead(0) !== null) {
                await this.#sendSingle(this.#take());
            } else {
                return;
            }
            await this.#between();
        }
    }

    /** After a sleep nothing goes on by itself: beside the machine nobody expects that. */
    readonly #between = async (): Promise<void> => {
        const slept_s = this.#link.wire.takeSlept_s();
        if (slept_s > 0) {
            await this.#link.halt();
            throw await this.#interrupted(`${this.#name}: the computer or its program slept for ${slept_s} s`);
        }
        await this.#hands.between();
    };

    /** Waits until the axes stand. */
    async finish(): Promise<void> {
        const flags = await this.#untilStands();
        if (flags & INTA && !this.#inta) {
            throw await this.#interrupted(this.#name);
        }
        if ((flags & (RUN | INTA)) === 0) {
            this.executed?.stood(await this.#link.positions());
        }
    }

    /** How many vectors were sent; to how many, where the answer to the last has not come. */
    get sentText(): string {
        const doubtful = this.#underWay.filter(isVector).length;
        return doubtful > 0 ? `${this.sent} to ${this.sent + doubtful}` : String(this.sent);
    }

    /** How many vectors are over, by where the axes are; null: it is not known. */
    look(positions: Positions): number | null {
        return this.executed?.look(positions, this.#underWay) ?? null;
    }

    /** The command so many places ahead of the next one; null: there are not so many. */
    #ahead(place: number): Command | null {
        while (this.#pending.length <= place) {
            const { value, done } = this.#commands.next();
            if (done) {
                return null;
            }
            this.#pending.push(value);
        }
        return this.#pending[place] ?? null;
    }

    /** The next command, which is begun. */
    #take(): Command {
        const command = this.#pending.shift();
        if (command === undefined) {
            throw new Error("there is no next command");
        }
        this.#begun.push(command);
        return command;
    }

    /** Refuses to add to what was interrupted, unless the file begins with what ends that. */
    async #begin(): Promise<void> {
        const flags = await this.#link.flags();
        this.#inta = (flags & INTA) !== 0;
        const { executed } = this.#link.wire;
        executed.start(await this.#link.positions());
        if (flags & (INTA | RUN)) {
            executed.lose();
        }
        this.executed = executed;
        const first = this.#ahead(0);
        if (this.#inta && first !== null && !BEGINS_ANEW.includes(first.letter)) {
            throw new Refusal(`the unit is ${flagsText(flags)}`, "nothing was sent");
        }
        this.#hasBegun = true;
    }

    // ---- runs of C and B ----

    /** How many of the commands ahead make up the next packet. */
    #fill(): number {
        let room = Math.max(PACKET_BYTES_MIN, (this.#link.wire.port.baud * PACKET_SECONDS) / BITS_PER_BYTE);
        let count = 0;
        for (let next = this.#ahead(0); count < this.#size && next !== null; next = this.#ahead(count)) {
            room -= next.text.length + AROUND_BYTES;
            if (!goesInPackets(next) || room < 0) {
                break;
            }
            count += 1;
        }
        return count;
    }

    async #sendRun(count: number): Promise<void> {
        const run = this.#pending.slice(0, count);
        const texts = run.map(({ text }) => text);
        this.#underWay = run;
        const insists = count <= PACKET_COMMANDS_MIN;
        const answer = insists ? await this.#link.sendPacket(texts) : await this.#link.tryPacket(texts);
        if (answer === null) {
            this.#size = Math.max(PACKET_COMMANDS_MIN, Math.floor(count / 2)); // damaged: better sent in parts
            return;
        }
        const isTaken = answer.code === DONE;
        if (isTaken) {
            await this.#taken(run);
        }
        try {
            await this.#judge(run[0] as Command, answer);
        } finally {
            this.#pending.splice(0, isTaken ? count : 0);
        }
        if (answer.code !== NO_ROOM) {
            this.#size = Math.min(PACKET_COMMANDS_MAX, this.#size + PACKET_GROWTH);
            return;
        }
        if (this.#size === PACKET_COMMANDS_MIN) {
            await this.#waitForRoom(run[0] as Command);
        }
        this.#size = Math.max(PACKET_COMMANDS_MIN, Math.floor(this.#size / 2));
    }

    // ---- all else ----

    async #sendSingle(first: Command): Promise<void> {
        if (first.asked !== null) {
            await this.#obey(first, first.asked);
            this.#begun = [];
            return;
        }
        const whole = first.text === "*S" ? this.#packetOfFile() : null;
        const command = whole?.end ?? first;
        const isPacket = command.text === "*S";
        this.#probesFrom = null;
        if (command.letter === "L" && this.#isProbeNext) {
            await this.#untilStands();
            this.#probesFrom = await this.#link.positions();
            this.#probed = stepsOf(command);
        }
        for (;;) {
            const texts = whole?.commands.map(({ text }) => text) ?? [];
            const answer = isPacket ? await this.#link.sendPacket(texts) : await this.#ask(command);
            const isCutOff = command.letter === "W" && answer.inta;
            if (answer.code === DONE && !isCutOff) {
                await this.#taken(whole?.commands ?? [command]);
            }
            await this.#judge(command, answer);
            if (answer.code === NO_ROOM) {
                await this.#waitForRoom(command);
            } else if (answer.code === NOT_WHILE_MOVING) {
                await this.#waitForRest(command, answer);
            } else {
                return;
            }
        }
    }

    /** The commands after *S up to *E; or what ends the packet before that, H or J. */
    #packetOfFile(): { commands: Command[]; end: Command | null } {
        let commands: Command[] = [];
        while (this.#ahead(0) !== null) {
            const each = this.#take();
            if (each.text.startsWith("*E")) {
                break;
            }
            if (goesInPackets(each)) {
                commands.push(each);
            } else if (each.text === "*S") {
                commands = [];
            } else {
                return { commands: [each], end: each };
            }
        }
        return { commands, end: null };
    }

    async #ask(command: Command): Promise<Answer> {
        this.#underWay = [command];
        if (command.letter === "W") {
            return this.#link.askLong(command.text, LONG_MS);
        }
        if (command.text === "H") {
            const { restarted, others } = await this.#link.halt();
            if (restarted || others !== "") {
                throw restarted ? new Restarted(this.#link.name, false) : new OutOfStep(`${this.#link.name}: ${others}`);
            }
            this.#inta = true;
            return { code: DONE, inta: true, values: "" };
        }
        this.#inta = this.#inta && command.text !== "J" && command.text !== "!7J";
        return this.#link.execute(command.text);
    }

    /** Does what a line asks of the host. */
    async #obey(command: Command, asked: Asked): Promise<void> {
        if (asked.kind === "wait") {
            const end = performance.now() + 1000 * asked.seconds;
            for (let left = 1000 * asked.seconds; left > 0; left = end - performance.now()) {
                await this.#link.wire.pause(Math.min(left, POLL_MS));
                await this.#between();
            }
            await this.#link.requireOwn();
        } else if (asked.kind === "pause") {
            await this.#untilStands();
            await this.#hands.askPerson(asked.text);
            this.#link.wire.takeSlept_s();
            await this.#link.requireOwn();
        } else {
            await this.#goBack(command);
        }
    }

    #untilStands(): Promise<number> {
        return this.#link.untilStands(this.#between);
    }

    /** Brings the axes back to where the sensor was touched. */
    async #goBack(command: Command): Promise<void> {
        const link = this.#link;
        const flags = await this.#untilStands();
        if ((flags & INTA) === 0 || flags & INTCOM) {
            throw await this.#unprobed(command, flags & INTCOM ? "a halt (H) has stopped the axes, nothing was touched" : "nothing was touched on the way", flags);
        }
        const [touched, stand] = [await link.positions(true), await link.positions()];
        if ((await link.byte("SR4")) !== 0) {
            throw await this.#interrupted(this.#where(command));
        }
        if (touched.join() === this.#probesFrom?.join()) {
            throw await this.#unprobed(command, "the sensor was touched before the axes moved, so nothing was probed", flags);
        }
        await link.order("SW1,00");
        await link.order("D");
        this.#inta = false;
        // A coupled A goes along by itself.
        await link.order(`L${touched.map((at, axis) => (this.#probed[axis] ? at - (stand[axis] ?? 0) : 0)).join()}`);
        if ((await link.untilStands()) & INTA) {
            throw await this.#interrupted(this.#where(command));
        }
        this.executed?.stood(await link.positions());
    }

    async #unprobed(command: Command, reason: string, flags: number): Promise<Refusal> {
        await this.#link.order("SW1,00"); // the sensor is not to stop what comes later
        const at = positionsText(await this.#link.positions());
        return new Refusal(`${this.#where(command)}: ${reason}`, `the axes stand at ${at}; the unit is ${flagsText(flags)}`);
    }

    async #taken(commands: Command[]): Promise<void> {
        this.#begun = [];
        this.#waits = 0;
        this.sent += commands.filter(isVector).length;
        this.#underWay = [];
        if (commands.some(({ letter }) => letter === "W")) {
            this.executed?.stood(await this.#link.positions()); // has been answered, so the axes stand
        } else {
            this.executed?.taken(commands);
        }
    }

    // ---- answers ----

    /** Notices an interrupt, and what the unit refuses for good. */
    async #judge(command: Command, answer: Answer): Promise<void> {
        const isNew = answer.inta && !this.#inta;
        if (isNew && answer.code === DONE && this.#isProbeNext) {
            return;
        }
        if (isNew && command.letter === "W" && answer.code === BOUNDS) {
            await this.#link.untilStands();
            const at = positionsText(await this.#link.positions());
            const why = "its switch was not found, or not let go, within the ways that were given";
            throw new Refused(this.#where(command), answer, `${why}; the axes stand at ${at}`);
        }
        if (isNew && command.letter !== "R" && !command.text.startsWith("SW6")) {
            throw await this.#interrupted(this.#where(command));
        }
        this.#inta = answer.inta;
        const waits = [NO_ROOM, NOT_WHILE_MOVING].includes(answer.code) && !answer.inta;
        if (waits) {
            this.#underWay = [];
        }
        if (answer.code !== DONE && !waits) {
            throw this.#refused(command, answer);
        }
    }

    get #isProbeNext(): boolean {
        return this.#ahead(0)?.asked?.kind === "probe";
    }

    #refused(command: Command, answer: Answer): Refusal {
        const after = this.sent > 0 ? `; the ${this.sent} vectors before it are executed` : "";
        return new Refused(this.#where(command), answer, `refused: ${answerWords(answer)}${after}`);
    }

    #where({ line, text }: Command): string {
        return `${this.#name}:${line}: ${text}`;
    }

    /** What has stopped the axes, and where they stand. */
    async #interrupted(where: string): Promise<Interrupted> {
        const link = this.#link;
        const flags = await link.untilStands();
        const causes = await causesOf(link, flags);
        const isByInput = causes.length > 0 && (flags & INTCOM) === 0; // H leaves PL as it was
        const latched = isByInput ? `, positions at that moment ${(await link.positions(true)).join()}` : "";
        const positions = await link.positions();
        const cause = causes.join(", ") || "what the unit does not tell";
        const over = this.look(positions);
        const done = over === null ? "it is not known how many vectors" : `${over} vectors`;
        return new Interrupted(
            `${where}: INTERRUPTED by ${cause}${latched}; the axes stand at ${positionsText(positions)}`,
            `${flagsText(flags)}; ${done} were executed, ${this.sent} were sent`,
            { flags, positions },
        );
    }

    /** Waits a little; where nothing moves there will never be room. */
    async #waitForRoom(command: Command): Promise<void> {
        await this.#between();
        await this.#link.wire.pause(NO_ROOM_MS);
        this.#waits += (await this.#link.flags()) & RUN ? 0 : 1;
        if (this.#waits > WAITS_MAX) {
            const cause = `${this.#where(command)}: no room, though nothing moves`;
            throw new Refusal(cause, "after K there is room for one L at a time and for no C");
        }
    }

    /** Waits until nothing moves; what is refused then is refused for good. */
    async #waitForRest(command: Command, answer: Answer): Promise<void> {
        if ((await this.#untilStands()) & INTA) {
            throw await this.#interrupted(this.#where(command));
        }
        this.#waits += 1;
        if (this.#waits > WAITS_MAX) {
            throw this.#refused(command, answer);
        }
    }
}

/** Why a job has ended, with what is not known then. */
export function endOf(error: Refusal, sent: string, isRestart: boolean): Refusal {
    if (!(error instanceof LineTrouble) || isRestart) {
        return error;
    }
    const { kind = "", cause, next } = error.trouble;
    const more = `${sent} vectors were sent and go on by themselves: whether the axes move is NOT KNOWN`;
    return new LineTrouble(kind, `${cause}; ${more}`, next);
}

import { LineTrouble, Refusal } from "../../unit_place";
import { DONE, answerText, answerWords, isReset, type Answer } from "./answers";
import { flagsText, stands, type Positions } from "./told";
import { ANSWERED, ASK, CONNECT, HALT, LONG, OWN, PACKET, PACKET_ONCE, RESET, type Wire } from "./wire";

const HALT_MS = 30_000;
const POLL_MS = 50;
const OTHER_CHARACTERS_MAX = 40;
/** Other ends of enum gve_master_end of tools/gve134_master/gve_master.h. */
const NOT_TAKEN = 2;
const OUT_OF_STEP = 9;
const NOT_CONFIRMED = 11;
const SUMS_OFF = 12;
/** What another program was found to have done when the unit was connected to again. */
const OTHERS: Record<number, string> = {
    [SUMS_OFF]: "another program has switched its checksums off",
    [OUT_OF_STEP]: "whether it has restarted, or another program has switched its checksums off, is NOT KNOWN",
};

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

/** Another program has used the line: what is known of the unit is not true any more. */
export class OutOfStep extends LineTrouble {
    constructor(cause: string) {
        const next = "look at the unit, and see that nothing else uses this line";
        super("OutOfStep", `${cause}; what was sent last may have been executed`, next);
    }
}

/** How the axes stand after a halt; `others`: what another program has done, or perhaps; empty: nothing. */
interface Halted {
    flags: number;
    positions: Positions;
    restarted: boolean;
    others: string;
}

/** The unit has not told that its axes stand. */
export class NotConfirmed extends LineTrouble {
    constructor(cause: string) {
        super("NotConfirmed", cause, "use the emergency stop");
    }
}

/** What the other ends say, by their number. */
const TROUBLES: Record<number, (where: string, what: { command: string; other: string }) => LineTrouble> = {
    3: (where) => {
        const next = "check power, cable (TX and RX crossed) and rate; a unit that waits for its axes answers nothing but HALT";
        return new LineTrouble("NoAnswer", `${where}: the unit does not answer`, next);
    },
    4: (where) => {
        const cause = `${where}: only what is sent comes back, no unit answers`;
        return new LineTrouble("NoAnswer", cause, "are TX and RX connected to each other?");
    },
    5: (where) => {
        const cause = `${where}: what comes back is damaged or not from a GVE134`;
        return new LineTrouble("GarbledAnswer", cause, "check the rate, the cable, and which device is at this port");
    },
    6: (where, { other }) => {
        const cause = `${where}: another device answers, ${other}`;
        return new LineTrouble("OtherDevice", cause, "choose the port of a GVE134");
    },
    7: (where) => new Restarted(where, false),
    8: (where) => new Restarted(where, true),
    [OUT_OF_STEP]: (where) => new OutOfStep(`${where} has counted commands that were not sent from here, or was restarted`),
    [SUMS_OFF]: (where) => new OutOfStep(`${where}: ${OTHERS[SUMS_OFF]}`),
    10: (where, { command }) => {
        const cause = `${where} has executed ${command} or refused it, and the answer was lost for good`;
        return new LineTrouble("EndUnknown", cause, "look at the unit before anything is sent again");
    },
};

/**
 * The host's end of the line, by the rules of firmware/gve134/docs/line.md: no command is executed twice, and none is
 * sent again to a unit that has restarted. tools/gve134_master/gve_master.h says how, state by state.
 */
export class UnitLink {
    readonly wire: Wire;

    constructor(wire: Wire) {
        this.wire = wire;
    }

    get version(): string {
        return this.wire.version;
    }

    get name(): string {
        return this.wire.port.isVirtual ? "the virtual unit" : this.wire.port.name;
    }

    /** Has a command executed once, and returns the answer. */
    ask(command: string): Promise<Answer> {
        return this.#answered(ASK, [command]);
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
        return this.#answered(PACKET, commands);
    }

    /** Sends a packet once; null: it came damaged, and nothing of it was taken. */
    async tryPacket(commands: string[]): Promise<Answer | null> {
        return (await this.#ended(PACKET_ONCE, commands)) === NOT_TAKEN ? null : this.wire.answer;
    }

    /** Has W executed once, which is answered when the axes stand; until then the unit answers nothing. */
    askLong(command: string, wait_ms: number): Promise<Answer> {
        return this.#answered(LONG, [command], wait_ms);
    }

    /** A command as files and people have it; after J the unit that then starts anew is connected to. */
    execute(command: string): Promise<Answer> {
        return this.#answered(isReset(command) ? RESET : ASK, [command]);
    }

    /** Finds out whether a unit is there, and how it stands with checksums and its index. */
    async connect(): Promise<void> {
        await this.#ended(CONNECT, ["?"]);
    }

    /** Executes nothing; fails if the unit has counted what was not sent from here. */
    async requireOwn(): Promise<void> {
        await this.#ended(OWN, ["@"]);
    }

    /** Sends H until it is answered, in whatever state the line is, and sees the axes stand. */
    async halt(): Promise<Halted> {
        await this.#ended(HALT, ["H"], HALT_MS);
        const { restarted } = this.wire;
        const others = OTHERS[this.wire.others] ?? "";
        const flags = await this.flags();
        if (!stands(flags)) {
            throw new NotConfirmed(`${this.name}: the unit tells that it is ${flagsText(flags)}`);
        }
        return { flags, positions: await this.positions(), restarted, others };
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

    async #answered(kind: number, commands: string[], wait_ms = 0): Promise<Answer> {
        await this.#ended(kind, commands, wait_ms);
        return this.wire.answer;
    }

    /** Has a request done; whether it was taken. */
    async #ended(kind: number, commands: string[], wait_ms = 0): Promise<number> {
        const end = await this.wire.ask(kind, commands, wait_ms);
        const isFound = (kind === CONNECT || kind === HALT) && this.wire.others !== 0;
        if (isFound || end === OUT_OF_STEP || end === SUMS_OFF) {
            this.wire.onLost();
        }
        if (end === ANSWERED || end === NOT_TAKEN) {
            return end;
        }
        if (end === NOT_CONFIRMED) {
            const silent = `H has no answer in ${HALT_MS / 1000} s`;
            const what = kind === HALT ? silent : "no answer for a long time, and it is NOT KNOWN whether the axes move";
            throw new NotConfirmed(`${this.name}: ${what}`);
        }
        const isPacket = kind === PACKET || kind === PACKET_ONCE;
        const command = isPacket ? `*E${commands.length}` : (commands[0] ?? "");
        const trouble = TROUBLES[end]?.(this.name, { command, other: this.wire.other.slice(0, OTHER_CHARACTERS_MAX) });
        throw trouble ?? new Error(`the line has ended a request by ${end}`);
    }
}

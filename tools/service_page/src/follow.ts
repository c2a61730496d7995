import { byId } from "./dom";
import type { Holding } from "./holding";
import { language, t } from "./i18n";
import type { Link } from "./link";
import type { Presence } from "./presence";
import { MOTORS, type Live, type MotorLive, type UnitState, type Verdict } from "./protocol";
import type { Programs } from "./programs";

/** What is known of the line that a motor runs; without a line, why none is marked. */
interface Found {
    words: string;
    line: number | null;
    /** Whether reading the unit's program would tell more. */
    isUnread?: boolean;
}

/** Marks the lines that the motors of the unit run, or says why none is marked. */
export class Follow {
    readonly #programs: Programs;
    readonly #holding: Holding;
    readonly #presence: Presence;
    readonly #words = byId("follow", HTMLElement);
    readonly #read = byId("follow-read", HTMLButtonElement);
    #live: Live | null = null;
    #state: UnitState | null = null;

    constructor(link: Link, programs: Programs, holding: Holding, presence: Presence, read: (motor: number) => void) {
        this.#programs = programs;
        this.#holding = holding;
        this.#presence = presence;
        this.#read.addEventListener("click", () => read(programs.shown.value));
        link.on("live", (live) => {
            this.#live = live;
            this.#show();
        });
        link.on("state", (state) => {
            this.#state = state;
            this.#show();
        });
        presence.isFresh.onChange(() => this.#show());
        programs.shown.onChange(() => this.#show());
        language.onChange(() => this.#show());
        this.#show();
    }

    #show(): void {
        for (const motor of MOTORS) {
            const found = this.#find(motor);
            this.#programs.markUnit(motor, found.line);
            if (motor === this.#programs.shown.value) {
                this.#say(found);
            }
        }
    }

    #say({ words, line, isUnread = false }: Found): void {
        if (this.#words.textContent !== words) {
            this.#words.textContent = words;
        }
        this.#words.dataset.line = line === null ? "" : String(line);
        this.#read.hidden = !isUnread;
    }

    #find(motor: number): Found {
        const none = (words: string): Found => ({ words, line: null });
        if (!this.#state?.connected) {
            return none(t("follow.noUnit"));
        }
        const now = this.#presence.isFresh.value ? this.#live?.motors[motor - 1] : undefined;
        if (now === undefined) {
            return none(t("follow.silent"));
        }
        const held = this.#holding.of(motor);
        if (held === null) {
            return { ...none(t("follow.unread", { motor })), isUnread: true };
        }
        const verdict = this.#programs.verdict(motor);
        return verdict === null ? none("") : placed(motor, now, held, verdict);
    }
}

/** The line of the command that a motor runs. */
function placed(motor: number, { running, place = null }: MotorLive, held: string[], { listing = [] }: Verdict): Found {
    const none = (words: string): Found => ({ words, line: null });
    const before = lastPlace(held, listing.map(([, , text]) => text));
    if (before === null) {
        return none(t(held.length === 0 ? "follow.empty" : "follow.other", { motor }));
    }
    if (running === false) {
        return none(t("follow.rests", { motor }));
    }
    if (place === null) {
        return none("");
    }
    const command = listing[place - 1 - before];
    if (command === undefined) {
        return none(t("follow.outside", { motor }));
    }
    const [line, , text] = command;
    return { words: t(running === undefined ? "follow.perhaps" : "follow.line", { motor, line, command: text }), line };
}

/** How many commands stand in the memory before the last copy of a program; null: it is not there. */
function lastPlace(held: string[], program: string[]): number | null {
    for (let before = held.length - program.length; before >= 0 && program.length > 0; before -= 1) {
        if (program.every((text, index) => held[before + index] === text)) {
            return before;
        }
    }
    return null;
}

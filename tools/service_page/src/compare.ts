import { checkProgram } from "./api";
import { byId, make } from "./dom";
import { language, t } from "./i18n";
import type { Link } from "./link";
import { MOTORS, type Answer } from "./protocol";

const [HOLD, RELEASE] = ["[", "]"];
/** What may change the memories. */
const CHANGE = ["send", "send_all", "reset", "connect", "disconnect"];

/** What came of a motor: null as long as its answer is awaited. */
type Found = { kind: "same" | "none" | "refused" } | { kind: "other"; ordinal: number; line: number | null; here: string; there: string };

/** Compares the programs that are here with those in the memories of the unit, which are only read. */
export class Compare {
    readonly #link: Link;
    readonly #texts: () => Record<string, string>;
    readonly #list = byId("compared", HTMLElement);
    readonly #asked = new Map<number, number>();
    #here: Record<string, string> = {};
    #found = new Map<number, Found | null>();

    constructor(link: Link, texts: () => Record<string, string>) {
        this.#link = link;
        this.#texts = texts;
        byId("machine-compare", HTMLButtonElement).addEventListener("click", () => this.#ask());
        link.on("answer", (answer) => void this.#hear(answer));
        language.onChange(() => this.#show());
    }

    /** What was found is not so any more. */
    forget(): void {
        if (this.#found.size > 0) {
            this.#asked.clear();
            this.#found.clear();
            this.#show();
        }
    }

    #ask(): void {
        this.forget();
        this.#here = this.#texts();
        for (const motor of MOTORS) {
            const id = this.#link.nextId();
            this.#asked.set(id, motor);
            const isSent = this.#link.send({ type: "request", id, message: "program", motor });
            this.#found.set(motor, isSent ? null : { kind: "refused" });
        }
        this.#show();
    }

    async #hear({ id, from, message, error, values }: Answer): Promise<void> {
        if (CHANGE.includes(message)) {
            this.forget();
        }
        const motor = id !== null && (from === undefined || from === this.#link.client) ? this.#asked.get(id) : undefined;
        if (motor === undefined || id === null) {
            return;
        }
        const found = error === null ? await this.#compared(motor, values?.program ?? "") : ({ kind: "refused" } as const);
        if (this.#asked.delete(id)) {
            this.#found.set(motor, found);
            this.#show();
        }
    }

    async #compared(motor: number, told: string): Promise<Found> {
        const here = await listed(this.#here[motor] ?? "");
        const there = await listed(told);
        if (here === null || there === null) {
            return { kind: "refused" };
        }
        const [ours, theirs] = [here.map(([, , text]) => text), unbracketed(there.map(([, , text]) => text), here.length)];
        const first = Array.from({ length: Math.max(ours.length, theirs.length) }, (_, index) => index)
            .find((index) => ours[index] !== theirs[index]);
        if (first === undefined) {
            return { kind: ours.length === 0 ? "none" : "same" };
        }
        return { kind: "other", ordinal: first + 1, line: here[first]?.[0] ?? null, here: ours[first] ?? "", there: theirs[first] ?? "" };
    }

    #show(): void {
        const words = [...this.#found].map(([motor, found]) => `${t("motor.one", { motor })}: ${foundWords(found)}`);
        this.#list.replaceChildren(...words.map((each) => make("li", {}, each)));
        this.#list.hidden = words.length === 0;
    }
}

function foundWords(found: Found | null): string {
    if (found === null) {
        return t("compare.asked");
    }
    if (found.kind !== "other") {
        return t(`compare.${found.kind}`);
    }
    const { ordinal, line, here, there } = found;
    const nothing = t("compare.nothing");
    const place = line === null ? t("compare.command", { ordinal }) : t("compare.line", { ordinal, line });
    return t("compare.other", { place, here: here || nothing, there: there || nothing });
}

/** The commands that are stored of a program; null: it has errors. */
async function listed(text: string): Promise<[number, number, string][] | null> {
    if (text.trim() === "") {
        return [];
    }
    const { listing = [], problems } = await checkProgram(text);
    return problems.some(({ severity }) => severity === "error") ? null : listing;
}

/** What is sent in several messages has `[` and `]` around it. */
function unbracketed(commands: string[], wanted: number): string[] {
    const isHeld = commands.length === wanted + 2 && commands[0] === HOLD && commands.at(-1) === RELEASE;
    return isHeld ? commands.slice(1, -1) : commands;
}

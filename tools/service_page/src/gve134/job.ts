import type { Danger } from "../danger";
import { byId, make } from "../dom";
import { Refused, fetchExamples, openExample, openFile } from "./api";
import { clockText, language, numberText, t, told, troubleText } from "./i18n";
import type { FileState, Job, UnitState } from "./protocol";
import type { Unit } from "./unit";

const UNDER_WAY = ["sending", "finishing", "waits"];
const NOT_KNOWN = "–";
/** A slider that is being moved is not set back by what comes. */
const HELD_MS = 1500;

export const isUnderWay = (job: Job | null): boolean => job !== null && UNDER_WAY.includes(job.phase);
export const isOpen = (job: Job | null): boolean => isUnderWay(job) || job?.phase === "held";

/** The file, its start and its end, and the speed of all of it. */
export class JobPanel {
    readonly #unit: Unit;
    readonly #danger: Danger;
    readonly #trouble = byId("file-trouble", HTMLElement);
    readonly #slider = byId("override", HTMLInputElement);
    readonly #words = byId("job-words", HTMLElement);
    #slid_ms = -Infinity;

    constructor(unit: Unit, danger: Danger) {
        this.#unit = unit;
        this.#danger = danger;
        danger.isConfirmed.onChange(() => this.#show());
        this.#listenToFiles("file", "open", "file");
        this.#listenToFiles("machine", "machine-open", "machine-file");
        const examples = byId("examples", HTMLSelectElement);
        examples.addEventListener("change", () => {
            const name = examples.value;
            examples.value = "";
            if (name !== "") {
                void this.#try(openExample(name));
            }
        });
        unit.link.isOpen.onChange((isThere) => isThere && void this.#listExamples(examples));
        byId("start", HTMLButtonElement).addEventListener("click", () => this.#start());
        for (const type of ["go", "delete", "resume"] as const) {
            byId(type, HTMLButtonElement).addEventListener("click", () => unit.ask(type));
        }
        this.#slider.addEventListener("input", () => {
            this.#slid_ms = performance.now();
            this.#showSpeed();
        });
        this.#slider.addEventListener("change", () => this.#override(Number(this.#slider.value)));
        byId("override-full", HTMLButtonElement).addEventListener("click", () => this.#override(100));
        unit.watch(() => this.#show());
        language.onChange(() => this.#show());
    }

    #listenToFiles(kind: "file" | "machine", button: string, place: string): void {
        const input = byId(place, HTMLInputElement);
        byId(button, HTMLButtonElement).addEventListener("click", () => input.click());
        input.addEventListener("change", () => {
            const file = input.files?.[0];
            if (file) {
                const more = kind === "file" && this.#unit.state.value?.file ? `; ${t("machine.notOpened")}` : "";
                void this.#try(openFile(kind, file), more).finally(() => (input.value = ""));
            }
        });
    }

    async #listExamples(chooser: HTMLSelectElement): Promise<void> {
        const names = await fetchExamples().catch(() => []);
        chooser.replaceChildren(
            make("option", { value: "", "data-t": "job.examples" }, t("job.examples")),
            ...names.map((name) => make("option", { value: name }, name)),
        );
    }

    /** `more` is said with what is refused. */
    async #try(work: Promise<void>, more = ""): Promise<void> {
        this.#say("");
        try {
            await work;
        } catch (error) {
            this.#say(error instanceof Refused ? error.message + more : t("state.notSent"));
        }
    }

    #say(words: string): void {
        this.#trouble.textContent = words;
        this.#trouble.hidden = words === "";
    }

    #start(): void {
        const file = this.#unit.state.value?.file;
        if (file) {
            this.#unit.link.send({ type: "start", id: this.#unit.link.nextId(), file: file.number });
        }
    }

    #override(percent: number): void {
        this.#slid_ms = -Infinity;
        this.#unit.link.send({ type: "override", id: this.#unit.link.nextId(), percent });
    }

    #show(): void {
        const state = this.#unit.state.value;
        const file = state?.file ?? null;
        byId("machine-shown", HTMLElement).textContent = state?.machine?.name ?? t("machine.none");
        byId("file-name", HTMLElement).textContent = file?.name ?? t("job.none");
        byId("file-facts", HTMLElement).textContent = file === null ? "" : factsOf(file);
        this.#showButtons(state);
        this.#showProgress(state);
        this.#showSpeed();
        this.#showWords(state?.job ?? null);
    }

    #showButtons(state: UnitState | null): void {
        const doing = this.#unit.doing;
        const job = state?.job ?? null;
        const set = (id: string, enabled: boolean): void => void (byId(id, HTMLButtonElement).disabled = !enabled);
        const isNoted = state?.restarted !== true;
        set("start", state?.file?.ok === true && doing === "rest" && !isOpen(job) && isNoted);
        const isHeld = job?.phase === "held";
        const mayGo = isHeld || this.#danger.isConfirmed.value; // else it is the rest of a motion by hand
        set("go", !isUnderWay(job) && mayGo && (doing === "waits" || (doing === "stopped" && isHeld)));
        set("delete", !isUnderWay(job) && ["waits", "stopped", "fault"].includes(doing));
        set("open", !isOpen(job));
        set("machine-open", !isOpen(job));
        byId("examples", HTMLSelectElement).disabled = isOpen(job);
        byId("resume", HTMLButtonElement).hidden = job?.phase !== "waits";
    }

    #showProgress(state: UnitState | null): void {
        const job = state?.job ?? null;
        const progress = isOpen(job) ? (this.#unit.now?.progress ?? null) : null;
        const bar = byId("progress", HTMLProgressElement);
        const vectors = job !== null && job.file === state?.file?.number ? state.file.vectors : 0;
        bar.value = job?.phase === "done" ? 1 : progress?.at != null && vectors > 0 ? progress.at / vectors : 0;
        const level = progress?.level ?? null;
        byId("level", HTMLElement).textContent = level === null ? NOT_KNOWN : `${numberText(level)} / 128`;
        byId("level-bar", HTMLMeterElement).value = level ?? 0;
        const left = progress?.left_s ?? null;
        byId("left-time", HTMLElement).textContent = left === null ? NOT_KNOWN : clockText(left);
    }

    #showSpeed(): void {
        const { known = null, wanted = null } = this.#unit.state.value ?? {};
        const isSlid = performance.now() - this.#slid_ms < HELD_MS || document.activeElement === this.#slider;
        const percent = known?.percent ?? null;
        const shown = wanted ?? percent;
        if (!isSlid && shown !== null) {
            this.#slider.value = String(shown);
        }
        const isNow = percent !== null && this.#unit.doing !== "unknown";
        const now = isNow ? `${numberText(percent)} %` : `${NOT_KNOWN} %`;
        const target = isSlid && performance.now() - this.#slid_ms < HELD_MS ? Number(this.#slider.value) : wanted;
        const isOther = target !== null && (percent === null || Math.round(percent) !== target);
        byId("override-now", HTMLOutputElement).textContent = isOther ? `→ ${target} %` : now;
    }

    #showWords(job: Job | null): void {
        const progress = this.#unit.now?.progress;
        const trouble = job?.trouble ? `${job.phase === "failed" ? ":" : ""} ${troubleText(job.trouble)}` : "";
        const isLost = isUnderWay(job) && progress?.at === null ? ` (${t("job.lost")})` : "";
        const words = job === null ? "" : t(`job.${job.phase}`, { name: told(job.name), text: job.text }) + trouble + isLost;
        this.#words.dataset.kind =
            job?.phase === "failed" ? "bad" : job?.phase === "held" || job?.phase === "waits" ? "warn" : "none";
        if (this.#words.textContent !== words) {
            this.#words.textContent = words;
        }
    }
}

function factsOf(file: FileState): string {
    if (!file.ok) {
        return t(file.errors === 1 ? "job.error" : "job.errors", { errors: numberText(file.errors) });
    }
    return t("job.facts", { vectors: numberText(file.vectors), time: clockText(file.seconds ?? 0) });
}

import { told } from "./common/told";
import { numberText, t } from "./i18n";
import type { LiveUnit, MotorLive } from "./protocol";

/** Counters of the link that mean bytes or frames were lost. */
const FAULTS = ["stray", "broken", "fcs", "abort", "escape", "short", "long", "gap", "unsent"];
const REPEATS = "repeats";

export type Kind = "unknown" | "failed" | "stopped" | "moves" | "waits" | "rests";

function awaited({ awaited: what }: MotorLive): string {
    if (!what) {
        return t("live.waits");
    }
    const { number, level } = what;
    switch (what.what) {
        case "input":
            return t("live.waitsInput", { number, level });
        case "variable":
            return t("live.waitsVariable", { number, level });
        case "time":
            return t("live.waitsTime");
        default:
            return t("live.waitsRelease");
    }
}

function halted(motor: MotorLive): [Kind, string] | null {
    if (motor.failed) {
        return ["failed", t("live.failed", { error: told(motor.error ?? "") })];
    }
    if (motor.ended) {
        return ["stopped", t("live.ended")];
    }
    return motor.stopped ? ["stopped", t("live.stopped")] : null;
}

/** What a motor does, in a word for the style and in words for people. While T41 is switched it may differ by motor. */
export function motorState(motor: MotorLive): [Kind, string] {
    const [kind, words] = doing(motor);
    return [kind, motor.simulated ? `${words}, ${t("live.simulated")}` : words];
}

function doing(motor: MotorLive): [Kind, string] {
    if (motor.moving === null) {
        return ["unknown", t("live.unknown")];
    }
    const halt = halted(motor);
    if (halt) {
        const [kind, words] = halt;
        return [kind, motor.moving ? `${words}, ${t("live.slowsDown")}` : words];
    }
    if (motor.moving) {
        return ["moves", t(motor.running ? "live.moves" : "live.slowsDown")];
    }
    if (motor.waiting) {
        return ["waits", awaited(motor)];
    }
    return motor.running ? ["waits", t("live.runs")] : ["rests", t("live.idle")];
}

const CAUSES: Record<string, () => string> = {
    reset: () => t("live.causeReset"),
    watchdog: () => t("live.causeWatchdog"),
    fault: () => t("live.causeFault"),
};

/** How the unit in a page keeps up with real time. */
function clockFacts({ clock }: LiveUnit): { words: string; isBad: boolean }[] {
    if (!clock) {
        return [];
    }
    const percent = Math.ceil(100 * clock.load);
    const pace = { words: t("live.clock", { percent: numberText(percent) }), isBad: false };
    const seconds = numberText(Math.round(clock.stood_s));
    return clock.stood_s === 0 ? [pace] : [{ words: t("live.stood", { seconds }), isBad: true }, pace];
}

/** What is to be known of a unit beside its motors, the unusual first. */
export function unitFacts(unit: LiveUnit): { words: string; isBad: boolean }[] {
    const cause = CAUSES[unit.cause]?.() ?? (unit.cause === "power-on" ? "" : told(unit.cause));
    const bad = [
        unit.no_crystal ? t("live.noCrystal") : "",
        unit.not_started ? t("live.notStarted") : "",
        unit.no_store ? t("live.noStore") : "",
        unit.simulating ? t("live.simulating") : "",
        unit.cause === "reset" ? "" : cause,
    ];
    const plain = [
        unit.cause === "reset" ? cause : "",
        unit.memory_locked ? t("live.locked") : "",
        unit.untimed ? t("live.untimed") : "",
    ];
    const late = { words: t("live.late", { count: numberText(unit.late_steps) }), isBad: unit.late_steps > 0 };
    const asFacts = (words: string[], isBad: boolean): { words: string; isBad: boolean }[] =>
        words.filter((each) => each !== "").map((each) => ({ words: each, isBad }));
    return [...asFacts(bad, true), ...clockFacts(unit), ...asFacts(plain, false), late];
}

/** Faults of the line that the unit has counted. */
export function lineWords(unit: LiveUnit): string {
    const faults = FAULTS.reduce((sum, name) => sum + (unit.line[name] ?? 0), 0);
    const words = { faults: numberText(faults), repeats: numberText(unit.line[REPEATS] ?? 0) };
    return t("live.line", words);
}

/** All counters of the line, by their names. */
export function lineCounts(unit: LiveUnit): string {
    return Object.entries(unit.line)
        .map(([name, count]) => `${name.toUpperCase()} ${numberText(count)}`)
        .join(" · ");
}

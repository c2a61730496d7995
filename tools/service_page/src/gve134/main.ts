import { Connection } from "../common/connection";
import { Halt } from "../common/halt";
import { Log } from "../common/log";
import { Loud } from "../common/loud";
import { bringWords } from "../common/told";
import { Danger } from "../danger";
import { byId } from "../dom";
import { Left } from "../left";
import { Link } from "../link";
import { Presence } from "../presence";
import { ServiceLine } from "../service_line";
import { alone } from "./alone/page";
import { Axes } from "./axes";
import { Code } from "./code";
import { isKey, setUpLanguage, t } from "./i18n";
import { JobPanel } from "./job";
import { MachineEditor } from "./machine";
import { PathView } from "./path";
import type { FromService, Live, ToService } from "./protocol";
import { Switches } from "./switches";
import { isInMotion, Unit } from "./unit";

/** Commands that set axes in motion by hand, as the console takes them; SW6 does where vectors wait. */
const MOVES = /^\s*(!0)?\s*([LCG]|SW0*6)/i;
/** Requests after which the axes may move. */
const SETS_OFF: ToService["type"][] = ["go", "resume", "start", "home", "jog", "typed"];

/*
 * Puts the parts together; each sees the unit, and none of them another. Nothing on this page acts on a unit except
 * what the user presses.
 */
const link = new Link<FromService, ToService>(() => alone?.line() ?? new ServiceLine());
bringWords("gve134", alone?.words);
setUpLanguage(byId("language", HTMLSelectElement));
const presence = new Presence(link.isOpen);
link.on("state", (state) => presence.setState(state));
link.on("live", () => presence.look());

const unit = new Unit(link, presence);
const danger = new Danger("danger-confirm");
unit.state.watch((state) => danger.setPlace(state));
const left = new Left<Live>(link, t, { name: "left_gve134", moves: ({ flags }) => isInMotion(flags) });
link.on("state", ({ reference }) => reference && left.mark()); // it tells nothing meanwhile
link.onSent(({ type }) => SETS_OFF.includes(type) && left.mark());
new Halt(unit, t, left, { moves: () => ["moves", "brakes", "reference"].includes(unit.doing) });
new Connection(unit, t, {
    quiet: () => (unit.doing === "reference" ? t("state.reference") : null),
    keeps: () => unit.state.value?.job?.phase === "sending",
    form: alone?.form,
});
new Loud(unit, t, {
    didMove: () => unit.last.value !== null && isInMotion(unit.last.value.flags),
    isTold: () => unit.doing !== "unknown",
    restarted: () => t("loud.restartedMore"),
    more: () => {
        if (unit.doing === "fault") {
            return `${t("loud.fault")}\n${t("loud.faultMore")}`;
        }
        return unit.doing === "crystal" ? t("loud.crystal") : "";
    },
});
const log = new Log(unit, t, (message) => {
    const key = `message.${message}`;
    return isKey(key) ? t(key) : message;
});
listenForTyped();
new JobPanel(unit, danger);
new MachineEditor(unit);
new Code(unit);
new PathView(unit);
new Axes(unit, danger, (words) => refuse("jog", words));
new Switches(unit);
const top = byId("top", HTMLElement);
new ResizeObserver(() => document.body.style.setProperty("--top", `${top.clientHeight}px`)).observe(top);
if (alone === null || alone.begin(unit)) {
    link.open();
}

/** Says why something was not done. */
function refuse(message: string, words: string): void {
    log.say(message, { cause: words, next: "" });
}

/** Commands as they are typed. */
function listenForTyped(): void {
    const typed = byId("typed", HTMLInputElement);
    byId("console", HTMLFormElement).addEventListener("submit", (event) => {
        event.preventDefault();
        if (MOVES.test(typed.value) && !danger.isConfirmed.value) {
            refuse("typed", t("danger.first", { command: typed.value.trim() }));
            return;
        }
        if (unit.link.send({ type: "typed", id: unit.link.nextId(), text: typed.value })) {
            typed.value = "";
        }
    });
}

import { Connection } from "../common/connection";
import { Halt } from "../common/halt";
import { Log } from "../common/log";
import { Loud } from "../common/loud";
import { byId } from "../dom";
import { Link } from "../link";
import { Presence } from "../presence";
import { ServiceLine } from "../service_line";
import { Axes } from "./axes";
import { Code } from "./code";
import { isKey, setUpLanguage, t } from "./i18n";
import { JobPanel } from "./job";
import { PathView } from "./path";
import type { FromService, ToService } from "./protocol";
import { Switches } from "./switches";
import { doingOf, Unit } from "./unit";

/*
 * Puts the parts together; each sees the unit, and none of them another. Nothing on this page acts on a unit except
 * what the user presses.
 */
const link = new Link<FromService, ToService>(() => new ServiceLine());
setUpLanguage(byId("language", HTMLSelectElement));
const presence = new Presence(link.isOpen);
link.on("state", (state) => presence.setState(state));
link.on("live", () => presence.look());

const unit = new Unit(link, presence);
new Halt(unit, t);
new Connection(unit, t, {
    quiet: () => (unit.doing === "reference" ? t("state.reference") : null),
    keeps: () => unit.state.value?.job?.phase === "sending",
});
new Loud(unit, t, {
    didMove: () => unit.last.value !== null && ["moves", "brakes"].includes(doingOf(unit.last.value.flags)),
    isTold: () => unit.doing !== "unknown",
    restarted: () => t("loud.restartedMore"),
    more: () => {
        if (unit.doing === "fault") {
            return `${t("loud.fault")}\n${t("loud.faultMore")}`;
        }
        return unit.doing === "crystal" ? t("loud.crystal") : "";
    },
});
new Log(unit, t, (message) => {
    const key = `message.${message}`;
    return isKey(key) ? t(key) : message;
});
listenForTyped();
new JobPanel(unit);
new Code(unit);
new PathView(unit);
new Axes(unit);
new Switches(unit);
const top = byId("top", HTMLElement);
new ResizeObserver(() => document.body.style.setProperty("--top", `${top.clientHeight}px`)).observe(top);
link.open();

/** Commands as they are typed. */
function listenForTyped(): void {
    const typed = byId("typed", HTMLInputElement);
    byId("console", HTMLFormElement).addEventListener("submit", (event) => {
        event.preventDefault();
        if (unit.link.send({ type: "typed", id: unit.link.nextId(), text: typed.value })) {
            typed.value = "";
        }
    });
}

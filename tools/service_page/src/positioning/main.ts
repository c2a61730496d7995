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
import { Curves } from "./curves";
import { Facts } from "./facts";
import { named, setUpLanguage, t } from "./i18n";
import { CONDITION, type FromService, type ToService } from "./protocol";
import { SettingsPanel } from "./settings";
import { Unit, moves } from "./unit";

/*
 * Puts the parts together; each sees the unit, and none of them another. Nothing on this page acts on a unit except
 * what the user presses.
 */
const link = new Link<FromService, ToService>(() => alone?.line() ?? new ServiceLine());
bringWords("positioning", alone?.words);
setUpLanguage(byId("language", HTMLSelectElement));
const presence = new Presence(link.isOpen);
link.on("state", (state) => presence.setState(state));
link.on("live", () => presence.look(unit.state.value?.node));

const unit = new Unit(link, presence);
const danger = new Danger("danger-confirm");
unit.state.watch((state) => danger.setPlace(state));
const left = new Left(link, t, { name: "left_positioning", moves: () => unit.didMove });
link.on("state", ({ doubt }) => doubt && left.mark());
new Halt(unit, t, left, { moves: () => unit.now?.axes.some(moves) === true, part: heldAxis, name: "unheld_positioning" });
new Connection(unit, t, { form: alone?.form });
new Loud(unit, t, {
    didMove: () => unit.didMove,
    isTold: () => unit.now !== null,
    restarted: () => t("loud.restartedMore"),
    more: alsoLoud,
});
new Log(unit, t, (message) => named("message", message));
new Facts(unit);
new Axes(unit, danger);
new Curves(unit);
new SettingsPanel(unit);
const top = byId("top", HTMLElement);
new ResizeObserver(() => document.body.style.setProperty("--top", `${top.clientHeight}px`)).observe(top);
if (alone === null || alone.begin(unit)) {
    link.open();
}

/** The axis whose hold is not confirmed, where it is no stop of more than that. */
function heldAxis(): string {
    const { unheld = [] } = unit.state.value ?? {};
    return unheld.length === 1 ? unheld.join() : "";
}

/** What must not be overlooked of a unit that answers, or that nobody asks any more. */
function alsoLoud(): string {
    const { now } = unit;
    const condition = now?.unit.condition ?? 0;
    if (condition & CONDITION.crystal) {
        return t("loud.crystal");
    }
    if (condition & CONDITION.damaged) {
        return `${t("loud.damaged")}\n${t("loud.damagedMore")}`;
    }
    const others = now?.axes.filter(({ by_other }) => by_other).map(({ axis }) => axis) ?? [];
    return others.length > 0 ? `${t("loud.others", { axes: others.join(", ") })}\n${t("loud.othersMore")}` : "";
}

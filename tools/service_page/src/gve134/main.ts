import { byId } from "../dom";
import { Link } from "../link";
import { Presence } from "../presence";
import { ServiceLine } from "../service_line";
import { Axes } from "./axes";
import { Code } from "./code";
import { Connection } from "./connection";
import { Halt } from "./halt";
import { setUpLanguage } from "./i18n";
import { JobPanel } from "./job";
import { Log } from "./log";
import { Loud } from "./loud";
import { PathView } from "./path";
import type { FromService, ToService } from "./protocol";
import { Switches } from "./switches";
import { Unit } from "./unit";

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
new Halt(unit);
new Connection(unit);
new Loud(unit);
new Log(unit);
new JobPanel(unit);
new Code(unit);
new PathView(unit);
new Axes(unit);
new Switches(unit);
const top = byId("top", HTMLElement);
new ResizeObserver(() => document.body.style.setProperty("--top", `${top.clientHeight}px`)).observe(top);
link.open();

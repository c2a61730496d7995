import { AllPrograms } from "./all_programs";
import { Commission } from "./commission";
import { Commands } from "./commands";
import { Compare } from "./compare";
import { bringWords } from "./common/told";
import { Connection } from "./connection";
import { byId } from "./dom";
import { engine } from "./engine";
import { FirmwarePanel } from "./firmware_panel";
import { Follow } from "./follow";
import { HelpPanel } from "./help_panel";
import { Holding } from "./holding";
import { numberText, setUpLanguage, t } from "./i18n";
import { parseInputs } from "./inputs_text";
import { setLimits, speedLimit, tooFast, type TooFast } from "./limits";
import { Left } from "./left";
import { Link } from "./link";
import { LiveView } from "./live";
import { Log } from "./log";
import { Machine } from "./machine";
import { Plan } from "./plan";
import { Presence } from "./presence";
import { PrintView } from "./print";
import { Programs } from "./programs";
import { ALL_MOTORS, type Live } from "./protocol";
import { ScaleSwitch } from "./scale";
import { Scan } from "./scan";
import { ServiceLine } from "./service_line";
import { asNodes, Stop } from "./stop";
import { StoreAll } from "./store_all";

/*
 * Puts the parts together. The parts do not know each other; what one of them needs of another is handed in
 * here. Nothing on this page acts on a unit except what the user presses (stop.ts, commands.ts, connection.ts).
 */
const link = new Link(() => (engine === null ? new ServiceLine() : engine.line()));
bringWords("rkm04", engine?.words);
setUpLanguage(byId("language", HTMLSelectElement));

const plan: Plan = new Plan(() => programs.texts(), () => compare.forget());
const programs: Programs = new Programs({
    edit: () => {
        plan.programsChanged();
        compare.forget();
        storeAll.forget();
    },
    check: () => plan.programsChecked(),
    replace: () => plan.programReplaced(),
    example: (example) => plan.setInputs(example.inputs ?? []),
});
plan.follow(programs);
const log = new Log(link, (motor, text) => programs.replace(motor, text));
const commands = new Commands(
    link,
    () => {
        const motor = programs.shown.value;
        return { motor, text: programs.text(motor) };
    },
    (wanted, send) => void sendAllowed(wanted, send),
);
new AllPrograms(
    commands,
    () => programs.texts(),
    () => log.say("send_all", { cause: t("all.empty"), next: "" }),
);
new Scan(link, commands);
const presence = new Presence(link.isOpen);
link.on("state", (state) => presence.setState(state));
link.on("live", ({ node }) => presence.look(node));
const left: Left<Live> = new Left<Live>(link, t, {
    name: "left",
    moves: ({ motors }) => motors.some(({ moving, running, speed }) => (moving ?? Boolean(speed)) || running === true),
    nameOf: ({ port, node = 0 }) => t("stop.nodeOf", { node, port }),
    reachesPort: true,
    dealt: (units) => {
        const nodes = asNodes(units);
        const isTold = link.send({ type: "forget", nodes });
        if (isTold) {
            stop.forget(nodes);
        }
        return isTold;
    },
});
link.onSent((message) => {
    if (message.type === "resume" || (message.type === "request" && message.message.startsWith("send"))) {
        left.mark();
    }
});
const stop: Stop = new Stop(link, left);
new Connection(link, presence);
const live = new LiveView(link, presence);
const holding = new Holding(link);
holding.restarted.onChange((restarted) => (byId("loud", HTMLElement).hidden = !restarted));
byId("seen", HTMLButtonElement).addEventListener("click", () => holding.note());
new Follow(link, programs, holding, presence, (motor) => commands.request("program", motor));
const machine = new Machine({
    programs: () => programs.all(),
    inputs: () => plan.inputs,
    open: (four, inputs) => {
        programs.replaceAll(four);
        plan.setInputs(parseInputs(inputs) ?? []);
    },
});
const headingOf = (plot: string): string => byId(plot, HTMLElement).previousElementSibling?.textContent ?? "";
new PrintView(() => ({
    machine: machine.content.value,
    programs: programs.all().map(({ text }) => text),
    inputs: plan.inputs,
    curve: plan.curve,
    headings: { speed: headingOf("plan-speed"), position: headingOf("plan-position") },
}));
const scale = new ScaleSwitch(commands.motor);
machine.content.watch((content) => {
    programs.setNames((content?.motors ?? []).map(({ name }) => name ?? ""));
    live.setNames(content?.input_names, content?.output_names);
    scale.setMachine(content);
    setLimits(content);
});

stop.onPress(() => commands.forgetReset());
const commission = new Commission(link, presence, {
    motor: programs.shown,
    insert: (text) => programs.insert(text),
    stop: () => stop.press(),
});
stop.onPress(() => commission.stopped());
const compare: Compare = new Compare(link, {
    texts: () => programs.texts(),
    machine: () => machine.whole(),
    read: (file) => machine.read(file),
});
machine.content.onChange(() => compare.forget());
const storeAll = new StoreAll(link, () => programs.texts(), () => commands.request("store", ALL_MOTORS));
new HelpPanel((example) => programs.take(example));
new FirmwarePanel();
link.onRefused((message) => {
    if (message.type !== "ports" && message.type !== "hold") {
        const name = message.type === "request" ? message.message : message.type;
        log.say(name, { cause: t(engine === null ? "state.notSent" : "alone.notSent"), next: "" });
    }
});

commands.motor.onChange((motor) => {
    if (motor !== ALL_MOTORS && motor !== programs.shown.value) {
        programs.shown.set(motor);
    }
});
programs.shown.onChange((motor) => {
    if (commands.motor.value === ALL_MOTORS) {
        commands.describe();
    } else if (commands.motor.value !== motor) {
        commands.motor.set(motor);
    }
});
link.on("answer", ({ message, from, error }) => {
    const isOwn = from === undefined || from === link.client;
    if ((message === "send" || message === "send_all") && isOwn && error?.line !== undefined) {
        programs.shown.set(error.motor ?? programs.shown.value);
        programs.goTo(error.line, error.column ?? 1);
    }
});

link.isOpen.onChange((isOpen) => {
    if (isOpen) {
        programs.check();
        plan.programsChanged();
    }
});
plan.programsChanged();

/** A program or a speed beyond the machine's limit is not sent; where there is no limit nothing is waited for. */
async function sendAllowed(wanted: [motor: number, text: string][], send: () => void): Promise<void> {
    const limited = wanted.filter(([motor]) => speedLimit(motor) < Infinity);
    let found: TooFast | null;
    try {
        found = limited.length === 0 ? null : await tooFast(limited);
    } catch {
        log.say("send", { cause: t("limits.unknown"), next: "" });
        return;
    }
    if (found === null) {
        send();
        return;
    }
    const { line, column } = found;
    log.say("send", { cause: t("limits.speed", { ...found, limit: numberText(found.limit) }), next: t("limits.next") });
    if (wanted.some(([motor, text]) => motor === found.motor && text === programs.text(motor))) {
        programs.shown.set(found.motor);
        programs.goTo(line, column);
    }
}

if (engine !== null) {
    document.body.dataset.alone = engine.hasUnit ? "unit" : "programs";
}
if (engine === null || engine.hasUnit) {
    link.open();
} else {
    programs.check();
}

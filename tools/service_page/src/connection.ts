import { byId, make } from "./dom";
import { engine } from "./engine";
import { language, numberText, t } from "./i18n";
import type { Link } from "./link";
import type { Presence } from "./presence";
import { ALL_MOTORS, type Port, type UnitState } from "./protocol";
import { hasSerial } from "./serial_ports";
import { troubleText } from "./common/told";

const VIRTUAL = "virtual";
const OTHER = "";
const NODES = 16;
const SWITCHES = 4;

/** Port, node, and the state of the connection. Only the button connects: choosing sends nothing. */
export class Connection {
    readonly #link: Link;
    readonly #presence: Presence;
    readonly #port = byId("port", HTMLSelectElement);
    readonly #other = byId("port-other", HTMLInputElement);
    readonly #node = byId("node", HTMLSelectElement);
    readonly #rate = byId("rate", HTMLSelectElement);
    readonly #button = byId("connect", HTMLButtonElement);
    readonly #pill = byId("state", HTMLElement);
    readonly #banner = byId("banner", HTMLElement);
    #ports: Port[] = [];
    #state: UnitState | null = null;

    constructor(link: Link, presence: Presence) {
        this.#link = link;
        this.#presence = presence;
        for (let node = 1; node <= NODES; node += 1) {
            this.#node.append(make("option", { value: String(node) }, String(node)));
        }
        this.#port.addEventListener("change", () => this.#portChosen());
        this.#node.addEventListener("change", () => this.#showSwitches());
        document.body.dataset.serial = String(hasSerial);
        byId("ports", HTMLButtonElement).addEventListener("click", () => link.send({ type: "ports" }));
        byId("connection-form", HTMLFormElement).addEventListener("submit", (event) => {
            event.preventDefault();
            this.#connectOrNot();
        });
        link.on("ports", ({ ports }) => this.#setPorts(ports));
        link.on("state", (state) => this.#setState(state));
        link.isOpen.onChange(() => this.#linkChanged());
        presence.isFresh.onChange(() => this.#showState());
        presence.seconds.onChange(() => this.#showState());
        language.watch(() => {
            this.#showPorts();
            this.#showSwitches();
            this.#showState();
            this.#askForPorts(); // their labels have words, too
        });
    }

    /** Whether the port is open, or will be when it is there again. */
    get #isWanted(): boolean {
        return this.#state?.connected === true || this.#state?.away === true;
    }

    #askForPorts(): void {
        if (this.#link.isOpen.value) {
            this.#link.send({ type: "ports" });
        }
    }

    #linkChanged(): void {
        this.#askForPorts();
        this.#showState();
    }

    #connectOrNot(): void {
        if (this.#isWanted) {
            this.#link.send({ type: "disconnect" });
            return;
        }
        const port = this.#port.value === OTHER ? this.#other.value.trim() : this.#port.value;
        if (port === "") {
            this.#other.focus();
            return;
        }
        const rate = engine === null ? {} : { rate: Number(this.#rate.value) };
        this.#link.send({ type: "connect", port, node: Number(this.#node.value), ...rate });
    }

    #setPorts(ports: Port[]): void {
        this.#ports = ports.filter(({ port }) => port !== VIRTUAL);
        this.#showPorts();
    }

    #setState(state: UnitState): void {
        const isNews = state.port !== this.#state?.port || state.node !== this.#state.node;
        this.#state = state;
        if (isNews && state.connected && state.port !== null) {
            this.#choosePort(state.port);
            this.#node.value = String(state.node || ALL_MOTORS + 1);
            this.#showSwitches();
        }
        this.#showState();
    }

    #choosePort(port: string): void {
        const isListed = [...this.#port.options].some((option) => option.value === port);
        this.#port.value = isListed ? port : OTHER;
        this.#other.value = isListed ? "" : port;
        this.#portChosen();
    }

    #portChosen(): void {
        this.#other.hidden = this.#port.value !== OTHER;
    }

    #showPorts(): void {
        const chosen = this.#port.value || (this.#other.value ? OTHER : VIRTUAL);
        this.#port.replaceChildren(
            make("option", { value: VIRTUAL }, t("port.virtual")),
            ...this.#ports.map(({ port, label }) => make("option", { value: port }, label || port)),
            ...(engine === null ? [make("option", { value: OTHER }, t("port.other"))] : []),
        );
        this.#choosePort(chosen || this.#other.value);
    }

    /** The setting of the address switch S1 that gives the chosen node. */
    #showSwitches(): void {
        const bits = Number(this.#node.value) - 1;
        const host = byId("switches", HTMLElement);
        const isOn = (index: number): boolean => ((bits >> index) & 1) === 1;
        const switches = Array.from({ length: SWITCHES }, (_, index) =>
            make("i", { "data-on": String(isOn(index)) }),
        );
        const words = switches.map((_, index) => `S1-${index + 1} ${isOn(index) ? "ON" : "OFF"}`);
        host.replaceChildren(...switches);
        host.title = words.join(", ");
        host.setAttribute("aria-label", `${t("connection.switch")}: ${words.join(", ")}`);
    }

    #showState(): void {
        const state = this.#state;
        const isOpen = this.#link.isOpen.value;
        const isFresh = this.#presence.isFresh.value;
        const isBad = (!isOpen && engine?.hasUnit !== false) || (state?.error && !state.connected);
        this.#pill.dataset.kind = isFresh ? "good" : isBad ? "bad" : "idle";
        const [place, ...more] = this.#stateText(isOpen, isFresh);
        this.#pill.replaceChildren(
            make("span", { class: "place" }, place ?? ""),
            ...(more.length > 0 ? [make("span", { class: "more" }, more.join(" · "))] : []),
        );
        this.#button.textContent = t(this.#isWanted ? "connection.disconnect" : "connection.connect");
        this.#button.classList.toggle("primary", !this.#isWanted);
        this.#button.disabled = !isOpen;
        for (const field of [this.#port, this.#node, this.#other, this.#rate]) {
            field.disabled = this.#isWanted;
        }
        const trouble = this.#troubleText(isOpen);
        if (this.#banner.textContent !== trouble) {
            this.#banner.textContent = trouble;
        }
        this.#banner.hidden = trouble === "";
        document.body.dataset.virtual = String(state?.virtual !== false);
        document.body.dataset.connected = String(isOpen && state?.connected === true);
    }

    #troubleText(isOpen: boolean): string {
        if (!isOpen) {
            const isExpected = engine === null || (engine.hasUnit && this.#link.client !== null);
            const words = this.#state?.virtual === false ? "alone.lineLost" : "alone.lost";
            return isExpected ? t(engine === null ? "state.lost" : words) : "";
        }
        const trouble = this.#state?.error ? troubleText(this.#state.error) : "";
        return this.#state?.away ? `${trouble}. ${t("state.comesBack")}` : trouble;
    }

    /** The place first, which gives way where there is no room for it. */
    #stateText(isOpen: boolean, isFresh: boolean): string[] {
        const state = this.#state;
        if (engine?.hasUnit === false) {
            return [t("alone.noUnit")];
        }
        if (!isOpen) {
            return [t(engine === null ? "state.noService" : "alone.away")];
        }
        const port = state?.virtual ? t("port.virtualShort") : (state?.port ?? "");
        const seconds = this.#presence.seconds.value;
        const seen = seconds === null ? t("state.neverSeen") : t("state.seen", { seconds: numberText(seconds) });
        if (state?.away) {
            return [t("state.away", { port }), seen];
        }
        if (!state?.connected) {
            return [t("state.disconnected")];
        }
        const version = state.unit ? state.unit.version : "";
        const busy = state.busy ? t("state.busy") : "";
        const isHere = engine !== null && state.virtual;
        const place = isHere ? t("alone.state") : t("state.connected", { port, node: state.node });
        return [place, ...[isFresh ? version : seen, busy].filter((part) => part !== "")];
    }
}

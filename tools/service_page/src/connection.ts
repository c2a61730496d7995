import { byId, make } from "./dom";
import { language, t } from "./i18n";
import type { Link } from "./link";
import { ALL_MOTORS, type Port, type UnitState } from "./protocol";
import { troubleText } from "./trouble";

const VIRTUAL = "virtual";
const OTHER = "";
const NODES = 16;
const SWITCHES = 4;

/** Port, node, and the state of the connection. Only the button connects: choosing sends nothing. */
export class Connection {
    readonly #link: Link;
    readonly #port = byId("port", HTMLSelectElement);
    readonly #other = byId("port-other", HTMLInputElement);
    readonly #node = byId("node", HTMLSelectElement);
    readonly #button = byId("connect", HTMLButtonElement);
    readonly #pill = byId("state", HTMLElement);
    readonly #banner = byId("banner", HTMLElement);
    #ports: Port[] = [];
    #state: UnitState | null = null;

    constructor(link: Link) {
        this.#link = link;
        for (let node = 1; node <= NODES; node += 1) {
            this.#node.append(make("option", { value: String(node) }, String(node)));
        }
        this.#port.addEventListener("change", () => this.#portChosen());
        this.#node.addEventListener("change", () => this.#showSwitches());
        byId("ports", HTMLButtonElement).addEventListener("click", () => link.send({ type: "ports" }));
        byId("connection-form", HTMLFormElement).addEventListener("submit", (event) => {
            event.preventDefault();
            this.#connectOrNot();
        });
        link.on("ports", ({ ports }) => this.#setPorts(ports));
        link.on("state", (state) => this.#setState(state));
        link.isOpen.onChange((isOpen) => this.#linkChanged(isOpen));
        language.watch(() => {
            this.#showPorts();
            this.#showSwitches();
            this.#showState();
        });
    }

    get isConnected(): boolean {
        return this.#link.isOpen.value && this.#state?.connected === true;
    }

    #linkChanged(isOpen: boolean): void {
        if (isOpen) {
            this.#link.send({ type: "ports" });
        }
        this.#showState();
    }

    #connectOrNot(): void {
        if (this.#state?.connected) {
            this.#link.send({ type: "disconnect" });
            return;
        }
        const port = this.#port.value === OTHER ? this.#other.value.trim() : this.#port.value;
        if (port === "") {
            this.#other.focus();
            return;
        }
        this.#link.send({ type: "connect", port, node: Number(this.#node.value) });
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
            make("option", { value: OTHER }, t("port.other")),
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
        const isConnected = isOpen && state?.connected === true;
        this.#pill.dataset.kind = isConnected ? "good" : state?.error || !isOpen ? "bad" : "idle";
        this.#pill.textContent = this.#stateText(isOpen);
        this.#button.textContent = t(state?.connected ? "connection.disconnect" : "connection.connect");
        this.#button.classList.toggle("primary", !state?.connected);
        this.#button.disabled = !isOpen;
        for (const field of [this.#port, this.#node, this.#other]) {
            field.disabled = state?.connected === true;
        }
        const trouble = !isOpen ? t("state.lost") : state?.error ? troubleText(state.error) : "";
        this.#banner.textContent = trouble;
        this.#banner.hidden = trouble === "";
        document.body.dataset.connected = String(isConnected);
    }

    #stateText(isOpen: boolean): string {
        const state = this.#state;
        if (!isOpen) {
            return t("state.noService");
        }
        if (!state?.connected) {
            return t("state.disconnected");
        }
        const port = state.virtual ? t("port.virtualShort") : (state.port ?? "");
        const version = state.unit ? ` · ${state.unit.version}` : "";
        const busy = state.busy ? ` · ${t("state.busy")}` : "";
        return t("state.connected", { port, node: state.node }) + version + busy;
    }
}

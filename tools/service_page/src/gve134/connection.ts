import { byId, make } from "../dom";
import { language, numberText, t, troubleText } from "./i18n";
import { type Port } from "./protocol";
import type { Unit } from "./unit";

const VIRTUAL = "virtual";
const OTHER = "";

/** Port, and the state of the connection. Only the button connects: choosing sends nothing. */
export class Connection {
    readonly #unit: Unit;
    readonly #port = byId("port", HTMLSelectElement);
    readonly #other = byId("port-other", HTMLInputElement);
    readonly #button = byId("connect", HTMLButtonElement);
    readonly #pill = byId("state", HTMLElement);
    #ports: Port[] = [];
    #shown: string | null = null;

    constructor(unit: Unit) {
        this.#unit = unit;
        this.#port.addEventListener("change", () => this.#portChosen());
        byId("ports", HTMLButtonElement).addEventListener("click", () => unit.link.send({ type: "ports" }));
        byId("connection-form", HTMLFormElement).addEventListener("submit", (event) => {
            event.preventDefault();
            this.#connectOrNot();
        });
        unit.link.on("ports", ({ ports }) => {
            this.#ports = ports.filter(({ port }) => port !== VIRTUAL);
            this.#showPorts();
        });
        unit.link.isOpen.onChange((isOpen) => isOpen && unit.link.send({ type: "ports" }));
        language.watch(() => this.#showPorts());
        unit.watch(() => this.#show());
        language.onChange(() => this.#show());
    }

    get #isWanted(): boolean {
        const state = this.#unit.state.value;
        return state?.connected === true || state?.away === true;
    }

    #connectOrNot(): void {
        if (this.#isWanted) {
            this.#unit.link.send({ type: "disconnect" });
            return;
        }
        const port = this.#port.value === OTHER ? this.#other.value.trim() : this.#port.value;
        if (port === "") {
            this.#other.focus();
            return;
        }
        this.#unit.link.send({ type: "connect", port });
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
        const chosen = this.#port.value || this.#other.value || VIRTUAL;
        this.#port.replaceChildren(
            make("option", { value: VIRTUAL }, t("port.virtual")),
            ...this.#ports.map(({ port, label }) => make("option", { value: port }, label || port)),
            make("option", { value: OTHER }, t("port.other")),
        );
        this.#choosePort(chosen);
    }

    #show(): void {
        const state = this.#unit.state.value;
        const isOpen = this.#unit.link.isOpen.value;
        if (state?.port && state.port !== this.#shown) {
            this.#choosePort(state.port);
        }
        this.#shown = state?.port ?? null;
        const isGood = this.#unit.presence.isFresh.value || this.#unit.doing === "reference";
        this.#pill.dataset.kind = isGood ? "good" : !isOpen || state?.error ? "bad" : "idle";
        this.#pill.textContent = this.#words(isGood).join(" · ");
        this.#button.textContent = t(this.#isWanted ? "connection.disconnect" : "connection.connect");
        this.#button.classList.toggle("primary", !this.#isWanted);
        this.#button.disabled = !isOpen || (state?.job?.phase ?? "done") === "sending";
        this.#port.disabled = this.#other.disabled = this.#isWanted;
        this.#showBanner(isOpen);
        document.body.dataset.connected = String(isOpen && state?.connected === true);
    }

    #showBanner(isOpen: boolean): void {
        const banner = byId("banner", HTMLElement);
        const state = this.#unit.state.value;
        const trouble = state?.error ? troubleText(state.error) : "";
        const words = !isOpen ? t("state.lost") : state?.away ? `${trouble}. ${t("state.comesBack")}` : trouble;
        banner.hidden = words === "" || (!isOpen && this.#unit.link.client === null);
        if (banner.textContent !== words) {
            banner.textContent = words;
        }
    }

    #words(isGood: boolean): string[] {
        const state = this.#unit.state.value;
        if (!this.#unit.link.isOpen.value) {
            return [t("state.noService")];
        }
        const port = state?.virtual ? t("port.virtualShort") : (state?.port ?? "");
        const seconds = this.#unit.presence.seconds.value;
        const seen = seconds === null ? t("state.neverSeen") : t("state.seen", { seconds: numberText(seconds) });
        if (state?.away) {
            return [t("state.away", { port }), seen];
        }
        if (!state?.connected) {
            return [t("state.disconnected")];
        }
        const more = state.reference ? t("state.reference") : (state.version ?? "");
        return [port, isGood ? more : seen];
    }
}

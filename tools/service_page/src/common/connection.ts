import { byId, make } from "../dom";
import { language, numberText } from "../language";
import type { Port } from "../protocol";
import type { Known } from "./known";
import { troubleText } from "./told";
import type { CommonWords } from "./words";

const VIRTUAL = "virtual";
const OTHER = "";

/** What a unit adds: why it is well although it tells nothing, and whether its port must stay open. */
export interface ConnectionOptions {
    quiet?: () => string | null;
    keeps?: () => boolean;
    /** Of a page that needs no service: how a port of the browser is to be opened. There are no other ports. */
    form?: (() => object) | undefined;
}

/** Port and, where the page has one, address, and the state of the connection. Only the button connects. */
export class Connection {
    readonly #unit: Known;
    readonly #t: CommonWords;
    readonly #options: ConnectionOptions;
    readonly #port = byId("port", HTMLSelectElement);
    readonly #other = byId("port-other", HTMLInputElement);
    readonly #node = document.querySelector<HTMLSelectElement>("#node");
    readonly #button = byId("connect", HTMLButtonElement);
    readonly #pill = byId("state", HTMLElement);
    #ports: Port[] = [];
    #shown: string | null = null;

    constructor(unit: Known, t: CommonWords, options: ConnectionOptions = {}) {
        this.#unit = unit;
        this.#t = t;
        this.#options = options;
        this.#port.addEventListener("change", () => this.#portChosen());
        byId("ports", HTMLButtonElement).addEventListener("click", () => unit.link.send({ type: "ports" }));
        byId("connection-form", HTMLFormElement).addEventListener("submit", (event) => {
            event.preventDefault();
            this.#connectOrNot();
        });
        unit.link.on("ports", ({ ports }: { ports: Port[] }) => {
            this.#ports = ports.filter(({ port }) => port !== VIRTUAL);
            this.#showPorts();
        });
        unit.link.isOpen.onChange((isOpen) => isOpen && unit.link.send({ type: "ports" }));
        language.watch(() => this.#showPorts());
        unit.watch(() => this.#show());
        language.onChange(() => {
            this.#show();
            if (unit.link.isOpen.value) {
                unit.link.send({ type: "ports" }); // their labels have words, too
            }
        });
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
        const wanted = { type: "connect", port, ...(this.#node === null ? {} : { node: Number(this.#node.value) }), ...this.#options.form?.() };
        this.#unit.link.send(wanted);
    }

    #choosePort(port: string): void {
        const isListed = [...this.#port.options].some((option) => option.value === port);
        this.#port.value = isListed ? port : OTHER;
        this.#other.value = isListed ? "" : port;
        this.#portChosen();
    }

    #portChosen(): void {
        this.#other.hidden = this.#port.value !== OTHER;
        if (this.#node !== null) {
            this.#node.disabled = this.#isWanted || this.#port.value === VIRTUAL;
        }
    }

    #showPorts(): void {
        const chosen = this.#port.value || this.#other.value || VIRTUAL;
        this.#port.replaceChildren(
            make("option", { value: VIRTUAL }, this.#t("port.virtual")),
            ...this.#ports.map(({ port, label }) => make("option", { value: port }, label || port)),
            ...(this.#options.form === undefined ? [make("option", { value: OTHER }, this.#t("port.other"))] : []),
        );
        this.#choosePort(chosen);
    }

    #show(): void {
        const state = this.#unit.state.value;
        const isOpen = this.#unit.link.isOpen.value;
        if (state?.port && state.port !== this.#shown) {
            this.#choosePort(state.port);
            if (this.#node !== null) {
                this.#node.value = String(state.node ?? 1);
            }
        }
        this.#shown = state?.port ?? null;
        const isGood = this.#unit.presence.isFresh.value || this.#quiet !== null;
        this.#pill.dataset.kind = isGood ? "good" : !isOpen || state?.error ? "bad" : "idle";
        this.#pill.textContent = this.#words(isGood).join(" · ");
        this.#button.textContent = this.#t(this.#isWanted ? "connection.disconnect" : "connection.connect");
        this.#button.classList.toggle("primary", !this.#isWanted);
        this.#button.disabled = !isOpen || this.#options.keeps?.() === true;
        this.#port.disabled = this.#other.disabled = this.#isWanted;
        this.#portChosen();
        this.#showBanner(isOpen);
        document.body.dataset.connected = String(isOpen && state?.connected === true);
    }

    get #quiet(): string | null {
        return this.#options.quiet?.() ?? null;
    }

    #showBanner(isOpen: boolean): void {
        const banner = byId("banner", HTMLElement);
        const state = this.#unit.state.value;
        const trouble = state?.error ? troubleText(state.error) : "";
        const words = !isOpen ? this.#t("state.lost") : state?.away ? `${trouble}. ${this.#t("state.comesBack")}` : trouble;
        banner.hidden = words === "" || (!isOpen && this.#unit.link.client === null);
        if (banner.textContent !== words) {
            banner.textContent = words;
        }
    }

    #words(isGood: boolean): string[] {
        const state = this.#unit.state.value;
        if (!this.#unit.link.isOpen.value) {
            return [this.#t("state.noService")];
        }
        const node = state?.node === undefined || state.virtual ? "" : ` #${state.node}`;
        const port = state?.virtual ? this.#t("port.virtualShort") : `${state?.port ?? ""}${node}`;
        const seconds = this.#unit.presence.seconds.value;
        const seen = seconds === null ? this.#t("state.neverSeen") : this.#t("state.seen", { seconds: numberText(seconds) });
        if (state?.away) {
            return [this.#t("state.away", { port }), seen];
        }
        if (!state?.connected) {
            return [this.#t("state.disconnected")];
        }
        return [port, isGood ? (this.#quiet ?? state.version ?? "") : seen];
    }
}

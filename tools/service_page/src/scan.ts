import type { Commands } from "./commands";
import { told } from "./common/told";
import { byId, make } from "./dom";
import { language, t } from "./i18n";
import type { Link } from "./link";
import { ALL_MOTORS, type FoundUnit, type UnitState } from "./protocol";

/** Who is on the line: every unit that has answered is a button that goes to it. Looking only asks. */
export class Scan {
    readonly #link: Link;
    readonly #button = byId("scan", HTMLButtonElement);
    readonly #list = byId("found", HTMLElement);
    #state: UnitState | null = null;
    #found: FoundUnit[] | null = null;

    constructor(link: Link, commands: Commands) {
        this.#link = link;
        this.#button.addEventListener("click", () => commands.request("scan", ALL_MOTORS));
        link.on("answer", ({ values }) => {
            if (values?.found) {
                this.#found = values.found;
                this.#show();
            }
        });
        link.on("state", (state) => this.#setState(state));
        link.isOpen.onChange(() => this.#show());
        language.watch(() => this.#show());
    }

    #setState(state: UnitState): void {
        if (!state.connected || state.port !== this.#state?.port) {
            this.#found = null;
        }
        this.#state = state;
        this.#show();
    }

    #show(): void {
        this.#button.disabled = !this.#link.isOpen.value || this.#state?.connected !== true;
        this.#list.hidden = this.#found === null;
        const words = this.#found?.length ? t("scan.found") : t("scan.none");
        const units = this.#found?.map((unit) => this.#unit(unit)) ?? [];
        this.#list.replaceChildren(make("span", { class: "hint" }, words), ...units);
    }

    #unit(unit: FoundUnit): HTMLElement {
        const isShown = unit.node === this.#state?.node;
        const { node, version, date, remark } = unit;
        const about = [t("scan.goTo", { node }), version, date, told(remark)].filter(Boolean).join("; ");
        const attributes = { type: "button", title: about, "aria-label": about, "aria-pressed": String(isShown) };
        const button = make("button", attributes, String(node));
        button.classList.toggle("danger", unit.remark !== "");
        button.addEventListener("click", () => {
            if (this.#state?.port) {
                this.#link.send({ type: "connect", port: this.#state.port, node: unit.node });
            }
        });
        return button;
    }
}

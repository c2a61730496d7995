import { byId, make } from "../dom";
import { language, t, type Key } from "./i18n";
import { doingOf, type Unit } from "./unit";

/** After so long without a word from the unit it is said in large letters. */
const SILENT_MS = 2000;
const LOOK_MS = 250;

/** What must not be overlooked: a unit that is silent, has restarted, or may not move. */
export class Loud {
    readonly #unit: Unit;
    readonly #box = byId("loud", HTMLElement);
    readonly #seen = byId("seen", HTMLButtonElement);
    #fresh_ms = performance.now();
    #shown = "";

    constructor(unit: Unit) {
        this.#unit = unit;
        this.#seen.addEventListener("click", () => unit.ask("seen"));
        unit.watch(() => this.#show());
        language.onChange(() => this.#show());
        window.setInterval(() => this.#show(), LOOK_MS);
    }

    #show(): void {
        const found = this.#find();
        const more = found.slice(1).map((key) => t(key)).join(" ");
        const words = found[0] === undefined ? "" : `${t(found[0])}\n${more}`;
        this.#seen.hidden = found[0] !== "loud.restarted";
        if (words === this.#shown) {
            return;
        }
        this.#shown = words;
        this.#box.hidden = words === "";
        const [head = "", rest = ""] = words.split("\n");
        this.#box.querySelector("span")?.replaceChildren(head, ...(rest === "" ? [] : [make("small", {}, rest)]));
    }

    /** The headline, then what else is to be said. */
    #find(): Key[] {
        const state = this.#unit.state.value;
        const last = this.#unit.last.value;
        const didMove = last !== null && ["moves", "brakes"].includes(doingOf(last.flags));
        const isTold = this.#unit.doing !== "unknown" || state?.busy === "connect" || state === null;
        if (isTold || !(state.connected || state.away)) {
            this.#fresh_ms = performance.now();
        }
        if (state?.restarted) {
            return ["loud.restarted", "loud.restartedMore"];
        }
        if (state?.error && !state.connected && (state.away || didMove)) {
            return didMove ? ["loud.lost", "loud.moving"] : ["loud.lost"];
        }
        if (state?.connected && (performance.now() - this.#fresh_ms > SILENT_MS || state.error !== null)) {
            return didMove ? ["loud.silent", "loud.moving"] : ["loud.silent"];
        }
        if (this.#unit.doing === "fault") {
            return ["loud.fault", "loud.faultMore"];
        }
        return this.#unit.doing === "crystal" ? ["loud.crystal"] : [];
    }
}

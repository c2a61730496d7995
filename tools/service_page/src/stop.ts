import { byId } from "./dom";
import { language, t } from "./i18n";
import type { Left, Place } from "./left";
import type { Link } from "./link";
import type { Answer, Node, UnitState } from "./protocol";
import { listenForStop } from "./stop_press";
import { isStopped } from "./unit_messages";

const DONE_MS = 4000;

const VIRTUAL = "virtual";
/** Units of this page have addresses. */
export const asNodes = (units: Place[]): Node[] => units.map(({ port, node = 0 }) => ({ port, node }));
const keyOf = ({ port, node }: Node): string => `${node} ${port}`;

/**
 * STOP: the button, the Escape key, and the line that says who has not confirmed. It is believed only when every
 * unit has confirmed that was seen since the page was opened, also by a service that has been started anew since, and
 * every one that was left while it moved.
 */
export class Stop {
    readonly #link: Link;
    readonly #left: Left;
    readonly #button = byId("stop", HTMLButtonElement);
    readonly #alarm = byId("alarm", HTMLElement);
    readonly #known = new Map<string, Node>();
    readonly #onPress: (() => void)[] = [];
    #state: UnitState | null = null;
    /** The nodes of a stop that the service does not answer for: it has not yet, or has gone; null: there is none. */
    #open: Map<string, Node> | null = null;
    /** Whether a stop from this page has been answered, or will not be. */
    #isOver = true;
    #confirmed: Node[] = [];
    #forget = 0;

    constructor(link: Link, left: Left) {
        this.#link = link;
        this.#left = left;
        link.on("state", (state) => this.#setState(state));
        link.on("answer", (answer) => this.#hear(answer));
        link.on("live", ({ motors }) => motors.every(isStopped) || this.#celebrate());
        link.isOpen.onChange(() => this.#linkChanged());
        listenForStop(this.#button, () => this.press());
        language.onChange(() => this.#show());
        left.onChange(() => this.#show());
    }

    /** Calls back at every stop from this page. */
    onPress(callback: () => void): void {
        this.#onPress.push(callback);
    }

    /** Stops all motors: at once, whatever else is under way. */
    press(): void {
        const named = [...(this.#state?.stop ?? []), ...asNodes(this.#left.units)];
        const before = named.map((node) => [keyOf(node), node] as const);
        this.#open = new Map([...(this.#open ?? []), ...before, ...this.#known]);
        this.#confirmed = [];
        this.#isOver = false;
        this.#show();
        const nodes = [...this.#open.values()];
        this.#isOver = !this.#link.send({ type: "stop", id: this.#link.nextId(), nodes });
        this.#show();
        this.#onPress.forEach((callback) => callback());
    }

    /** The user has dealt with these; whether the others have confirmed only the next stop tells. */
    forget(nodes: Node[]): void {
        for (const node of nodes) {
            this.#known.delete(keyOf(node));
            this.#open?.delete(keyOf(node));
        }
        this.#show();
    }

    #setState(state: UnitState): void {
        const waits = state.stop?.map(keyOf);
        for (const key of (this.#state?.stop ?? []).map(keyOf)) {
            if (waits?.includes(key) === false) {
                this.#known.delete(key); // it has been dealt with, perhaps in another window
            }
        }
        this.#state = state;
        for (const node of state.nodes) {
            this.#known.set(keyOf(node), node);
        }
        if (this.#isOver && this.#open?.size === 0 && state.stop === null) {
            this.#open = null;
        }
        this.#show();
    }

    #hear({ message, from, error, values }: Answer): void {
        if (/^(send|resume)/.test(message) && error === null && !/^[K\\]$/.test(values?.alone ?? "")) {
            this.#celebrate(); // what has been stopped may move again
        }
        if (message !== "stop") {
            return;
        }
        const confirmed = values?.confirmed ?? [];
        confirmed.forEach((node) => this.#open?.delete(keyOf(node)));
        this.#left.forget(confirmed);
        if (from === this.#link.client) {
            this.#isOver = true;
            this.#open = null; // the service knows from now on, also of the nodes that this page has named
        } else if (this.#isOver && this.#open?.size === 0) {
            this.#open = null;
        }
        if (error === null) {
            this.#celebrate(confirmed);
        }
        this.#show();
    }

    /** What has not confirmed, without the virtual units of a port that was closed: they move nothing. */
    #outside(): Node[] {
        const all = [...(this.#open?.values() ?? []), ...(this.#state?.stop ?? [])];
        const nodes = [...new Map(all.map((node) => [keyOf(node), node])).values()];
        return nodes.filter(({ port }) => port !== VIRTUAL || this.#state?.port === VIRTUAL);
    }

    #celebrate(confirmed: Node[] = []): void {
        this.#confirmed = confirmed;
        window.clearTimeout(this.#forget);
        this.#forget = window.setTimeout(() => {
            this.#confirmed = [];
            this.#show();
        }, DONE_MS);
        this.#show();
    }

    /** A stop whose answer is lost with the service is not confirmed, and neither is one that was open there. */
    #linkChanged(): void {
        if (!this.#link.isOpen.value) {
            const left = (this.#state?.stop ?? null)?.map((node) => [keyOf(node), node] as const) ?? null;
            this.#open = left === null ? this.#open : new Map([...(this.#open ?? []), ...left]);
            this.#state = null;
            this.#isOver = true;
        }
        this.#show();
    }

    #show(): void {
        const isOpen = this.#open !== null || (this.#state?.stop ?? null) !== null;
        this.#left.await(this.#outside());
        this.#alarm.dataset.lost = String(this.#state?.lost === true);
        const isUnderWay = isOpen && (!this.#isOver || this.#state?.busy === "stop");
        const isDone = this.#confirmed.length > 0 && this.#left.names === "";
        const kind = isUnderWay ? "asked" : isOpen ? "failed" : isDone ? "done" : "none";
        const words = kind === "none" ? "" : kind === "done" ? this.#doneText() : this.#openText();
        this.#alarm.dataset.kind = kind;
        this.#alarm.hidden = kind === "none";
        if (this.#alarm.textContent !== words) {
            this.#alarm.textContent = words;
        }
    }

    #names(nodes: Node[]): string {
        const here = this.#state?.port ?? null;
        const name = ({ port, node }: Node): string =>
            port === here || port === VIRTUAL ? t("stop.node", { node }) : t("stop.nodeOf", { node, port });
        return nodes.map(name).join(", ");
    }

    #openText(): string {
        const nodes = this.#names(this.#outside());
        const words = t(this.#state?.lost === true ? "stop.lost" : "stop.notConfirmed");
        return nodes === "" ? words : `${words} (${nodes})`;
    }

    #doneText(): string {
        return t("stop.confirmed", { nodes: this.#names(this.#confirmed) });
    }
}

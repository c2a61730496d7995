import { byId, make } from "./dom";
import { language, type Translate } from "./language";
import type { leftEn } from "./left_words";
import { keep, recall } from "./storage";

const VIRTUAL = "virtual";

/** A unit: a port and, where units have them, an address. */
export interface Place {
    port: string;
    node?: number;
}

interface Connected {
    connected: boolean;
    away: boolean;
    port: string | null;
    node?: number;
}

interface Told {
    on(kind: "state" | "live", handler: (message: any) => void): void;
}

/** What differs from unit to unit. */
export interface LeftOptions<Live> {
    /** Under which the browser keeps them. */
    name: string;
    /** Whether something moves there, or is to. */
    moves: (live: Live) => boolean;
    /** What a unit is called; virtual ones have a name. */
    nameOf?: (unit: Place) => string;
    /** Whether a stop reaches all units of the port, not only that which is connected. */
    reachesPort?: boolean;
    /** Says that the user has dealt with units; returns whether that was taken. */
    dealt?: (units: Place[]) => boolean;
}

const keyOf = ({ port, node = 0 }: Place): string => `${node} ${port}`;
const usualName = ({ port, node }: Place): string => (node === undefined ? port : `${port} #${node}`);

/**
 * Units of which something moved when they were seen last, and those that have not confirmed a stop. What a stop from
 * here does not reach is told until it is connected again, or the user says that it is dealt with; the browser keeps
 * those that moved, so that loading the page does not forget them.
 */
export class Left<Live = any> {
    readonly #t: Translate<keyof typeof leftEn | "port.virtualShort">;
    readonly #options: LeftOptions<Live>;
    readonly #box = byId("left-units", HTMLElement);
    readonly #units: Map<string, Place>;
    readonly #onChange: (() => void)[] = [];
    /** Those that have not confirmed a stop. */
    #stopping: Place[] = [];
    #at: Connected | null = null;
    #shown = "";

    constructor(link: Told, t: Translate<keyof typeof leftEn | "port.virtualShort">, options: LeftOptions<Live>) {
        this.#t = t;
        this.#options = options;
        this.#units = new Map(recall<Place[]>(options.name, []).map((unit) => [keyOf(unit), unit]));
        link.on("state", (state: Connected) => {
            this.#at = state;
            this.#show();
        });
        link.on("live", (live: Live & { node?: number }) => {
            if (live.node === undefined || live.node === this.#at?.node) {
                this.mark(options.moves(live));
            }
        });
        byId("dealt", HTMLButtonElement).addEventListener("click", () => this.#deal());
        language.onChange(() => this.#show());
    }

    /** All of them, those that a stop reaches, too. */
    get units(): Place[] {
        return [...this.#units.values()];
    }

    /** Those that no stop from here reaches, in words; empty: there is none. */
    get names(): string {
        const nameOf = this.#options.nameOf ?? usualName;
        return this.#left.map((unit) => (unit.port === VIRTUAL ? this.#t("port.virtualShort") : nameOf(unit))).join(", ");
    }

    /** Calls back when there may be others. */
    onChange(show: () => void): void {
        this.#onChange.push(show);
    }

    /** Something moves, or may move, at the unit that is connected. */
    mark(moves = true): void {
        const { connected, away, port, node } = this.#at ?? {};
        if (port == null || !(connected || away)) {
            return;
        }
        const unit = node === undefined ? { port } : { port, node };
        if (this.#units.has(keyOf(unit)) === moves) {
            return;
        }
        if (moves) {
            this.#units.set(keyOf(unit), unit);
            this.#changed();
        } else {
            this.forget([unit]);
        }
    }

    /** A stop waits for these; those of other ports are told, too, as long as it does. */
    await(units: Place[]): void {
        if (units.map(keyOf).join() !== this.#stopping.map(keyOf).join()) {
            this.#stopping = units;
            this.#show();
        }
    }

    /** Nothing moves there, as far as that has to be told. */
    forget(units: Place[]): void {
        units.forEach((unit) => this.#units.delete(keyOf(unit)));
        this.#changed();
    }

    /** Virtual units of a port that was closed move nothing. */
    get #left(): Place[] {
        const at = this.#at;
        const units = [...new Map([...this.units, ...this.#stopping].map((unit) => [keyOf(unit), unit])).values()];
        if (at === null || !(at.connected || at.away)) {
            return at === null ? [] : units;
        }
        const isReached = ({ port, node }: Place): boolean =>
            port === at.port && (this.#options.reachesPort === true || node === at.node);
        return units.filter((unit) => unit.port !== VIRTUAL && !isReached(unit));
    }

    #deal(): void {
        const units = this.#left;
        if (this.#options.dealt?.(units) ?? true) {
            this.forget(units);
        }
    }

    #changed(): void {
        keep(this.#options.name, this.units);
        this.#show();
    }

    #show(): void {
        const units = this.names;
        this.#box.hidden = units === "";
        const title = this.#t("left.title", { units });
        if (title !== this.#shown) {
            this.#shown = title;
            this.#box.querySelector("span")?.replaceChildren(title, make("small", {}, this.#t("left.words")));
        }
        this.#onChange.forEach((show) => show());
    }
}

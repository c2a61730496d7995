import { SeenUnit } from "../common/known";
import type { Link } from "../link";
import type { Presence } from "../presence";
import { Cell } from "../signal";
import { STATUS, type AxisLive, type FromService, type Live, type Settings, type ToService, type UnitState } from "./protocol";

export type UnitLink = Link<FromService, ToService>;

export const moves = (axis: AxisLive): boolean => (axis.status & STATUS.JEDE) !== 0;

/** Whether it has a measure that is not reached. */
export const isUnderWay = ({ status }: AxisLive): boolean => (status & STATUS.PROG) !== 0 && (status & STATUS.POL) === 0;

/** What the page knows of the unit. */
export class Unit extends SeenUnit<UnitLink, UnitState, Live> {
    readonly settings = new Cell<Settings>({ values: null, file: null });
    #moved = false;
    #place = "";

    constructor(link: UnitLink, presence: Presence) {
        super(link, presence);
        link.on("live", (live) => {
            this.#moved = live.axes.some(moves);
            this.last.set(live);
        });
        link.on("settings", (settings) => this.settings.set(settings));
        this.state.onChange((state) => {
            const place = state === null || state.port === null ? this.#place : `${state.port} ${state.node}`;
            if (state?.restarted || place !== this.#place) {
                this.#moved = false; // what has restarted stands, and another unit is not known yet
            }
            this.#place = place;
        });
    }

    /** Whether it moved when it was last seen, or was told to move and has not answered. */
    get didMove(): boolean {
        return this.#moved || this.state.value?.doubt === true;
    }

    axis(number: number): AxisLive | null {
        return this.now?.axes[number - 1] ?? null;
    }

    /** Asks for something by a type that needs no more. */
    ask(type: "halt" | "seen" | "settings" | "store" | "deliver"): boolean {
        return this.link.send({ type, id: this.link.nextId() });
    }

    /** Likewise for an axis. */
    askAxis(type: "hold" | "take" | "release" | "capture", axis: number): boolean {
        return this.link.send({ type, id: this.link.nextId(), axis });
    }
}

import { numberText, t } from "./i18n";
import { AXES, type MachineAxis } from "./protocol";
import type { Unit } from "./unit";

/** Whether a jog leads beyond the lowest or the highest position that a machine file gives an axis. */
export class Reach {
    readonly #unit: Unit;
    /** Jogs of this page without an answer, and the ways of jogs that no look has shown yet, pulses. */
    readonly #asked = new Set<number>();
    readonly #unseen = AXES.map(() => 0);

    constructor(unit: Unit) {
        this.#unit = unit;
        unit.link.on("answer", ({ id, from }) => {
            if (id !== null && from === unit.link.client) {
                this.#asked.delete(id);
            }
        });
        unit.link.on("live", () => {
            if (this.#asked.size === 0) {
                this.#unseen.fill(0);
            }
        });
        unit.link.isOpen.onChange(() => {
            this.#asked.clear();
            this.#unseen.fill(0);
        });
    }

    /** Why the axis may not go such a way, in words; null: it may. What leads back from beyond a limit it always may. */
    obstacle(axis: number, way: number, of: MachineAxis | null): string | null {
        const position = this.#unit.now?.positions[axis];
        const limit = way < 0 ? of?.lowest : of?.highest;
        if (of === null || limit === null || limit === undefined || position === undefined) {
            return null;
        }
        const target = position + (this.#unseen[axis] ?? 0) + way;
        const isBeyond = way < 0 ? target < limit : target > limit;
        return isBeyond ? beyondText(AXES[axis] ?? "", target, limit, of) : null;
    }

    /** A jog was asked for. */
    note(id: number, axis: number, way: number): void {
        this.#asked.add(id);
        this.#unseen[axis] = (this.#unseen[axis] ?? 0) + way;
    }
}

function beyondText(axis: string, target: number, limit: number, { unit, steps_per_unit: per }: MachineAxis): string {
    const text = (steps: number): string => numberText(steps / per, 3);
    return t("jog.beyond", { axis, target: text(target), limit: text(limit), unit: unit === "mm" ? "mm" : "°" });
}

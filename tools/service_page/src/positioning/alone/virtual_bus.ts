import { PacedUnit } from "../../common/paced_unit";
import type { Bytes } from "../../program_host";
import { Bus } from "./bus";
import { Master } from "./master";

export const VIRTUAL = "virtual";

/** The virtual unit of the page, and the bus to it. */
export class VirtualBus extends Bus {
    readonly port = VIRTUAL;
    readonly isVirtual = true;
    readonly unit: PacedUnit;

    constructor(bytes: Bytes, now_ms: number) {
        super(new Master(bytes, 0));
        this.unit = new PacedUnit(bytes, "pos_unit_begin", now_ms);
    }

    /** Lets the unit come nearer to the time that it is, and hears it; returns whether it is behind yet. */
    follow(now_ms: number): boolean {
        const isBehind = this.unit.follow(now_ms);
        const said = this.unit.takeSaid();
        if (said.length > 0) {
            this.hear(said);
        }
        return isBehind;
    }

    protected send(data: Bytes): void {
        this.unit.hear(data);
    }

    close(): void {}
}

import { PacedUnit } from "../../common/paced_unit";
import type { Bytes } from "../../program_host";
import { VIRTUAL, type VirtualPort } from "./desk";

/** The virtual unit of the page, as a port. */
export class VirtualUnit extends PacedUnit implements VirtualPort {
    readonly name = VIRTUAL;
    readonly isVirtual = true;
    readonly baud = 115_200;

    constructor(bytes: Bytes, now_ms: number) {
        super(bytes, "gve_unit_begin", now_ms);
    }

    write(data: Bytes): void {
        this.hear(data);
    }
}

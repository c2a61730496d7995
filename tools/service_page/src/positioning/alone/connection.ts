import { LineTrouble, Refusal } from "../../unit_place";
import type { Trouble } from "../../protocol";
import type { ToService } from "../protocol";
import { versionText, type Names } from "./axis_state";
import { GONE, type Board } from "./board";
import { PortTrouble, type Bus } from "./bus";
import { Restarted, Unit } from "./client";
import { Looks } from "./looks";
import { readAll, textOf, type AllSettings } from "./settings_all";
import { VIRTUAL, type VirtualBus } from "./virtual_bus";
import { Wire } from "./wire";

/** From one look to the next at least. */
const LOOK_MS = 100;
/** Of WATCHDOG, which the line may rest. */
const WATCHDOG_SHARE = 0.25;

export type Connect = Extract<ToService, { type: "connect" }> & { failed?: Trouble };

export const NOT_CONNECTED = new Refusal("no port is open", "connect first", { kind: "NotConnected" });

/** The port, the unit at its end, and what is seen of it. */
export class Connection {
    unit: Unit | null = null;
    looks = new Looks();
    /** Null: they are not known. */
    settings: AllSettings | null = null;
    look_due_ms = 0;
    readonly #board: Board;
    readonly #virtual: VirtualBus;
    readonly #names: Names;
    readonly #mindHalt: () => void;
    /** A port that the page has opened. */
    #offered: Bus | null = null;

    constructor(board: Board, virtual: VirtualBus, names: Names, mindHalt: () => void) {
        this.#board = board;
        this.#virtual = virtual;
        this.#names = names;
        this.#mindHalt = mindHalt;
    }

    /** The page has opened a port, to which it will connect. */
    offer(bus: Bus): void {
        this.#offered = bus;
    }

    /** Opens the port if it is not open, and asks what is there: nothing moves. */
    async connect({ port, node, failed }: Connect): Promise<string> {
        const isVirtual = port === VIRTUAL;
        const wanted = { port, virtual: isVirtual, node: isVirtual ? 1 : node };
        const { state } = this.#board;
        const isSame = state.port === wanted.port && state.node === wanted.node;
        if (!isSame) {
            this.looks = new Looks();
        }
        if (this.unit === null || !isSame || failed !== undefined) {
            this.close();
            this.#board.heard_ms = null;
            this.#board.change({ ...GONE, ...wanted });
            this.#open(isVirtual ? this.#virtual : this.#offered, wanted, failed);
        }
        this.#board.change({ connected: true });
        await this.look();
        const version = this.version;
        this.#board.change({ version, error: null });
        return version;
    }

    #open(bus: Bus | null, wanted: { port: string; node: number }, failed: Trouble | undefined): void {
        if (failed !== undefined) {
            throw new PortTrouble(failed.kind ?? "", failed.cause, failed.next);
        }
        if (bus === null || bus.port !== wanted.port) {
            throw new PortTrouble("PortMissing", `${wanted.port} is not open`, "connect again");
        }
        this.unit = new Unit(new Wire(bus, wanted.node, this.#mindHalt, this.#names.exceptions), this.#names);
    }

    disconnect(): string {
        this.close();
        this.#board.change({ ...GONE, port: null, virtual: false });
        return "the port is closed; the unit is left as it is";
    }

    close(): void {
        this.unit?.wire.bus.close();
        this.unit = null;
        this.#tellSettings(null);
    }

    /** The version, after a look. */
    get version(): string {
        return versionText(this.looks.unit?.version ?? 0);
    }

    // ---- what is seen ----

    /** Looks at the unit, and tells what there is to be seen. */
    async look(): Promise<void> {
        const unit = this.required();
        this.look_due_ms = performance.now() + Math.min(LOOK_MS, this.pause_most_ms);
        const live = await this.looks.look(unit, this.#board.state.virtual ? this.#virtual.unit.stood_s : 0);
        this.#board.heard_ms = performance.now();
        this.#board.tell({ type: "live", ...live });
        this.#board.change({ doubt: false });
        if (this.settings === null) {
            await this.readSettings();
        }
    }

    required(): Unit {
        if (this.unit === null) {
            throw NOT_CONNECTED;
        }
        return this.unit;
    }

    /** How long the line may rest, so that the unit's WATCHDOG does not act. */
    get pause_most_ms(): number {
        const watchdog_ms = this.settings?.unit.WATCHDOG ?? 0;
        return watchdog_ms === 0 ? Infinity : watchdog_ms * WATCHDOG_SHARE;
    }

    async readSettings(): Promise<AllSettings> {
        const found = await readAll(this.required());
        this.#tellSettings(found);
        return found;
    }

    forgetSettings(): void {
        this.#tellSettings(null);
    }

    #tellSettings(found: AllSettings | null): void {
        if (found !== null || this.settings !== null) {
            this.settings = found;
            this.tellSettings();
        }
    }

    tellSettings(): void {
        const file = this.settings === null ? null : textOf(this.settings);
        this.#board.tell({ type: "settings", values: this.settings, file });
    }

    // ---- what has come of it ----

    /** The unit has started anew: what it was told is gone. */
    restart(): void {
        this.looks = new Looks();
        this.#tellSettings(null);
        this.#board.change({ restarted: true, doubt: false });
    }

    /** Keeps what says that there is no connection. A port that is lost is closed, and stays so until the user connects. */
    note(got: unknown): void {
        const { restarted, doubt } = this.#board.state;
        if (!(got instanceof Refusal)) {
            this.#board.change({ error: null });
        } else if (got instanceof Restarted) {
            this.restart();
        } else if (got instanceof PortTrouble) {
            this.close();
            this.#board.change({ ...GONE, error: got.trouble, restarted, doubt });
        } else if (got instanceof LineTrouble) {
            this.#board.change({ error: got.trouble });
        }
    }
}

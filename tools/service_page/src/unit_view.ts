import { ALL_MOTORS, MOTORS, type Live, type MotorLive } from "./protocol";
import * as messages from "./unit_messages";
import { LOOKING, type Place } from "./unit_place";
import { Places } from "./unit_places";
import { Speeds } from "./unit_speeds";

export type Ask = (request: Uint8Array<ArrayBuffer>, wait: typeof LOOKING) => Promise<Uint8Array>;

/** What the motors of a unit do now. */
export class UnitView {
    /** What was seen last; null: nothing yet. */
    last: Live | null = null;
    readonly names: messages.StatusNames;
    #speeds = new Speeds();
    #places = new Places();
    #tellsStatus = true;

    constructor(names: messages.StatusNames) {
        this.names = names;
    }

    /** Forgets what was seen: it is another unit, or may be. */
    begin(): void {
        this.last = null;
        this.#speeds = new Speeds();
        this.#places = new Places();
        this.#tellsStatus = true;
    }

    /** Asks for the status, or for what other software can tell; changes nothing there. */
    async look(place: Place, node: number, load: number, ask: Ask): Promise<Live> {
        if (this.#tellsStatus) {
            try {
                const answer = await ask(Uint8Array.of(messages.GET_STATUS), LOOKING);
                const { motors } = messages.status(answer, this.names);
                await this.#places.look(MOTORS.filter((motor) => motors[motor - 1]?.running), ask);
                return this.show(place, node, answer, load);
            } catch (error) {
                if (!(error instanceof messages.UnknownMessage)) {
                    throw error;
                }
                this.#tellsStatus = false;
            }
        }
        const answer = await ask(messages.request(messages.GET_POSITION, ALL_MOTORS), LOOKING);
        const found = messages.positions(answer, ALL_MOTORS);
        await this.#places.look([...MOTORS], ask);
        const motors = MOTORS.map((motor) => ({ position: found[motor] ?? 0, speed: null, moving: null }));
        return this.#told({ node, time_s: place.now_s, motors, inputs: null, outputs: null, unit: null });
    }

    /** What an answer to Get Status says that has just come. */
    show(place: Place, node: number, answer: Uint8Array, load: number): Live {
        const { inputs, outputs, motors, unit } = messages.status(answer, this.names);
        const { now_s, stood_s } = place;
        const clock = stood_s === null ? {} : { clock: { stood_s, load } };
        return this.#told({ node, time_s: now_s, motors, inputs, outputs, unit: { ...unit, ...clock } });
    }

    #told(live: Live): Live {
        const speeds = this.#speeds.of(live.time_s, live.motors.map(({ position }) => position));
        const motors = live.motors.map((motor, index) => {
            const speed = speedOf(motor, speeds[index] ?? null);
            return { ...motor, speed, place: this.#places.of(index + 1) };
        });
        this.last = { ...live, motors };
        return this.last;
    }
}

/** A motor that stands has no speed, whatever its program writes to its position. */
function speedOf({ moving }: MotorLive, seen: number | null): number | null {
    return moving === false ? 0 : seen;
}

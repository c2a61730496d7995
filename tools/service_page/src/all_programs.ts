import { byId } from "./dom";
import type { Commands } from "./commands";
import { ALL_MOTORS } from "./protocol";

/** The programs of all motors at once: each motor gets its own. */
export class AllPrograms {
    constructor(commands: Commands, texts: () => Record<string, string>, onEmpty: () => void) {
        const together = byId("together", HTMLInputElement);
        byId("send-all", HTMLButtonElement).addEventListener("click", () => {
            const programs = texts();
            if (Object.keys(programs).length === 0) {
                onEmpty();
                return;
            }
            const each = Object.entries(programs).map(([motor, text]): [number, string] => [Number(motor), text]);
            commands.sendPrograms(each, "send_all", ALL_MOTORS, { texts: programs, together: together.checked });
        });
    }
}

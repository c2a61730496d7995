import { dangerEn } from "./danger_words";

/** The words of commissioning in English. */
export const commissionEn = {
    "commission.title": "Commissioning",
    "commission.about": "run a motor by hand, ramps, positions, switches",
    ...dangerEn("STOP"),
    "commission.motor": "Motor",
    "commission.acts": "Run the motor by hand",
    "commission.hold": "Runs as long as it is held: by mouse, finger, Space, or the arrow keys",
    "commission.back": "◀ hold: backward",
    "commission.forth": "hold: forward ▶",
    "commission.position": "Position of the motor",
    "commission.unknown": "–",
    "commission.farthest": "At most, steps",
    "commission.step": "Step by",
    "commission.stepBack": "− step",
    "commission.stepForth": "+ step",
    "commission.stepLabel": "One move of so many steps",
    "commission.zero": "0 is here",
    "commission.zeroLabel": "Sends C100: the position counter becomes 0; nothing moves",
    "commission.letGo":
        "Letting go stops the motor down its ramp; so does leaving the button or this window, and a unit that falls "
        + "silent. If the service hears nothing of this page for 0.7 s, it stops all motors. Without a service, where "
        + "this page has the serial port itself, closing the page stops all motors, too, but nobody sees whether they do; "
        + "nobody can stop them when the browser or the computer ends the page, or the cable is pulled.",
    "commission.reach": "Then the motor runs on to the end of this run, at most {steps} steps.",
    "commission.noReach": "Then the motor runs on WITHOUT END: use the emergency stop. (At most 0 means: no limit.)",
    "commission.forgets":
        "The motor's program in the unit, with its guards and total stops, is forgotten, but not the one in flash.",
    "commission.notKnown": "Not possible: what the motor does now is not known.",
    "commission.original": "Not possible: this unit does not tell what its motors do (Get Status).",
    "commission.stopOpen": "Not possible: a STOP is not confirmed.",
    "commission.runs": "Not possible while the motor runs its program: STOP it first.",
    "commission.left":
        "What is left of the last run may still be in motor {motor}: Resume would go on with it. Press Reset first.",
    "commission.teach": "Teach: this position into the program",
    "commission.teachLabel": "Inserts the command that goes to the present position, at the cursor of the program",
    "commission.taught": "{command} is in the program",
    "commission.negative":
        "No command goes to a position below 0: set position 0 at the lowest place (0 is here), then teach again.",
    "commission.backward": "backward",
    "commission.forward": "forward",
    "ramp.start": "Start/stop speed S",
    "ramp.speed": "Speed V, steps/s",
    "ramp.ramp": "Ramp A, steps/s²",
    "ramp.trial": "for a move of",
    "ramp.insert": "S V A into the program",
    "ramp.reached":
        "Starts at once at S, {start} steps/s, and reaches {speed} steps/s after {seconds} s and {steps} steps; braking "
        + "takes as much: so far it goes on after a stop.",
    "ramp.lower": "{trial} steps are too few for V: the highest speed is {speed} steps/s, after {seconds} s and {steps} steps.",
    "ramp.whole": "The move of {trial} steps takes {whole} s.",
    "ramp.long": "The move takes more than 60 s.",
    "ramp.unknown": "What the ramp means is not known: the simulator does not answer, or a number is missing.",
    "homing.run": "Search a switch",
    "homing.back": "backward, (",
    "homing.forth": "forward, )",
    "homing.input": "Input",
    "homing.speedField": "Speed S",
    "homing.away": "0 is away by",
    "homing.twice": "twice, the second time slowly",
    "homing.insert": "Search into the program",
    "homing.done": "It is in the program; nothing was sent",
    "homing.speed": "S is the speed of the search",
    "homing.search": "{side} until input {input} is 1, then at once a stop",
    "homing.leave": "leave the switch",
    "homing.again": "slowly once more",
    "homing.here": "this is the position of the switch",
    "homing.zero": "position 0",
};

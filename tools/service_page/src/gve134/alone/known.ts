/** 100 %. */
const FACTOR_ONE = 1 << 16;
const FACTOR_MIN = Math.round(FACTOR_ONE / 100);
const FACTOR_MAX = 10 * FACTOR_ONE;
const ALL_OFF = 0xff;
const SPINDLE_BIT = 1;
const PORT = /^O0,([0-9A-F]{1,2})$/;
const SPINDLE = /^!7V(\d+)$/;
const PERCENT = /^XM(\d+)$/;

/**
 * What is known of the unit because it was sent to it, as it does not tell these: port 0, spindle in 0.1 %, factor of
 * speed in 1/65 536; null: not known.
 */
export interface Known {
    readonly port: number | null;
    readonly spindle: number | null;
    readonly factor: number | null;
}

export const NOTHING_KNOWN: Known = { port: null, spindle: null, factor: null };
export const AFTER_RESET: Known = { port: ALL_OFF, spindle: 0, factor: FACTOR_ONE };

/** What is known after a command that was executed. */
export function knownAfter(known: Known, command: string): Known {
    const [port, spindle, percent] = [PORT.exec(command), SPINDLE.exec(command), PERCENT.exec(command)];
    if (port) {
        return { ...known, port: parseInt(port[1] ?? "", 16) };
    }
    if (spindle) {
        const permille = Number(spindle[1]);
        const off = permille > 0 ? 0 : SPINDLE_BIT;
        return { ...known, port: known.port === null ? null : (known.port & ~SPINDLE_BIT) | off, spindle: permille };
    }
    if (percent) {
        return { ...known, factor: factorOf(Number(percent[1])) };
    }
    if (command === "XA") {
        return { ...known, factor: FACTOR_ONE };
    }
    if ((command === "XU" || command === "XD") && known.factor !== null) {
        return { ...known, factor: stepped(known.factor, command) };
    }
    return command === "J" || command === "!7J" ? AFTER_RESET : known;
}

/** What is known after a command of which nobody knows whether it was executed. */
export function knownWithout(known: Known, command: string): Known {
    const changed = knownAfter(known, command);
    const kept = (name: keyof Known): number | null => (changed[name] === known[name] ? known[name] : null);
    return { port: kept("port"), spindle: kept("spindle"), factor: kept("factor") };
}

export const percentOf = ({ factor }: Known): number | null => (factor === null ? null : (100 * factor) / FACTOR_ONE);

/** What is to be said beside a confirmed stop; empty: it is off, or nobody knows. */
export const spindleText = ({ port, spindle }: Known): string =>
    spindle !== null && spindle > 0 && ((port ?? 0) & SPINDLE_BIT) === 0 ? `; THE SPINDLE TURNS at ${spindle / 10} %` : "";

/** XU or XD, if it leads nearer to a wanted factor. */
export function stepTowards(factor: number, wanted_percent: number): "XU" | "XD" | null {
    const wanted = factorOf(wanted_percent);
    const command = wanted > factor ? "XU" : "XD";
    return Math.abs(stepped(factor, command) - wanted) < Math.abs(factor - wanted) ? command : null;
}

/** The factor after XU or XD, to the nearest, halves up. */
const stepped = (factor: number, command: "XU" | "XD"): number =>
    within(Math.floor((factor * (command === "XU" ? 17 : 15) + 8) / 16));
const factorOf = (percent: number): number => within(Math.floor((percent / 100) * FACTOR_ONE + 0.5));
const within = (factor: number): number => Math.min(Math.max(factor, FACTOR_MIN), FACTOR_MAX);

/** firmware/positioning/registers/registers.def; register_table.mjs makes it when the page is built. */
declare module "pos-registers" {
    export interface RegisterRow {
        /** U: of the unit; A: of each axis. */
        scope: "U" | "A";
        name: string;
        number: number;
        type: "U16" | "I16" | "U32" | "I32";
        use: "READ" | "SETTING" | "PARAMETER" | "INSTRUCTION" | "MOTION" | "STORE";
        form: string;
        least: number;
        most: number;
        start: number;
        unit: string;
        text: string;
    }

    export const rows: RegisterRow[];
    /** Registers of the axes side by side: the first one, and how many each axis has. */
    export const images: Record<"FAST_OUT" | "FAST_IN" | "FULL_OUT" | "FULL_IN", { first: number; words: number }>;
    export const instructions: Record<"POS_INIT" | "POS_MODE" | "POS_RESET" | "POS_MODE_ABS" | "POS_HOME" | "POS_CAPTURE", number>;
    /** Of STATUS and FLAGS, as masks. */
    export const bits: Record<"JEDE" | "SMER" | "POL" | "DISP" | "PROG" | "ERR" | "REFERENCED" | "ARMED" | "HOMING", number>;
}

/** The project's own documents and its table of commands; help_pages.mjs makes it when the page is built. */
declare module "help-pages" {
    export interface HelpText {
        title: string;
        /** Each begins with its heading. */
        sections: string[];
    }

    export interface HelpPage {
        id: string;
        /** With the same headings, and so the same anchors, in each language. */
        texts: { en: HelpText; cs?: HelpText };
    }

    /** A row of firmware/rkm04/program/program_opcodes.def. */
    export interface CommandRow {
        name: string;
        letter: string;
        form: "NONE" | "NUMBER" | "IO" | "SIGNED" | "PLUS" | "MINUS" | "HIGH" | "LOW";
        min: number;
        max: number;
    }

    /** A folder of hal/stm32/boards. */
    export interface BoardPage {
        name: string;
        title: string;
        /** What a loader of the board has of the flash, before the image. */
        loader_bytes: number;
        /** Whether its crystal is too slow for the chip's own loader by USB. */
        slow_crystal: boolean;
        /** What its page says of flashing. */
        flashing: { en: string; cs?: string };
    }

    export const boards: BoardPage[];
    export const pages: HelpPage[];
    export const commands: CommandRow[];
}

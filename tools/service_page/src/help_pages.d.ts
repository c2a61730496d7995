/** The project's own documents and its table of commands; help_pages.mjs makes it when the page is built. */
declare module "help-pages" {
    export interface HelpPage {
        id: string;
        title: string;
        /** Each begins with its heading. */
        sections: string[];
    }

    /** A row of firmware/rkm04/program/program_opcodes.def. */
    export interface CommandRow {
        name: string;
        letter: string;
        form: "NONE" | "NUMBER" | "IO" | "SIGNED" | "PLUS" | "MINUS" | "HIGH" | "LOW";
        min: number;
        max: number;
    }

    export const pages: HelpPage[];
    export const commands: CommandRow[];
}

import { told } from "./common/told";
import { boards, type BoardPage } from "help-pages";
import { DfuTrouble, FLASH_ADDRESS, LOADER, Loader, type UsbDevice } from "./dfu";
import { byId, make } from "./dom";
import { language, t } from "./i18n";
import { FILE_BYTES_MAX, imageFileOf, type ImageFile } from "./image_file";
import type { Bytes } from "./program_host";

interface Usb {
    requestDevice(options: { filters: object[] }): Promise<UsbDevice>;
}

/** WebUSB, where the browser has it. */
const usb = (navigator as Navigator & { usb?: Usb }).usb;

/** Of this page: the unit, and what a new board is tried with. */
const UNITS = ["rkm04", "bringup"];

const hex = (address: number): string => `0x${address.toString(16).padStart(8, "0")}`;

/** How the firmware gets into a board: the commands, and by the browser where it reaches USB. */
export class FirmwarePanel {
    readonly #board = byId("firmware-board", HTMLSelectElement);
    readonly #file = byId("firmware-file", HTMLInputElement);
    readonly #write = byId("firmware-write", HTMLButtonElement);
    readonly #confirm = byId("firmware-confirm", HTMLInputElement);
    readonly #progress = byId("firmware-progress", HTMLProgressElement);
    readonly #said = byId("firmware-said", HTMLElement);
    #isWriting = false;

    constructor() {
        this.#board.append(...boards.map(({ name, title }) => make("option", { value: name }, title)));
        const preferred = boards.find(({ name }) => name === "weact-f405");
        this.#board.value = (preferred ?? boards[0])?.name ?? "";
        this.#board.addEventListener("change", () => this.#see());
        this.#confirm.addEventListener("change", () => this.#show());
        this.#file.addEventListener("change", () => this.#see());
        byId("firmware-form", HTMLFormElement).addEventListener("submit", (event) => {
            event.preventDefault();
            void this.#begin();
        });
        window.addEventListener("beforeunload", (event) => this.#isWriting && event.preventDefault());
        language.watch(() => this.#show());
    }

    get #chosen(): BoardPage | undefined {
        return boards.find(({ name }) => name === this.#board.value);
    }

    #show(): void {
        const board = this.#chosen;
        if (board === undefined) {
            return;
        }
        const address = hex(FLASH_ADDRESS + board.loader_bytes);
        const image = `rkm04-${board.name}.bin`;
        const byUsb = [
            `tools/rkm04 board flash --board ${board.name} --tool dfu-util`,
            `dfu-util -a 0 -d 0483:df11 -s ${address}:leave -D ${image}`,
        ];
        const lines = [
            `tools/rkm04 board flash --board ${board.name}`,
            ...(board.slow_crystal ? [] : byUsb),
            `st-flash --reset write ${image} ${address}`,
        ];
        byId("firmware-commands", HTMLElement).textContent = lines.join("\n");
        const page = byId("firmware-page", HTMLElement);
        const text = board.flashing[language.value];
        page.innerHTML = text ?? board.flashing.en;
        page.lang = text === undefined ? "en" : language.value;
        byId("firmware-usb", HTMLElement).hidden = usb === undefined;
        byId("firmware-no-usb", HTMLElement).hidden = usb !== undefined;
        this.#board.disabled = this.#isWriting;
        this.#file.disabled = this.#isWriting;
        this.#write.disabled = this.#isWriting || !this.#confirm.checked || this.#file.files?.length !== 1;
    }

    #say(words: string, isBad = false): void {
        this.#said.textContent = words;
        this.#said.classList.toggle("trouble", isBad && words !== "");
    }

    /** Another board or file: what it is is told before anything is written. */
    #see(): void {
        this.#say("");
        this.#show();
        void this.#imageOf();
    }

    /** The image that was chosen, if it is one for the board; says what it is, or why not. */
    async #imageOf(): Promise<ImageFile | undefined> {
        const board = this.#chosen;
        const file = this.#file.files?.[0];
        if (board === undefined || file === undefined) {
            return undefined;
        }
        const bytes = file.size > FILE_BYTES_MAX ? new Uint8Array() : await bytesOf(file);
        const found = bytes && imageFileOf(bytes);
        if (found === undefined) {
            this.#say(t(`firmware.${bytes === undefined ? "unread" : "noImage"}`, { name: file.name }), true);
            return undefined;
        }
        if (board !== this.#chosen || file !== this.#file.files?.[0]) {
            return undefined;
        }
        const { unit } = found;
        const isOfBoard = found.board === board.name;
        const kind = !isOfBoard ? "otherBoard" : UNITS.includes(unit) ? "image" : "otherUnit";
        const image = `${unit}-${found.board}`;
        this.#say(t(`firmware.${kind}`, { name: file.name, image, board: board.title }), kind !== "image");
        return isOfBoard ? found : undefined;
    }

    async #begin(): Promise<void> {
        if (this.#isWriting || !this.#confirm.checked) {
            return;
        }
        this.#isWriting = true;
        this.#show();
        await this.#choose();
        this.#isWriting = false;
        this.#progress.hidden = true;
        this.#progress.value = 0;
        this.#show();
    }

    /** The file is looked at first, then the browser asks for the device. */
    async #choose(): Promise<void> {
        const address = FLASH_ADDRESS + (this.#chosen?.loader_bytes ?? 0);
        const found = await this.#imageOf();
        if (found === undefined) {
            return;
        }
        const device = await usb?.requestDevice({ filters: [LOADER] }).catch(() => undefined);
        if (device === undefined) {
            this.#say(t("firmware.notChosen"), true);
            return;
        }
        await this.#put(new Loader(device), address, found);
    }

    async #put(loader: Loader, address: number, { unit, board, image }: ImageFile): Promise<void> {
        this.#progress.hidden = false;
        try {
            await loader.open();
            await loader.write(address, image, (done) => {
                this.#progress.value = done;
            });
            this.#say(t("firmware.done", { image: `${unit}-${board}` }));
        } catch (error) {
            const { stage } = loader;
            const kind = error instanceof DfuTrouble ? error.kind : stage === "closed" ? "closed" : "lost";
            const words = t(`firmware.${kind}`, { words: told(error instanceof Error ? error.message : String(error)) });
            this.#say(`${words} ${t(`firmware.${stage === "closed" ? "nothing" : stage}`)}`, true);
        }
        await loader.close().catch(() => undefined);
    }
}

/** What is in a file; a browser does not read one that was changed since it was chosen. */
const bytesOf = (file: File): Promise<Bytes | undefined> =>
    file.arrayBuffer().then((buffer) => new Uint8Array(buffer), () => undefined);

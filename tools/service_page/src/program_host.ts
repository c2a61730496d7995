import { File, OpenFile, PreopenDirectory, WASI } from "@bjorn3/browser_wasi_shim";

/** The content of a file. */
export type Bytes = Uint8Array<ArrayBuffer>;

/** A program in WebAssembly, rkm04-host or another: each run begins anew, with files of its own, as a command line would. */
export class ProgramHost {
    readonly #module: WebAssembly.Module;
    readonly #name: string;

    constructor(bytes: Bytes, name = "rkm04-host") {
        this.#module = new WebAssembly.Module(bytes);
        this.#name = name;
    }

    /** Runs it with files by name; what it has written stands among them. Fails with the line that it complains with. */
    run(words: string[], files: Map<string, Bytes>, input: Bytes = new Uint8Array()): string {
        const folder = new PreopenDirectory("/", new Map([...files].map(([name, data]) => [name, new File(data)])));
        const [stdin, stdout, stderr] = [new File(input), new File([]), new File([])];
        const streams = [stdin, stdout, stderr].map((file) => new OpenFile(file));
        const wasi = new WASI([this.#name, ...words], [], [...streams, folder], { debug: false });
        const instance = new WebAssembly.Instance(this.#module, { wasi_snapshot_preview1: wasi.wasiImport });
        const status = wasi.start(instance as Parameters<WASI["start"]>[0]);
        if (status !== 0) {
            const complaint = decode(stderr.data).trim();
            throw new Error(complaint.replace(`${this.#name}: `, "") || `${this.#name}: ${status}`);
        }
        for (const [name, file] of folder.dir.contents) {
            files.set(name, (file as File).data as Bytes);
        }
        return decode(stdout.data);
    }
}

function decode(data: Uint8Array): string {
    return new TextDecoder().decode(data);
}

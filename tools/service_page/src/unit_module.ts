import { File, OpenFile, WASI } from "@bjorn3/browser_wasi_shim";
import type { Bytes } from "./program_host";

export const ns = (ms: number): bigint => BigInt(Math.round(ms * 1e6));

/** Begins the module of a unit anew, with a memory of its own; returns what it exports. */
export function instantiated<Exports>(bytes: Bytes): Exports {
    const streams = [0, 1, 2].map(() => new OpenFile(new File([])));
    const wasi = new WASI(["unit"], [], streams, { debug: false });
    const module = new WebAssembly.Module(bytes);
    const instance = new WebAssembly.Instance(module, { wasi_snapshot_preview1: wasi.wasiImport });
    wasi.initialize(instance as Parameters<WASI["initialize"]>[0]);
    return instance.exports as unknown as Exports;
}

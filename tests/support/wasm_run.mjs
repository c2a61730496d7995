// Runs programs for WebAssembly one after the other, each from its beginning, as a command line would.
//
//   node --no-warnings wasm_run.mjs < JOBS       JOBS: [{"wasm", "arguments", "stdin", "stdout", "folder"}, ...]
//
// stdin and stdout are files, and folder is the one whose files the program may open. Prints the list of exit statuses.
import { openSync, closeSync, readFileSync } from "node:fs";
import { WASI } from "node:wasi";

const modules = new Map();

async function run({ wasm, arguments: words, stdin, stdout, folder }) {
    modules.set(wasm, modules.get(wasm) ?? (await WebAssembly.compile(readFileSync(wasm))));
    const files = [openSync(stdin ?? "/dev/null", "r"), openSync(stdout, "w")];
    const wasi = new WASI({
        version: "preview1",
        args: ["rkm04-host", ...words],
        preopens: { "/": folder },
        stdin: files[0],
        stdout: files[1],
        returnOnExit: true,
    });
    try {
        return wasi.start(await WebAssembly.instantiate(modules.get(wasm), wasi.getImportObject()));
    } finally {
        files.forEach((file) => closeSync(file));
    }
}

const statuses = [];
for (const job of JSON.parse(readFileSync(0, "utf8"))) {
    statuses.push(await run(job));
}
console.log(JSON.stringify(statuses));

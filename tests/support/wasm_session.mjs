// A session with the unit for WebAssembly, by the lines that session_probe.c takes.
//
//   node --no-warnings wasm_session.mjs rkm04-unit.wasm < LINES
import { readFileSync } from "node:fs";
import { WASI } from "node:wasi";

const wasi = new WASI({ version: "preview1" });
const module = await WebAssembly.compile(readFileSync(process.argv[2]));
const instance = await WebAssembly.instantiate(module, wasi.getImportObject());
wasi.initialize(instance);
const paced = instance.exports;
const unit = paced.paced_begin(0n);
const bytes = (place, length) => Buffer.from(paced.memory.buffer, place, length);

function ask(request) {
    bytes(paced.paced_request(unit), request.length).set(request);
    const length = paced.paced_message(unit, request.length);
    return bytes(paced.paced_answer(unit), length).toString("hex");
}

const told = [];
for (const line of readFileSync(0, "utf8").split("\n")) {
    const [order, ...values] = line.split(" ");
    if (order === "at") {
        while (paced.paced_follow(unit, BigInt(values[0])) !== 0);
    } else if (order === "in") {
        paced.paced_set_input(unit, Number(values[0]), Number(values[1]));
    } else if (order === "ask") {
        told.push(ask(Buffer.from(values[0], "hex")));
    }
}
told.push(`${paced.paced_now_ns(unit)} ${paced.paced_stood_ns(unit)}\n`);
process.stdout.write(told.join("\n"));

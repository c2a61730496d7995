// What functions of the page (a file of tools/service_page/src) return.
//
//   node page_parser.mjs ESBUILD SOURCE < QUESTIONS       QUESTIONS: {"names", "asked": [[function, arguments ...], ...]}
//
// Bytes among the arguments are {"hex"}. Prints the list of results; {"refused": kind} is one that was thrown.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";

const [esbuild, source] = process.argv.slice(2);
const { build } = createRequire(import.meta.url)(esbuild);
const nodePaths = [resolve(esbuild, "../../..")]; // the packages of the page, which stand apart from its sources
const made = await build({ entryPoints: [source], bundle: true, format: "esm", write: false, nodePaths });
const code = Buffer.from(made.outputFiles[0].contents).toString("base64");
const messages = await import(`data:text/javascript;base64,${code}`);

const { names, asked } = JSON.parse(readFileSync(0, "utf8"));
const valueOf = (one) => (one?.hex === undefined ? one : Uint8Array.from(Buffer.from(one.hex, "hex")));

function answer([name, ...given]) {
    try {
        return messages[name](...given.map(valueOf), names);
    } catch (error) {
        if (error.trouble === undefined) {
            throw error;
        }
        return { refused: error.trouble.kind };
    }
}

console.log(JSON.stringify(asked.map(answer)));

// Bundles the page into the directory $RKM04_SERVICE_OUT: index.html, page.js, page.css, engine.js (the
// worker of a page without a service) and icon.svg, nothing else.
import { build } from "esbuild";
import { copyFile, mkdir } from "node:fs/promises";
import { join } from "node:path";

const out = process.env.RKM04_SERVICE_OUT ?? "../../build/service";

await mkdir(out, { recursive: true });
await build({
    entryPoints: [
        { in: "src/main.ts", out: "page" },
        { in: "style.css", out: "page" },
    ],
    outdir: out,
    bundle: true,
    minify: true,
    format: "esm",
    target: ["chrome109", "firefox115", "safari16"],
    legalComments: "eof",
    logLevel: "warning",
});
await build({
    entryPoints: [{ in: "src/engine_worker.ts", out: "engine" }],
    outdir: out,
    bundle: true,
    minify: true,
    format: "iife",
    target: ["chrome109", "firefox115", "safari16"],
    legalComments: "eof",
    logLevel: "warning",
});
for (const name of ["index.html", "icon.svg"]) {
    await copyFile(name, join(out, name));
}

import type { Bytes } from "./program_host";

/** A program as it was before the page was written (gzip). */
export async function unpacked(bytes: Bytes): Promise<Bytes> {
    const whole = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Uint8Array(await new Response(whole).arrayBuffer());
}

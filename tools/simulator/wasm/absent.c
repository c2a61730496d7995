/* What there is not in WebAssembly: sockets, and so `serve`; and processes, and so a parent. */
#include "parent.h"
#include "serve.h"

const char serve_usage[] = "serve is not there in WebAssembly, which has no sockets\n";

void parent_bind(void)
{
}

enum exit_status serve_options_read(struct serve_options *options, int count, char *const arguments[])
{
    (void)options;
    (void)count;
    (void)arguments;
    complain("WebAssembly has no sockets, so there is no serve; use the program rkm04-host of the PC");
    return EXIT_USAGE;
}

enum exit_status serve_run(const struct serve_options *options)
{
    (void)options;
    return EXIT_USAGE;
}

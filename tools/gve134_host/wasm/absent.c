/* What there is not in WebAssembly: sockets, and so `serve`. */
#include "gve_serve.h"

const char gve_serve_usage[] = "serve is not there in WebAssembly, which has no sockets\n";

enum exit_status gve_serve(int count, char *const arguments[])
{
    (void)count;
    (void)arguments;
    complain("WebAssembly has no sockets, so there is no serve; use the program gve134-host of the PC");
    return EXIT_USAGE;
}

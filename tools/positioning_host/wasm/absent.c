/* What there is not in WebAssembly: sockets, and so `serve`. */
#include "pos_serve.h"

const char pos_serve_usage[] = "serve is not there in WebAssembly, which has no sockets\n";

enum exit_status pos_serve(int count, char *const arguments[])
{
    (void)count;
    (void)arguments;
    complain("WebAssembly has no sockets, so there is no serve; use the program positioning-host of the PC");
    return EXIT_USAGE;
}

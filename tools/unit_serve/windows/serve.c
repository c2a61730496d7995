/* The line, the flash file and the signals of `serve` are those of POSIX: Windows has none of them. */
#include "serve.h"

enum exit_status serve_run(const struct serve_kind *kind, const struct serve_options *options)
{
    (void)options;
    complain("%s serve is not there on Windows; use it in WSL, or the page of rkm04 service --static", kind->tool);
    return EXIT_USAGE;
}

#include "complain.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void complain(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)fputs("rkm04-vboard: ", stderr);
    (void)vfprintf(stderr, format, arguments);
    (void)fputc('\n', stderr);
    va_end(arguments);
}

enum exit_status finish_output(void)
{
    if (fflush(stdout) != 0 || ferror(stdout) != 0) {
        complain("standard output cannot be written (%s); make room or send it elsewhere", strerror(errno));
        return EXIT_REFUSED;
    }
    return EXIT_DONE;
}

#include "complain.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const char *program_name = "rkm04";

void complain_as(const char *path)
{
    for (program_name = path; *path != '\0'; path++) {
        program_name = *path == '/' || *path == '\\' ? path + 1 : program_name;
    }
}

void complain(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)fprintf(stderr, "%s: ", program_name);
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

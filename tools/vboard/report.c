#include "report.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "complain.h"

void report_finish(struct report *report, enum report_end end, const char *text)
{
    if (report->end == REPORT_RUNS) {
        report->end = end;
        (void)snprintf(report->text, sizeof report->text, "%s", text);
    }
    clock_poke(report->clock);
}

static void put_place(const struct report *report, char *text, size_t bytes)
{
    uint64_t ns = clock_now_ps(report->clock) / VTIME_PS_PER_NS;
    uint32_t at = *report->at;
    (void)snprintf(text, bytes, " (pc %08x in %s, at %u.%06u ms)", (unsigned)at, image_function_at(report->image, at),
                   (unsigned)(ns / 1000000U), (unsigned)(ns % 1000000U));
}

static void put_message(const struct report *report, char text[REPORT_TEXT_BYTES_MAX], const char *format,
                        va_list arguments) __attribute__((format(printf, 3, 0)));

static void put_message(const struct report *report, char text[REPORT_TEXT_BYTES_MAX], const char *format,
                        va_list arguments)
{
    (void)vsnprintf(text, REPORT_TEXT_BYTES_MAX, format, arguments);
    size_t length = strlen(text);
    put_place(report, text + length, REPORT_TEXT_BYTES_MAX - length);
}

void report_fail(struct report *report, const char *format, ...)
{
    char text[REPORT_TEXT_BYTES_MAX];
    va_list arguments;
    if (report->end != REPORT_RUNS) {
        return;
    }
    va_start(arguments, format);
    put_message(report, text, format, arguments);
    va_end(arguments);
    complain("%s", text);
    report_finish(report, REPORT_FAILED, text);
}

void report_warn(struct report *report, const char *format, ...)
{
    char text[REPORT_TEXT_BYTES_MAX];
    va_list arguments;
    if (report->warnings++ >= REPORT_WARNINGS_SHOWN) {
        return;
    }
    va_start(arguments, format);
    put_message(report, text, format, arguments);
    va_end(arguments);
    complain("warning: %s", text);
}

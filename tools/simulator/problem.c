#include "problem.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MESSAGE_BYTES_MAX = 400,
    ROOM_MIN = 32,
};

/* Makes room for one more. */
static bool grow(struct problems *problems)
{
    if (problems->count < problems->room) {
        return true;
    }
    uint32_t room = 2U * problems->room + ROOM_MIN;
    struct problem *list = realloc(problems->list, room * sizeof *list);
    if (list == NULL) {
        return false;
    }
    problems->list = list;
    problems->room = room;
    return true;
}

static char *copy_of(const char *text)
{
    size_t size = strlen(text) + 1U;
    char *copy = malloc(size);
    return copy == NULL ? NULL : memcpy(copy, text, size);
}

void problems_add(struct problems *problems, uint32_t offset, unsigned flag, const char *rule, const char *format, ...)
{
    char text[MESSAGE_BYTES_MAX];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    char *message = copy_of(text);
    if (message == NULL || !grow(problems)) {
        free(message);
        problems->is_short = true;
        return;
    }
    problems->list[problems->count] =
        (struct problem){.offset = offset, .order = problems->count, .flag = flag, .rule = rule, .message = message};
    problems->count++;
}

static int compare(const void *a, const void *b)
{
    const struct problem *one = a;
    const struct problem *other = b;
    if (one->offset != other->offset) {
        return one->offset < other->offset ? -1 : 1;
    }
    return one->order < other->order ? -1 : 1;
}

void problems_sort(struct problems *problems)
{
    if (problems->count > 0) {
        qsort(problems->list, problems->count, sizeof *problems->list, compare);
    }
}

void problems_discard(struct problems *problems)
{
    for (uint32_t i = 0; i < problems->count; i++) {
        free(problems->list[i].message);
    }
    free(problems->list);
    *problems = (struct problems){.count = 0};
}

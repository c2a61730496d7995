#include "gve_told.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "json.h"
#include "units.h"

enum {
    FIRST_ROOM = 16,
    MS_DECIMALS = 6,
};

struct gve_told gve_told_none(void)
{
    return (struct gve_told){.list = NULL};
}

/* There is room for powers of two of them. */
static bool has_room(struct gve_told *told)
{
    if (told->count >= GVE_TOLD_MAX) {
        return false;
    }
    if (told->count != 0 && (told->count < FIRST_ROOM || (told->count & (told->count - 1U)) != 0)) {
        return true;
    }
    size_t room = told->count == 0 ? FIRST_ROOM : (size_t)told->count * 2U;
    struct gve_told_answer *list = realloc(told->list, room * sizeof *list);
    told->list = list == NULL ? told->list : list;
    return list != NULL;
}

void gve_told_add(struct gve_told *told, const struct gve_told_answer *answer)
{
    told->wrong += answer->wrong ? 1U : 0U;
    if (has_room(told)) {
        told->list[told->count++] = *answer;
    } else {
        told->more++;
    }
}

static void print_answer(const struct gve_told_answer *answer)
{
    const struct gve_file_line *line = &answer->line;
    (void)printf("{\"line\":%" PRIu32 ",\"address\":%d,\"command\":", line->number,
                 line->address == GVE_ADDRESS_SPINDLE ? 7 : 0);
    json_print_text((const char *)line->text, line->length);
    (void)printf(",\"ms\":");
    json_print_fixed(units_ns_of_ticks(answer->text.tick), MS_DECIMALS);
    (void)printf(",\"answer\":");
    json_print_text(answer->text.bytes, answer->text.length);
    (void)printf(",\"refused\":%s,\"reason\":", answer->wrong ? "true" : "false");
    if (answer->reason != NULL) {
        json_print_string(answer->reason);
    } else {
        (void)fputs("null", stdout);
    }
    (void)putchar('}');
}

void gve_told_print(const struct gve_told *told)
{
    (void)printf("\"answers\":[");
    for (uint32_t i = 0; i < told->count; i++) {
        (void)fputs(i == 0 ? "\n" : ",\n", stdout);
        print_answer(&told->list[i]);
    }
    (void)printf("],\n\"answers_more\":%" PRIu32 ",\"refused\":%" PRIu32, told->more, told->wrong);
}

void gve_told_discard(struct gve_told *told)
{
    free(told->list);
    *told = gve_told_none();
}

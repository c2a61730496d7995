#include "gve_master_private.h"

enum {
    LONG_ATTEMPTS = 20,
    USUAL_MS = 3000, /* so long a stop takes at the most, as a rule */
};

static const uint16_t repeat_ms[] = {300, 300, 500};

/* ---- what is answered when the axes stand ---- */

/* Until then the unit answers nothing. An @ tells a command that was lost from one that takes its time: it is answered
 * at once, or after the command's own answer. */
static void ask_beside(struct gve_master *master, uint64_t now_ns)
{
    const struct gve_reply_form form = {.values = GVE_VALUES_NUMBER_OR_NONE};
    uint64_t left_ns = master->end_ns > now_ns ? master->end_ns - now_ns : 0;
    master->stage = GVE_STAGE_LONG;
    master->asked++;
    gve_wire_put_beside(&master->wire, "@");
    gve_wire_listen(&master->wire, GVE_LISTENS_ANSWER, form, left_ns, now_ns);
}

void gve_master_wait_long(struct gve_master *master, uint64_t now_ns)
{
    master->end_ns = now_ns + master->order.wait_ms * GVE_WIRE_NS_PER_MS;
    master->asked = 0;
    ask_beside(master, now_ns);
}

static void wait_for_late(struct gve_master *master, uint64_t now_ns)
{
    master->stage = GVE_STAGE_LONG_LATE;
    gve_master_listen(master, GVE_LISTENS_ANSWER, GVE_VALUES_NUMBER, GVE_PATIENCE_MS, now_ns);
}

void gve_master_after_long(struct gve_master *master, uint64_t now_ns)
{
    const struct gve_wire *wire = &master->wire;
    const struct gve_heard *heard = &wire->heard;
    if (wire->found && wire->reply.length == 0) {
        master->reply = wire->reply;
        wait_for_late(master, now_ns);
    } else if (wire->found || heard->bare) {
        master->bare = false;
        gve_master_repair(master, now_ns);
    } else if (heard->damaged + heard->echoes > 0 && master->asked < LONG_ATTEMPTS - 1) {
        ask_beside(master, now_ns);
    } else {
        gve_master_finish(master, GVE_MASTER_NOT_CONFIRMED);
    }
}

void gve_master_after_long_late(struct gve_master *master, uint64_t now_ns)
{
    master->asked--;
    if (master->asked > 0) {
        wait_for_late(master, now_ns);
    } else if (master->reply.code == GVE_DAMAGED) {
        master->bare = false;
        gve_master_repair(master, now_ns);
    } else {
        const struct gve_reply reply = master->reply;
        master->index = (uint8_t)(master->index + master->counts);
        gve_master_finish_answered(master, &reply);
    }
}

/* ---- halting ---- */

static void send_halt(struct gve_master *master, uint64_t now_ns)
{
    uint32_t last = sizeof repeat_ms / sizeof repeat_ms[0] - 1;
    gve_master_send(master, GVE_STAGE_HALT, "H", master->wire.sums, now_ns);
    gve_master_listen(master, GVE_LISTENS_HALTED, GVE_VALUES_NONE,
                      repeat_ms[master->attempt < last ? master->attempt : last], now_ns);
}

void gve_master_halt(struct gve_master *master, uint64_t now_ns)
{
    master->ready = false;
    master->begin_ns = now_ns;
    master->wire.sums = true;
    send_halt(master, now_ns);
}

void gve_master_after_halt(struct gve_master *master, uint64_t now_ns)
{
    uint64_t passed_ns = now_ns - master->begin_ns;
    if (master->wire.found) {
        gve_master_connect(master, now_ns);
    } else if (passed_ns > master->order.wait_ms * GVE_WIRE_NS_PER_MS) {
        gve_master_finish(master, GVE_MASTER_NOT_CONFIRMED);
    } else {
        master->long_halt = passed_ns > USUAL_MS * GVE_WIRE_NS_PER_MS;
        master->attempt++;
        master->wire.sums = !master->wire.sums;
        send_halt(master, now_ns);
    }
}

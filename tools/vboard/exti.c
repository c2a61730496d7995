#include "exti.h"

#include "board.h"

enum {
    EXTI_IMR = 0x00,
    EXTI_EMR = 0x04,
    EXTI_RTSR = 0x08,
    EXTI_FTSR = 0x0C,
    EXTI_SWIER = 0x10,
    EXTI_PR = 0x14,
};

#define PIN_LINES UINT32_C(0xFFFF)

/* Interrupts of the lines (RM0090 table 61): the first five have their own. */
static const struct {
    enum nvic_irq irq;
    uint16_t lines;
} interrupts[] = {
    {NVIC_IRQ_EXTI0, 0x0001}, {NVIC_IRQ_EXTI1, 0x0002},   {NVIC_IRQ_EXTI2, 0x0004},     {NVIC_IRQ_EXTI3, 0x0008},
    {NVIC_IRQ_EXTI4, 0x0010}, {NVIC_IRQ_EXTI9_5, 0x03E0}, {NVIC_IRQ_EXTI15_10, 0xFC00},
};

static void update_interrupts(struct board *board)
{
    uint32_t requests = board->exti.pending & board->exti.imr;
    for (unsigned i = 0; i < sizeof interrupts / sizeof *interrupts; i++) {
        nvic_set_line(board, interrupts[i].irq, (requests & interrupts[i].lines) != 0);
    }
}

/* The mask stands behind the pending register, so that an edge on a masked line is kept (figure of section 12.2.5);
 * --exti-mask-first puts it in front of it, as section 12.3.5 may be read. */
static void pend(struct board *board, uint32_t lines)
{
    struct exti *exti = &board->exti;
    exti->pending |= board->options->exti_mask_first ? lines & exti->imr : lines;
    update_interrupts(board);
}

static void set_levels(struct board *board, uint16_t lines, uint16_t levels)
{
    struct exti *exti = &board->exti;
    uint32_t rising = lines & levels & (uint32_t)~exti->level & exti->rtsr;
    uint32_t falling = lines & (uint32_t)~levels & exti->level & exti->ftsr;
    exti->level = (uint16_t)((exti->level & ~lines) | (levels & lines));
    if ((rising | falling) != 0) {
        pend(board, rising | falling);
    }
}

void exti_follow(struct board *board, unsigned port)
{
    uint16_t lines = board->exti.routed[port];
    if (lines != 0) {
        set_levels(board, lines, board->port[port].level & (uint16_t)~board->port[port].analog);
    }
}

void exti_route(struct board *board, uint64_t ports)
{
    struct exti *exti = &board->exti;
    for (unsigned port = 0; port < GPIO_PORTS; port++) {
        exti->routed[port] = 0;
    }
    for (unsigned line = 0; line < GPIO_PINS; line++) {
        unsigned port = ports >> 4U * line & 15U;
        if (port >= GPIO_PORTS) {
            board_fail(board, "SYSCFG_EXTICR: port %u of line %u does not exist", port, line);
            return;
        }
        exti->routed[port] |= (uint16_t)(1U << line);
    }
    for (unsigned port = 0; port < GPIO_PORTS; port++) {
        exti_follow(board, port);
    }
}

void exti_reset(struct board *board)
{
    board->exti = (struct exti){.imr = 0};
    update_interrupts(board);
    exti_route(board, 0);
}

bool exti_read(struct board *board, unsigned instance, uint32_t offset, uint32_t *value)
{
    const struct exti *exti = &board->exti;
    (void)instance;
    switch (offset) {
    case EXTI_IMR:
        *value = exti->imr;
        return true;
    case EXTI_EMR:
        *value = 0;
        return true;
    case EXTI_RTSR:
        *value = exti->rtsr;
        return true;
    case EXTI_FTSR:
        *value = exti->ftsr;
        return true;
    case EXTI_SWIER:
        *value = exti->swier;
        return true;
    case EXTI_PR:
        *value = exti->pending;
        return true;
    default:
        return false;
    }
}

/* Section 12.3.5: a bit that goes from 0 to 1 makes a request where the line is not masked. */
static void write_swier(struct board *board, uint32_t value)
{
    struct exti *exti = &board->exti;
    uint32_t requests = value & ~exti->swier & exti->imr;
    exti->swier = value;
    pend(board, requests);
}

/* Section 12.3.6: ones clear, here and in SWIER. */
static void write_pr(struct board *board, uint32_t ones)
{
    board->exti.pending &= ~ones;
    board->exti.swier &= ~ones;
}

bool exti_write(struct board *board, unsigned instance, uint32_t offset, uint32_t value, uint32_t mask)
{
    struct exti *exti = &board->exti;
    (void)instance;
    if ((value & mask & ~PIN_LINES) != 0 && offset <= EXTI_PR) {
        board_fail(board, "EXTI: only lines 0 to 15, those of the pins, are modelled");
        return true;
    }
    value &= mask;
    switch (offset) {
    case EXTI_IMR:
        exti->imr = value;
        break;
    case EXTI_EMR:
        if (value != 0) {
            board_fail(board, "EXTI_EMR: events are not modelled");
        }
        break;
    case EXTI_RTSR:
        exti->rtsr = value;
        break;
    case EXTI_FTSR:
        exti->ftsr = value;
        break;
    case EXTI_SWIER:
        write_swier(board, value);
        break;
    case EXTI_PR:
        write_pr(board, value);
        break;
    default:
        return false;
    }
    update_interrupts(board);
    return true;
}

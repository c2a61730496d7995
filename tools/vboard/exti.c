#include "exti.h"

#include <string.h>

enum {
    EXTI_IMR = 0x00,
    EXTI_EMR = 0x04,
    EXTI_RTSR = 0x08,
    EXTI_FTSR = 0x0C,
    EXTI_SWIER = 0x10,
    EXTI_PR = 0x14,
};

#define DETECTOR_LINE UINT32_C(0x10000) /* section 12.2.5 */
#define LINES UINT32_C(0x1FFFF)

/* Interrupts of the lines (RM0090 table 61): the first five have their own. */
static const struct {
    enum nvic_irq irq;
    uint32_t lines;
} interrupts[] = {
    {NVIC_IRQ_PVD, DETECTOR_LINE}, {NVIC_IRQ_EXTI0, 0x0001}, {NVIC_IRQ_EXTI1, 0x0002},   {NVIC_IRQ_EXTI2, 0x0004},
    {NVIC_IRQ_EXTI3, 0x0008},      {NVIC_IRQ_EXTI4, 0x0010}, {NVIC_IRQ_EXTI9_5, 0x03E0}, {NVIC_IRQ_EXTI15_10, 0xFC00},
};

static void update_interrupts(struct exti *exti)
{
    uint32_t requests = exti->pending & exti->imr;
    for (unsigned i = 0; i < sizeof interrupts / sizeof *interrupts; i++) {
        nvic_set_line(exti->wires.nvic, interrupts[i].irq, (requests & interrupts[i].lines) != 0);
    }
}

/* The mask comes after the pending register, so that an edge on a masked line is kept (figure of section 12.2.5);
 * --exti-mask-first puts it in front of it, as section 12.3.5 may be read. */
static void pend(struct exti *exti, uint32_t lines)
{
    exti->pending |= exti->wires.mask_first ? lines & exti->imr : lines;
    update_interrupts(exti);
}

static void set_levels(struct exti *exti, uint16_t lines, uint16_t levels)
{
    uint32_t rising = lines & levels & (uint32_t)~exti->level & exti->rtsr;
    uint32_t falling = lines & (uint32_t)~levels & exti->level & exti->ftsr;
    exti->level = (uint16_t)((exti->level & ~lines) | (levels & lines));
    if ((rising | falling) != 0) {
        pend(exti, rising | falling);
    }
}

static void follow(struct exti *exti, unsigned port)
{
    uint16_t lines = exti->routed[port];
    if (lines != 0) {
        set_levels(exti, lines, exti->pins[port]);
    }
}

void exti_follow(struct exti *exti, unsigned port, uint16_t levels)
{
    exti->pins[port] = levels;
    follow(exti, port);
}

void exti_follow_detector(struct exti *exti, bool low)
{
    if (((low ? exti->rtsr : exti->ftsr) & DETECTOR_LINE) != 0) {
        pend(exti, DETECTOR_LINE);
    }
}

void exti_route(struct exti *exti, uint64_t ports)
{
    for (unsigned port = 0; port < EXTI_PORTS; port++) {
        exti->routed[port] = 0;
    }
    for (unsigned line = 0; line < EXTI_LINES; line++) {
        unsigned port = ports >> 4U * line & 15U;
        if (port >= EXTI_PORTS) {
            report_fail(exti->wires.report, "SYSCFG_EXTICR: port %u of line %u does not exist", port, line);
            return;
        }
        exti->routed[port] |= (uint16_t)(1U << line);
    }
    for (unsigned port = 0; port < EXTI_PORTS; port++) {
        follow(exti, port);
    }
}

void exti_init(struct exti *exti, struct exti_wires wires)
{
    exti->wires = wires;
}

void exti_reset(struct exti *exti)
{
    struct exti before = *exti;
    *exti = (struct exti){.wires = before.wires};
    memcpy(exti->pins, before.pins, sizeof exti->pins);
    update_interrupts(exti);
    exti_route(exti, 0);
}

bool exti_read(void *model, uint32_t offset, uint32_t *value)
{
    const struct exti *exti = model;
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
static void write_swier(struct exti *exti, uint32_t value)
{
    uint32_t requests = value & ~exti->swier & exti->imr;
    exti->swier = value;
    pend(exti, requests);
}

/* Section 12.3.6: ones clear, here and in SWIER. */
static void write_pr(struct exti *exti, uint32_t ones)
{
    exti->pending &= ~ones;
    exti->swier &= ~ones;
}

bool exti_write(void *model, uint32_t offset, uint32_t value, uint32_t mask)
{
    struct exti *exti = model;
    if ((value & mask & ~LINES) != 0 && offset <= EXTI_PR) {
        report_fail(exti->wires.report, "EXTI: only lines 0 to 15, those of the pins, and 16 are modelled");
        return true;
    }
    value &= mask;
    switch (offset) {
    case EXTI_IMR:
        exti->imr = value;
        break;
    case EXTI_EMR:
        if (value != 0) {
            report_fail(exti->wires.report, "EXTI_EMR: events are not modelled");
        }
        break;
    case EXTI_RTSR:
        exti->rtsr = value;
        break;
    case EXTI_FTSR:
        exti->ftsr = value;
        break;
    case EXTI_SWIER:
        write_swier(exti, value);
        break;
    case EXTI_PR:
        write_pr(exti, value);
        break;
    default:
        return false;
    }
    update_interrupts(exti);
    return true;
}

#include "supply.h"

#include <string.h>

#include "complain.h"
#include "line.h"

enum {
    PWR_CR = 0x00,
    PWR_CSR = 0x04,
    MV_DECIMALS = 3,
    MS_DECIMALS = 9,
    MV_MAX = 4000, /* DS8626, absolute maximum */
    OFF = 3,       /* level of the brown-out reset: none */
};

#define PWR_CR_RESET UINT32_C(0x4000) /* VOS: scale 1 */
#define PWR_CR_MASK UINT32_C(0x43FF)
#define PWR_CR_PVDE (UINT32_C(1) << 4)
#define PWR_CR_PLS (UINT32_C(7) << 5)
#define PWR_CSR_PVDO (UINT32_C(1) << 2)
#define PWR_CSR_VOSRDY (UINT32_C(1) << 14)
#define MS_MAX UINT64_C(1000000000)

/* The data sheet does not say how long the detector takes to begin; assumed, and longer than those of other parts. */
#define SETTLE_PS (100 * VTIME_PS_PER_US)

/* Millivolts at the low end, typical, at the high end of the range. */
struct threshold {
    uint16_t rising[3];
    uint16_t falling[3];
};

/* DS8626, VPVD by PLS[2:0]. */
static const struct threshold detector[] = {
    {{2090, 2140, 2190}, {1980, 2040, 2080}}, {{2230, 2300, 2370}, {2130, 2190, 2250}},
    {{2390, 2450, 2510}, {2290, 2350, 2390}}, {{2540, 2600, 2650}, {2440, 2510, 2560}},
    {{2700, 2760, 2820}, {2590, 2660, 2710}}, {{2860, 2930, 2990}, {2650, 2840, 3020}},
    {{2960, 3030, 3100}, {2850, 2930, 2990}}, {{3070, 3140, 3210}, {2950, 3030, 3090}},
};

/* DS8626, VBOR3 to VBOR1 by BOR_LEV (RM0090 3.9.8), and last what is always there, VPOR/PDR. */
static const struct threshold reset_levels[] = {
    {{2850, 2920, 2970}, {2750, 2830, 2880}},
    {{2530, 2590, 2630}, {2440, 2500, 2560}},
    {{2230, 2290, 2330}, {2130, 2190, 2240}},
    {{1640, 1720, 1800}, {1600, 1680, 1760}},
};

static const uint16_t release_us[] = {500, 1500, 3000}; /* DS8626, TRSTTEMPO */

static uint32_t voltage_at(const struct supply *supply, uint64_t ps)
{
    unsigned i = supply->points;
    while (i > 1 && supply->point[i - 1U].ps > ps) {
        i--;
    }
    if (i == supply->points) {
        return supply->point[i - 1U].mv;
    }
    uint64_t begin = supply->point[i - 1U].ps;
    uint64_t span = supply->point[i].ps - begin;
    uint32_t from = supply->point[i - 1U].mv;
    uint32_t to = supply->point[i].mv;
    uint32_t way = (uint32_t)vtime_scale(to > from ? to - from : from - to, ps - begin, span);
    return to > from ? from + way : from - way;
}

/* When the voltage is another one, by a millivolt; NEVER: it stays. */
static uint64_t next_change(const struct supply *supply, uint64_t ps)
{
    for (unsigned i = 0; i + 1U < supply->points; i++) {
        uint64_t begin = supply->point[i].ps;
        uint64_t end = supply->point[i + 1U].ps;
        uint32_t from = supply->point[i].mv;
        uint32_t to = supply->point[i + 1U].mv;
        uint64_t way = to > from ? to - from : from - to;
        if (ps >= end) {
            continue;
        }
        if (ps < begin || way == 0) {
            return ps < begin ? begin : end;
        }
        uint64_t next = begin + vtime_scale(end - begin, vtime_scale(way, ps - begin, end - begin) + 1U, way) + 1U;
        return next < end ? next : end;
    }
    return VTIME_NEVER;
}

static bool detector_is_on(const struct supply *supply)
{
    return (supply->pwr_cr & PWR_CR_PVDE) != 0;
}

static void watch_voltage(struct supply *supply)
{
    const struct threshold *level = &detector[(supply->pwr_cr & PWR_CR_PLS) >> 5];
    supply->low = supply->wires.conditions->supply_mv < (supply->low ? level->rising : level->falling)[supply->corner];
}

/* The reset begins; the RAM forgets only below the level that is always there. */
static void hold(struct supply *supply)
{
    supply->held = true;
    supply->release_ps = VTIME_NEVER;
    flash_cut(supply->wires.flash);
    reset_request(supply->wires.reset, RESET_HELD);
}

static void release(struct supply *supply)
{
    bool forgotten = supply->forgotten;
    supply->held = false;
    supply->forgotten = false;
    supply->brown_outs += forgotten ? 0U : 1U;
    reset_request(supply->wires.reset, forgotten ? RESET_POWER : RESET_BROWN_OUT);
}

static void watch_reset(struct supply *supply, uint64_t ps)
{
    const struct threshold *level = &reset_levels[flash_brown_out_level(supply->wires.flash)];
    supply->forgotten |= supply->wires.conditions->supply_mv < reset_levels[OFF].falling[supply->corner];
    if (!supply->held) {
        if (supply->wires.conditions->supply_mv < level->falling[supply->corner]) {
            hold(supply);
        }
    } else if (supply->wires.conditions->supply_mv < level->rising[supply->corner]) {
        supply->release_ps = VTIME_NEVER;
    } else if (supply->release_ps == VTIME_NEVER) {
        supply->release_ps = ps + release_us[supply->corner] * VTIME_PS_PER_US;
    } else if (ps >= supply->release_ps) {
        release(supply);
    }
}

static void on_supply_event(void *model, uint64_t cycle)
{
    struct supply *supply = model;
    uint64_t ps = clock_ps_of_cycle(supply->wires.clock, cycle);
    supply->wires.conditions->supply_mv = voltage_at(supply, ps);
    supply->least_mv =
        supply->wires.conditions->supply_mv < supply->least_mv ? supply->wires.conditions->supply_mv : supply->least_mv;
    bool was_low = supply->low;
    watch_voltage(supply);
    if (supply->low != was_low && detector_is_on(supply)) {
        exti_follow_detector(supply->wires.exti, supply->low);
    }
    watch_reset(supply, ps);
    uint64_t next = next_change(supply, ps);
    if (supply->held) {
        next = supply->release_ps < next ? supply->release_ps : next;
    } else {
        flash_watch_supply(supply->wires.flash);
        conditions_check(supply->wires.conditions);
    }
    if (next != VTIME_NEVER) {
        clock_set_ps(supply->wires.clock, EVENT_SUPPLY, next);
    }
}

void supply_reset(struct supply *supply)
{
    supply->pwr_cr = PWR_CR_RESET;
    supply->settled_ps = VTIME_NEVER;
}

/* MS: of a point after the first one. */
static bool read_time(const struct supply *supply, const char **at, const char *end, uint64_t *ps)
{
    if (!line_read_fixed(at, end, MS_DECIMALS, MS_MAX * VTIME_PS_PER_MS, ps) || *at == end || **at != ':') {
        return false;
    }
    (*at)++;
    return *ps > supply->point[supply->points - 1U].ps;
}

static bool read_point(struct supply *supply, const char **at, const char *end)
{
    uint64_t ps = 0;
    uint64_t mv = 0;
    if (supply->points == SUPPLY_POINTS_MAX || (supply->points > 0 && !read_time(supply, at, end, &ps)) ||
        !line_read_fixed(at, end, MV_DECIMALS, MV_MAX, &mv)) {
        return false;
    }
    supply->point[supply->points].ps = ps;
    supply->point[supply->points].mv = (uint32_t)mv;
    supply->points++;
    return true;
}

static bool read_points(struct supply *supply, const char *at)
{
    const char *end = at + strlen(at);
    while (read_point(supply, &at, end)) {
        if (at == end) {
            return true;
        }
        if (*at != ',') {
            return false;
        }
        at++;
    }
    return false;
}

bool supply_open(struct supply *supply, const char *text, enum supply_corner corner)
{
    text = text == NULL ? "3.3" : text;
    *supply = (struct supply){.wires = supply->wires, .corner = corner, .least_mv = MV_MAX, .release_ps = VTIME_NEVER};
    if (!read_points(supply, text)) {
        complain("--supply %s: not volts, or volts and times; write for example 3.3,50:3.3,60:2.5", text);
        return false;
    }
    supply->wires.conditions->supply_mv = supply->point[0].mv;
    supply->held = supply->wires.conditions->supply_mv <
                   reset_levels[flash_brown_out_level(supply->wires.flash)].rising[supply->corner];
    supply->forgotten = supply->held;
    clock_set_ps(supply->wires.clock, EVENT_SUPPLY, 0);
    return true;
}

bool pwr_read(void *model, uint32_t offset, uint32_t *value)
{
    const struct supply *supply = model;
    bool on = detector_is_on(supply);
    if (offset == PWR_CSR && on && clock_now_ps(supply->wires.clock) < supply->settled_ps) {
        report_fail(supply->wires.report,
                    "PWR_CSR is read before the voltage detector, just switched on, can be believed");
    }
    *value = offset == PWR_CR ? supply->pwr_cr : PWR_CSR_VOSRDY | (on && supply->low ? PWR_CSR_PVDO : 0U);
    return offset == PWR_CR || offset == PWR_CSR;
}

/* Between its two thresholds a detector that is switched on, or to another level, says "low". */
static void start_detector(struct supply *supply)
{
    supply->low = true;
    watch_voltage(supply);
    supply->settled_ps = clock_now_ps(supply->wires.clock) + SETTLE_PS;
}

bool pwr_write(void *model, uint32_t offset, uint32_t value, uint32_t mask)
{
    struct supply *supply = model;
    uint32_t before = supply->pwr_cr;
    if (offset != PWR_CR) {
        return false;
    }
    supply->pwr_cr = ((before & ~mask) | (value & mask)) & PWR_CR_MASK;
    if (detector_is_on(supply) && ((before ^ supply->pwr_cr) & (PWR_CR_PVDE | PWR_CR_PLS)) != 0) {
        start_detector(supply);
    }
    return true;
}

void supply_init(struct supply *supply, struct supply_wires wires)
{
    supply->wires = wires;
    clock_attach(wires.clock, EVENT_SUPPLY, on_supply_event, supply);
}

#include "conditions.h"

/* RM0090 table 10: one more each 30 MHz, or less where the supply is lower. */
static uint64_t wait_states(uint64_t hclk, uint32_t supply_mv)
{
    static const struct {
        uint32_t least_mv;
        uint32_t hz;
    } rows[] = {{2700, 30000000}, {2400, 24000000}, {2100, 22000000}, {0, 20000000}};
    unsigned row = 0;
    while (supply_mv < rows[row].least_mv) {
        row++;
    }
    return (hclk + rows[row].hz - 1U) / rows[row].hz - 1U;
}

void conditions_check(struct conditions *conditions)
{
    uint64_t hclk = conditions->clock->time.hclk_hz;
    uint64_t pclk1 = hclk / conditions->pclk1_divider;
    uint64_t pclk2 = hclk / conditions->pclk2_divider;
    uint64_t states = wait_states(hclk, conditions->supply_mv);
    if (hclk > 168000000 || pclk1 > 42000000 || pclk2 > 84000000) {
        report_fail(conditions->report,
                    "clocks of %u, %u and %u MHz; limits are 168 for HCLK, 42 for APB1 and 84 for APB2",
                    (unsigned)(hclk / 1000000U), (unsigned)(pclk1 / 1000000U), (unsigned)(pclk2 / 1000000U));
    }
    if (conditions->flash_latency < states) {
        report_fail(conditions->report, "the flash has %u wait states and needs %u at %u MHz and %u mV",
                    conditions->flash_latency, (unsigned)states, (unsigned)(hclk / 1000000U),
                    (unsigned)conditions->supply_mv);
    }
}

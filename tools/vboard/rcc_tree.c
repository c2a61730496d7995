/*
 * The clock tree that the registers ask for (RM0090 figure 21), and its limits (section 7.2 and the data sheet).
 */
#include "rcc.h"

#define HSI_HZ UINT64_C(16000000)

static uint64_t pll_hz(struct rcc *rcc)
{
    uint32_t config = rcc->word[RCC_PLLCFGR / 4];
    uint64_t input = (config & RCC_PLLCFGR_HSE) != 0 ? rcc->wires.crystal_hz : HSI_HZ;
    uint32_t m = config & 0x3FU;
    uint32_t n = config >> 6 & 0x1FFU;
    uint32_t p = 2U * ((config >> 16 & 3U) + 1U);
    if (m < 2 || n < 50 || n > 432) {
        report_fail(rcc->wires.report, "RCC_PLLCFGR %08x: M must be 2 to 63 and N 50 to 432", config);
        return HSI_HZ;
    }
    uint64_t compared = input / m;
    uint64_t oscillator = compared * n;
    if (compared < 950000 || compared > 2100000 || oscillator < 100000000 || oscillator > 432000000) {
        report_fail(rcc->wires.report,
                    "the PLL compares at %u Hz and oscillates at %u Hz; limits are 0.95 to 2.1 MHz and 100 to "
                    "432 MHz",
                    (unsigned)compared, (unsigned)oscillator);
    }
    return oscillator / p;
}

static uint64_t source_hz(struct rcc *rcc)
{
    switch (rcc->source) {
    case RCC_SOURCE_HSE:
        return rcc->wires.crystal_hz;
    case RCC_SOURCE_PLL:
        return pll_hz(rcc);
    default:
        return HSI_HZ;
    }
}

/* Encodings of HPRE and PPREx in CFGR. */
static uint32_t ahb_divider(uint32_t code)
{
    static const uint16_t dividers[] = {2, 4, 8, 16, 64, 128, 256, 512};
    return code < 8 ? 1U : dividers[code - 8U];
}

static uint32_t apb_divider(uint32_t code)
{
    return code < 4 ? 1U : 2U << (code - 4U);
}

/* Lets the whole board run with the clocks that the registers ask for. */
void rcc_apply(struct rcc *rcc)
{
    struct conditions *conditions = rcc->wires.conditions;
    uint32_t config = rcc->word[RCC_CFGR / 4];
    uint32_t apb1 = apb_divider(config >> 10 & 7U);
    uint64_t hz = source_hz(rcc) / ahb_divider(config >> 4 & 15U);
    uint32_t apb2 = apb_divider(config >> 13 & 7U);
    if (hz == rcc->wires.clock->time.hclk_hz && apb1 == conditions->pclk1_divider &&
        apb2 == conditions->pclk2_divider) {
        return;
    }
    rcc->wires.outlet.hold(rcc->wires.outlet.board);
    conditions->pclk1_divider = apb1;
    conditions->pclk2_divider = apb2;
    conditions->timer1_divider = apb1 == 1 ? 1U : apb1 / 2U; /* figure 21: twice APB1 unless it is undivided */
    conditions->timer2_divider = apb2 == 1 ? 1U : apb2 / 2U;
    clock_set_hclk(rcc->wires.clock, hz);
    rcc->wires.outlet.release(rcc->wires.outlet.board);
    conditions_check(conditions);
}

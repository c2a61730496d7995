/*
 * The clock tree that the registers ask for (RM0090 figure 21), and its limits (section 7.2 and the data sheet).
 */
#include "board.h"

#define HSI_HZ UINT64_C(16000000)

static uint64_t pll_hz(struct board *board)
{
    const struct rcc *rcc = &board->rcc;
    uint32_t config = rcc->word[RCC_PLLCFGR / 4];
    uint64_t input = (config & RCC_PLLCFGR_HSE) != 0 ? board->options->crystal_hz : HSI_HZ;
    uint32_t m = config & 0x3FU;
    uint32_t n = config >> 6 & 0x1FFU;
    uint32_t p = 2U * ((config >> 16 & 3U) + 1U);
    if (m < 2 || n < 50 || n > 432) {
        board_fail(board, "RCC_PLLCFGR %08x: M must be 2 to 63 and N 50 to 432", config);
        return HSI_HZ;
    }
    uint64_t compared = input / m;
    uint64_t oscillator = compared * n;
    if (compared < 950000 || compared > 2100000 || oscillator < 100000000 || oscillator > 432000000) {
        board_fail(board,
                   "the PLL compares at %u Hz and oscillates at %u Hz; limits are 0.95 to 2.1 MHz and 100 to "
                   "432 MHz",
                   (unsigned)compared, (unsigned)oscillator);
    }
    return oscillator / p;
}

static uint64_t source_hz(struct board *board)
{
    switch (board->rcc.source) {
    case RCC_SOURCE_HSE:
        return board->options->crystal_hz;
    case RCC_SOURCE_PLL:
        return pll_hz(board);
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

void rcc_check_limits(struct board *board)
{
    const struct rcc *rcc = &board->rcc;
    uint64_t hclk = board->time.hclk_hz;
    uint64_t states = wait_states(hclk, board->supply.mv);
    if (hclk > 168000000 || hclk / rcc->pclk1_divider > 42000000 || hclk / rcc->pclk2_divider > 84000000) {
        board_fail(board, "clocks of %u, %u and %u MHz; limits are 168 for HCLK, 42 for APB1 and 84 for APB2",
                   (unsigned)(hclk / 1000000U), (unsigned)(hclk / rcc->pclk1_divider / 1000000U),
                   (unsigned)(hclk / rcc->pclk2_divider / 1000000U));
    }
    if (flash_latency(&board->flash) < states) {
        board_fail(board, "the flash has %u wait states and needs %u at %u MHz and %u mV", flash_latency(&board->flash),
                   (unsigned)states, (unsigned)(hclk / 1000000U), (unsigned)board->supply.mv);
    }
}

/* Lets the whole board run with the clocks that the registers ask for. */
void rcc_apply(struct board *board)
{
    struct rcc *rcc = &board->rcc;
    uint32_t config = rcc->word[RCC_CFGR / 4];
    uint32_t apb1 = apb_divider(config >> 10 & 7U);
    uint64_t hz = source_hz(board) / ahb_divider(config >> 4 & 15U);
    uint32_t apb2 = apb_divider(config >> 13 & 7U);
    if (hz == board->time.hclk_hz && apb1 == rcc->pclk1_divider && apb2 == rcc->pclk2_divider) {
        return;
    }
    timers_hold(board);
    rcc->pclk1_divider = apb1;
    rcc->pclk2_divider = apb2;
    rcc->timer1_divider = apb1 == 1 ? 1U : apb1 / 2U; /* figure 21: twice APB1 unless it is undivided */
    vtime_set_hclk(&board->time, board->cpu.now, hz);
    events_rescale(board);
    timers_release(board);
    rcc_check_limits(board);
}

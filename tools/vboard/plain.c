#include "plain.h"

#include "board.h"

enum {
    PWR_CR = 0x00,
    PWR_CSR = 0x04,
    SYSCFG_MEMRMP = 0x00,
    SYSCFG_PMC = 0x04,
    SYSCFG_EXTICR1 = 0x08,
    SYSCFG_EXTICR4 = 0x14,
    EXTICR_BITS = 16,
};

#define PWR_CR_RESET UINT32_C(0x4000) /* VOS: scale 1 */
#define PWR_CR_MASK UINT32_C(0x43FF)
#define PWR_CR_PVDE (UINT32_C(1) << 4)
#define PWR_CSR_PVDO (UINT32_C(1) << 2)
#define PWR_CSR_VOSRDY (UINT32_C(1) << 14)

void plain_reset(struct board *board)
{
    uint32_t supply_mv = board->plain.supply_mv;
    board->plain = (struct plain){.pwr_cr = PWR_CR_RESET, .supply_mv = supply_mv};
}

/* Section 5.4.1, PVDE and PLS: whether the supply is below the level that is chosen. */
static uint32_t detected(const struct plain *plain)
{
    static const uint16_t levels_mv[] = {2000, 2100, 2300, 2500, 2600, 2700, 2800, 2900};
    bool low = plain->supply_mv < levels_mv[plain->pwr_cr >> 5 & 7U];
    return (plain->pwr_cr & PWR_CR_PVDE) != 0 && low ? PWR_CSR_PVDO : 0U;
}

bool pwr_read(struct board *board, unsigned instance, uint32_t offset, uint32_t *value)
{
    (void)instance;
    *value = offset == PWR_CR ? board->plain.pwr_cr : PWR_CSR_VOSRDY | detected(&board->plain);
    return offset == PWR_CR || offset == PWR_CSR;
}

bool pwr_write(struct board *board, unsigned instance, uint32_t offset, uint32_t value, uint32_t mask)
{
    (void)instance;
    if (offset == PWR_CR) {
        board->plain.pwr_cr = ((board->plain.pwr_cr & ~mask) | (value & mask)) & PWR_CR_MASK;
    }
    return offset == PWR_CR;
}

bool syscfg_read(struct board *board, unsigned instance, uint32_t offset, uint32_t *value)
{
    (void)instance;
    *value = 0;
    if (offset == SYSCFG_PMC) {
        *value = board->plain.syscfg_pmc;
    } else if (offset >= SYSCFG_EXTICR1 && offset <= SYSCFG_EXTICR4) {
        *value = board->plain.exticr[(offset - SYSCFG_EXTICR1) / 4U];
    }
    return offset <= SYSCFG_EXTICR4;
}

/* Sections 9.2.3 to 9.2.6: four lines a register. */
static void route_lines(struct board *board)
{
    uint64_t ports = 0;
    for (unsigned i = 0; i < PLAIN_EXTICRS; i++) {
        ports |= (uint64_t)board->plain.exticr[i] << EXTICR_BITS * i;
    }
    exti_route(board, ports);
}

/* Another memory at address 0 is not modelled. */
bool syscfg_write(struct board *board, unsigned instance, uint32_t offset, uint32_t value, uint32_t mask)
{
    (void)instance;
    if (offset == SYSCFG_MEMRMP) {
        return (value & mask) == 0;
    }
    if (offset > SYSCFG_EXTICR4) {
        return false;
    }
    if (offset == SYSCFG_PMC) {
        board->plain.syscfg_pmc = (board->plain.syscfg_pmc & ~mask) | (value & mask);
        return true;
    }
    uint16_t *ports = &board->plain.exticr[(offset - SYSCFG_EXTICR1) / 4U];
    *ports = (uint16_t)((*ports & ~mask) | (value & mask));
    route_lines(board);
    return true;
}

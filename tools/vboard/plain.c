#include "plain.h"

#include "board.h"

enum {
    PWR_CR = 0x00,
    PWR_CSR = 0x04,
    SYSCFG_MEMRMP = 0x00,
    SYSCFG_EXTICR4 = 0x14,
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
    *value = offset > SYSCFG_MEMRMP && offset <= SYSCFG_EXTICR4 ? board->plain.syscfg[offset / 4U - 1U] : 0U;
    return offset <= SYSCFG_EXTICR4;
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
    uint32_t *word = &board->plain.syscfg[offset / 4U - 1U];
    *word = (*word & ~mask) | (value & mask);
    return true;
}

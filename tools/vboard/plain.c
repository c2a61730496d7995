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
#define PWR_CSR_VOSRDY (UINT32_C(1) << 14)

void plain_reset(struct board *board)
{
    board->plain = (struct plain){.pwr_cr = PWR_CR_RESET};
}

bool pwr_read(struct board *board, unsigned instance, uint32_t offset, uint32_t *value)
{
    (void)instance;
    *value = offset == PWR_CR ? board->plain.pwr_cr : PWR_CSR_VOSRDY;
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

#include "plain.h"

#include "board.h"

enum {
    SYSCFG_MEMRMP = 0x00,
    SYSCFG_PMC = 0x04,
    SYSCFG_EXTICR1 = 0x08,
    SYSCFG_EXTICR4 = 0x14,
    EXTICR_BITS = 16,
};

void plain_reset(struct board *board)
{
    board->plain = (struct plain){.syscfg_pmc = 0};
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

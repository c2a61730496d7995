#include "loader.h"

#include "board.h"

#define SYSTEM_MEMORY UINT32_C(0x1FFF0000)
#define SYSTICK_CTRL UINT32_C(0xE000E010)
#define SYSTICK_LOAD UINT32_C(0xE000E014)

void loader_leave(struct board *board)
{
    bool usb = !board->options->no_crystal;
    rcc_run_from_pll(board, usb);
    flash_leave_unlocked(board);
    board->scb.vtor = SYSTEM_MEMORY;
    nvic_enable(&board->nvic, NVIC_IRQ0 + NVIC_IRQ_USB, true);
    nvic_set_line(board, NVIC_IRQ_USB, true); /* and stays, as nobody serves it any more */
    cpu_write(&board->cpu, UC_ARM_REG_PRIMASK, 1);
    (void)core_write(board, SYSTICK_LOAD, 60000 - 1, UINT32_MAX);
    (void)core_write(board, SYSTICK_CTRL, 7, UINT32_MAX);
}

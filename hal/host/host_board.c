#include "hal_board.h"

#include "host_private.h"

enum hal_board_cause hal_board_start_cause(void)
{
    return host_current()->faults.start_cause;
}

bool hal_board_may_move(void)
{
    return !host_current()->faults.no_crystal;
}

bool hal_board_may_start_programs(void)
{
    enum hal_board_cause cause = hal_board_start_cause();
    return cause != HAL_BOARD_CAUSE_WATCHDOG && cause != HAL_BOARD_CAUSE_FAULT;
}

uint32_t hal_board_late_steps(void)
{
    return (uint32_t)host_current()->late_steps;
}

bool hal_board_steps_are_timed(void)
{
    return !host_current()->faults.no_step_timer;
}

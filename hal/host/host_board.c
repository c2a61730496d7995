#include "hal_board.h"

#include "host_private.h"

bool hal_board_may_move(void)
{
    return !host_current()->faults.no_crystal;
}

bool hal_board_may_start_programs(void)
{
    return !host_current()->faults.bad_start;
}

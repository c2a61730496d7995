/*
 * The image of a board: one unit, for ever.
 */
#include "hal_board.h"
#include "positioning.h"

int main(void)
{
    static struct pos_unit unit;
    hal_board_init();
    positioning_init(&unit);
    positioning_start(&unit);
    for (;;) {
        hal_board_idle(positioning_poll(&unit));
    }
}

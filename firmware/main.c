/*
 * The image of a board: one unit, for ever.
 */
#include "hal_board.h"
#include "unit.h"

int main(void)
{
    static struct unit unit;
    hal_board_init();
    unit_init(&unit);
    unit_start(&unit);
    for (;;) {
        hal_board_idle(unit_poll(&unit));
    }
}

/*
 * The image of a board: one unit, for ever.
 */
#include "hal_board.h"
#include "rkm04.h"

int main(void)
{
    static struct rkm04 unit;
    hal_board_init();
    rkm04_init(&unit);
    rkm04_start(&unit);
    for (;;) {
        hal_board_idle(rkm04_poll(&unit));
    }
}

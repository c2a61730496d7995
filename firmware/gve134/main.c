/*
 * The image of a board: one unit, for ever.
 */
#include "gve134.h"
#include "hal_board.h"

int main(void)
{
    static struct gve134 unit;
    hal_board_init();
    gve134_init(&unit);
    gve134_start(&unit);
    for (;;) {
        hal_board_idle(gve134_poll(&unit));
    }
}

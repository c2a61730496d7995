/* 168 MHz with four wait states. */
#include "part.h"

int main(void)
{
    run_at_168_mhz();
    FLASH_ACR = 4;
    return 0;
}

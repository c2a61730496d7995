/* Reads a register that does not exist. */
#include "part.h"

int main(void)
{
    RCC_AHB1ENR |= 1;
    settle();
    result[0] = REG(GPIOA + 0x40);
    return 0;
}

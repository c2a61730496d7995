/* A fault inside HardFault, with the watchdog running or not (result is not looked at). */
#include "part.h"

void hard_fault_handler(void)
{
    (void)REG(0xA0000000);
}

int main(void)
{
    if ((RCC_CSR & 1u << 29) != 0) {
        return 0;
    }
#ifdef WITH_WATCHDOG
    IWDG_KR = 0xCCCC;
#endif
    (void)REG(0xA0000000);
    return 0;
}

/* Writes to TIM2 without its clock, or while it is held in reset. */
#include "part.h"

int main(void)
{
#ifdef HELD
    RCC_APB1ENR |= 1;
    (void)RCC_APB1ENR;
    (void)RCC_APB1ENR;
    RCC_APB1RSTR = 2; /* TIM3 */
    TIM_PSC(TIM2) = 1;
    RCC_APB1RSTR = 1;
    result[0] = RCC_APB1RSTR;
#endif
    TIM_PSC(TIM2) = 1;
    return 0;
}

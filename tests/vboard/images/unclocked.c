/* Writes to TIM2 without its clock. */
#include "part.h"

int main(void)
{
    TIM_PSC(TIM2) = 1;
    return 0;
}

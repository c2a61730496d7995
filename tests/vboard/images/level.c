/* A timer's interrupt whose flag is cleared late or not at all comes again; one cleared in time does not. */
#include "part.h"

static volatile uint32_t count;
static volatile uint32_t leave;

void tim2_handler(void)
{
    count++;
    if (leave > 0) {
        leave--;
        return;
    }
    TIM_SR(TIM2) = 0;
    (void)TIM_SR(TIM2); /* the write has arrived when the read answers */
}

int main(void)
{
    RCC_APB1ENR |= 1;
    settle();
    NVIC_ISER(0) = 1u << IRQ_TIM2;
    TIM_DIER(TIM2) = 2;
    TIM_EGR(TIM2) = 2;
    __asm volatile("nop\n nop");
    result[0] = count;
    leave = 2;
    TIM_EGR(TIM2) = 2;
    __asm volatile("nop\n nop");
    result[1] = count;
    return 0;
}

/* USART2 at 16 MHz, 19200 Bd: answers each byte with the byte plus one, PA1 drives the bus. */
#include "part.h"

static volatile uint32_t received;

void usart2_handler(void)
{
    uint32_t status = USART_SR(USART2);
    if ((status & 0x28) != 0) {
        uint32_t byte = USART_DR(USART2);
        if (received < 16) {
            result[received] = (status & 0xFF) << 8 | byte;
        }
        received++;
    }
}

static void send(uint32_t byte)
{
    GPIO_BSRR(GPIOA) = 2;
    USART_DR(USART2) = byte;
    while ((USART_SR(USART2) & 0x40) == 0) {
    }
    GPIO_BSRR(GPIOA) = 2u << 16;
}

int main(void)
{
    RCC_AHB1ENR |= 1;
    RCC_APB1ENR |= 1u << 17;
    settle();
    GPIO_AFRL(GPIOA) = 0x7700;
#ifndef PINS_LAST
    GPIO_MODER(GPIOA) = (GPIO_MODER(GPIOA) & ~0xFCu) | 0xA4; /* PA1 output, PA2 and PA3 alternate */
#endif
#ifdef DRIVER_ON
    GPIO_BSRR(GPIOA) = 2;
#endif
    USART_BRR(USART2) = 833; /* 16 MHz / 19200 */
    USART_CR1(USART2) = 1u << 13 | 1u << 5 | 1u << 3 | 1u << 2;
#ifdef PINS_LAST
    GPIO_MODER(GPIOA) = (GPIO_MODER(GPIOA) & ~0xFCu) | 0xA4;
#endif
    while ((USART_SR(USART2) & 0x40) == 0) {
    }
    NVIC_ISER(1) = 1u << (IRQ_USART2 - 32);
    uint32_t answered = 0;
    for (;;) {
        while (answered == received) {
            __asm volatile("wfi");
        }
        if (result[answered] >> 8 == 0xFF) {
            break;
        }
        send((result[answered++] & 0xFF) + 1);
    }
    return 0;
}

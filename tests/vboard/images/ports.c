/* Pins: outputs, pulls, open drain, inputs from outside. PA0 to PA3. */
#include "part.h"

int main(void)
{
    RCC_AHB1ENR |= 5;
    settle();
    result[0] = GPIO_MODER(GPIOA);
    GPIO_MODER(GPIOA) = (GPIO_MODER(GPIOA) & ~0xFFu) | 0x15; /* PA0 to PA2 outputs, PA3 input */
    GPIO_BSRR(GPIOA) = 0x00070005;                           /* set wins over reset */
    result[1] = GPIO_ODR(GPIOA) & 7;
    result[2] = GPIO_IDR(GPIOA) & 7;
    GPIO_PUPDR(GPIOA) = (GPIO_PUPDR(GPIOA) & ~0xC0u) | 0x40; /* PA3 up */
    result[3] = GPIO_IDR(GPIOA) & 8;
    GPIO_PUPDR(GPIOA) = (GPIO_PUPDR(GPIOA) & ~0xC0u) | 0x80; /* down */
    result[4] = GPIO_IDR(GPIOA) & 8;
    GPIO_OTYPER(GPIOA) = 4; /* PA2 open drain and high: floats, reads 0 */
    result[5] = GPIO_IDR(GPIOA) & 4;
    *(volatile uint8_t *)(GPIOA + 0x1A) = 1; /* a byte of the reset half */
    result[6] = GPIO_IDR(GPIOA) & 1;
    GPIO_MODER(GPIOC) = 0;
    uint32_t before = cycles();
    while ((GPIO_IDR(GPIOC) & 1) == 0) {
    }
    result[7] = (cycles() - before) / 16; /* us until bi1 */
    result[8] = GPIO_IDR(GPIOC) & 2;      /* bi2 is low at the pin when it is 1 */
    return 0;
}

/* One thing that the manuals forbid, by its number, and beside each of them something that is allowed. */
#include "part.h"

extern const uint32_t which;
const uint32_t which __attribute__((section(".rodata.which"))) = 0;

#define HALF(address) (*(volatile uint16_t *)(address))
#define BYTE(address) (*(volatile uint8_t *)(address))

static void send_byte(void)
{
    GPIO_MODER(GPIOA) = (GPIO_MODER(GPIOA) & ~(3u << 18)) | 2u << 18; /* PA9 */
    GPIO_AFRH(GPIOA) = 7u << 4;
    USART_BRR(USART1) = 0x341;
    USART_CR1(USART1) = 1u << 13 | 1u << 3;
    for (volatile unsigned i = 0; i < 1000; i++) {
    }
    (void)USART_SR(USART1); /* and a write of DR: TC is cleared */
    USART_DR(USART1) = 'a';
    (void)USART_CR1(USART1);
}

static void start_watchdog(void)
{
    IWDG_KR = 0xCCCC;
    IWDG_KR = 0x5555;
    IWDG_PR = 3;
    IWDG_RLR = 100; /* flags of their own */
    IWDG_KR = 0xAAAA;
}

static void do_buses(uint32_t number)
{
    switch (number) {
    case 1:
        HALF(TIM2 + 0x34) = 5;
        break;
    case 2:
        HALF(TIM2 + 0x28) = 5; /* PSC has 16 bits */
        break;
    case 3:
        HALF(TIM3 + 0x34) = 5; /* and so has all of TIM3 */
        break;
    case 4:
        TIM_CCR(TIM3, 1) = 0x10000;
        break;
    case 5:
        TIM_EGR(TIM2) = 0x80;
        break;
    case 6:
        TIM_CCER(TIM2) = 1u << 3;
        break;
    case 7:
        TIM_SR(TIM2) = ~2u; /* ones do nothing there */
        break;
    case 8:
        BYTE(TIM2 + 0x28) = 5;
        break;
    case 9:
        SYSCFG_EXTICR(0) = 1u << 16;
        break;
    case 10:
        GPIO_ODR(GPIOA) = 1u << 16;
        break;
    case 11:
        GPIO_PUPDR(GPIOA) |= 3u << 2;
        break;
    case 12:
        REG8(GPIOA + 0x18) = 1;
        break;
    case 13:
        HALF(GPIOA + 0x1A) = 1;
        break;
    default:
        break;
    }
}

static void do_core(uint32_t number)
{
    switch (number) {
    case 20:
        HALF(0xE000E100) = 1;
        break;
    case 21:
        NVIC_IPR(IRQ_TIM2) = 0x10;
        break;
    case 22:
        NVIC_IPR(IRQ_TIM2) = 0x18;
        break;
    case 23:
        NVIC_ISER(2) = 1u << 18;
        break;
    case 24:
        NVIC_ISER(2) = 1u << 17;
        break;
    case 25:
        SCB_VTOR = 0x20000100;
        break;
    case 26:
        SCB_AIRCR = 0x12340300;
        break;
    case 27:
        SCB_AIRCR = 0x05FA0300;
        break;
    case 28:
        SCB_ICSR = 1u << 28 | 1u << 27;
        break;
    case 29:
        SCB_SHPR(15) = 0xF0;
        break;
    case 30:
        SCB_SHPR(15) = 0xF1;
        break;
    case 31:
        SYST_RVR = 1u << 24;
        break;
    case 32:
        REG(0xE000EF00) = 82;
        break;
    case 33:
        __asm volatile("msr basepri, %0" ::"r"(0x18));
        NVIC_ISER(0) = 1u << IRQ_EXTI0;
        NVIC_ISPR(0) = 1u << IRQ_EXTI0;
        break;
    case 34:
        REG(0xE000E102) = 0;
        break;
    case 35:
        SCB_AIRCR = 0x05FA0002;
        break;
    default:
        break;
    }
}

static void do_flash_and_watchdog(uint32_t number)
{
    switch (number) {
    case 40:
        FLASH_ACR = 1u << 9 | 1u << 10;
        FLASH_ACR = 1u << 11;
        break;
    case 41:
        FLASH_ACR = 1u << 9 | 1u << 10;
        FLASH_ACR = 1u << 12;
        break;
    case 42:
        FLASH_ACR = 1u << 9 | 1u << 10;
        FLASH_ACR = 0;
        FLASH_ACR = 3u << 11;
        FLASH_ACR = 3u << 9;
        break;
    case 43:
        FLASH_ACR = 1u << 4;
        break;
    case 44:
        IWDG_PR = 3;
        break;
    case 45:
        IWDG_KR = 0x1234;
        break;
    case 46:
        start_watchdog();
        IWDG_KR = 0x5555;
        IWDG_PR = 4;
        break;
    case 47:
        start_watchdog();
        IWDG_KR = 0x5555;
        IWDG_RLR = 200;
        break;
    case 48:
        start_watchdog();
        break;
    case 49:
        IWDG_KR = 0x5555;
        IWDG_KR = 0xAAAA; /* locks again */
        IWDG_RLR = 200;
        break;
    default:
        break;
    }
}

static void do_usart(uint32_t number)
{
    switch (number) {
    case 50:
        send_byte();
        USART_BRR(USART1) = 0x340;
        break;
    case 51:
        send_byte();
        USART_CR1(USART1) = 1u << 13;
        break;
    case 52:
        send_byte();
        USART_CR1(USART1) = 1u << 3;
        break;
    case 53:
        send_byte();
        while ((USART_SR(USART1) & 1u << 6) == 0) {
        }
        USART_CR1(USART1) = 0;
        USART_BRR(USART1) = 0x340;
        break;
    case 54:
        USART_BRR(USART1) = 0xF;
        break;
    case 55:
        USART_CR1(USART1) = 1u << 15;
        USART_BRR(USART1) = 0x348;
        break;
    case 56:
        USART_CR1(USART1) = 1u << 14;
        break;
    case 57:
        USART_DR(USART1) = 0x200;
        break;
    default:
        break;
    }
}

int main(void)
{
    RCC_AHB1ENR |= 1;
    RCC_APB1ENR |= 3;
    RCC_APB2ENR |= 1u << 14 | 1u << 4;
    uint32_t number = *(const volatile uint32_t *)&which;
    do_buses(number);
    do_core(number);
    do_flash_and_watchdog(number);
    do_usart(number);
    (void)TIM_CR1(TIM2); /* what was written has arrived */
    result[0] = 1;
    return 0;
}

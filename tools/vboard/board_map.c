/*
 * Which model is at which address, and the bit of its clock enable (RM0090 table 1 and section 7.3).
 */
#include "board.h"
#include "dma_registers.h"
#include "timer_registers.h"

static void attach(struct bus *bus, const struct bus_block *blocks, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        bus_attach(bus, blocks[i]);
    }
}

static void attach_on_apb(struct board *board)
{
    struct timer *timer = board->timer;
    struct usart *usart = board->usart;
    const struct bus_block blocks[] = {
        {"TIM2", &timer[0], timer_read, timer_write, timer_register_is_wide, 0x40000000, 2, RCC_APB1ENR, 0},
        {"TIM3", &timer[1], timer_read, timer_write, timer_register_is_wide, 0x40000400, 2, RCC_APB1ENR, 1},
        {"TIM4", &timer[2], timer_read, timer_write, timer_register_is_wide, 0x40000800, 2, RCC_APB1ENR, 2},
        {"TIM5", &timer[3], timer_read, timer_write, timer_register_is_wide, 0x40000C00, 2, RCC_APB1ENR, 3},
        {"IWDG", &board->iwdg, iwdg_read, iwdg_write, NULL, 0x40003000, 2, 0, 0},
        {"USART2", &usart[1], usart_read, usart_write, NULL, 0x40004400, 2, RCC_APB1ENR, 17},
        {"USART3", &usart[2], usart_read, usart_write, NULL, 0x40004800, 2, RCC_APB1ENR, 18},
        {"PWR", &board->supply, pwr_read, pwr_write, NULL, 0x40007000, 2, RCC_APB1ENR, 28},
        {"TIM1", &timer[TIMER_TIM1], timer_read, timer_write, timer_register_is_wide, 0x40010000, 2, RCC_APB2ENR, 0},
        {"USART1", &usart[0], usart_read, usart_write, NULL, 0x40011000, 2, RCC_APB2ENR, 4},
        {"ADC1", &board->adc, adc_read, adc_write, NULL, 0x40012000, 1, RCC_APB2ENR, 8},
        {"SYSCFG", &board->syscfg, syscfg_read, syscfg_write, NULL, 0x40013800, 1, RCC_APB2ENR, 14},
        {"EXTI", &board->exti, exti_read, exti_write, NULL, 0x40013C00, 2, 0, 0},
    };
    attach(&board->bus, blocks, sizeof blocks / sizeof *blocks);
}

static void attach_on_ahb(struct board *board)
{
    struct port *port = board->gpio.port;
    const struct bus_block blocks[] = {
        {"GPIOA", &port[0], gpio_read, gpio_write, NULL, 0x40020000, 1, RCC_AHB1ENR, 0},
        {"GPIOB", &port[1], gpio_read, gpio_write, NULL, 0x40020400, 1, RCC_AHB1ENR, 1},
        {"GPIOC", &port[2], gpio_read, gpio_write, NULL, 0x40020800, 1, RCC_AHB1ENR, 2},
        {"GPIOD", &port[3], gpio_read, gpio_write, NULL, 0x40020C00, 1, RCC_AHB1ENR, 3},
        {"GPIOE", &port[4], gpio_read, gpio_write, NULL, 0x40021000, 1, RCC_AHB1ENR, 4},
        {"GPIOF", &port[5], gpio_read, gpio_write, NULL, 0x40021400, 1, RCC_AHB1ENR, 5},
        {"GPIOG", &port[6], gpio_read, gpio_write, NULL, 0x40021800, 1, RCC_AHB1ENR, 6},
        {"GPIOH", &port[7], gpio_read, gpio_write, NULL, 0x40021C00, 1, RCC_AHB1ENR, 7},
        {"GPIOI", &port[8], gpio_read, gpio_write, NULL, 0x40022000, 1, RCC_AHB1ENR, 8},
        {"RCC", &board->rcc, rcc_read, rcc_write, NULL, 0x40023800, 1, 0, 0},
        {"FLASH", &board->flash, flash_read_register, flash_write_register, NULL, 0x40023C00, 1, 0, 0},
        {"DMA1", &board->dma[0], dma_read, dma_write, NULL, 0x40026000, 4, RCC_AHB1ENR, 21},
        {"DMA2", &board->dma[1], dma_read, dma_write, NULL, 0x40026400, 4, RCC_AHB1ENR, 22},
    };
    attach(&board->bus, blocks, sizeof blocks / sizeof *blocks);
}

void board_attach_peripherals(struct board *board)
{
    attach_on_apb(board);
    attach_on_ahb(board);
}

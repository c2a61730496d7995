/*
 * Vectors, start and the clock of the test images. Every handler is weak and ends the run with 0xDEAD in result[31].
 */
#include "part.h"

volatile uint32_t result[32];

extern uint32_t stack_top[], data_load[], data_start[], data_end[], bss_start[], bss_end[];

int main(void);
void reset_handler(void);
void unexpected(void);

__attribute__((noinline)) void test_end(void)
{
    for (;;) {
    }
}

void unexpected(void)
{
    result[31] = 0xDEAD0000u | (SCB_ICSR & 0x1FF);
    test_end();
}

#define WEAK(name) void name(void) __attribute__((weak, alias("unexpected")))
WEAK(nmi_handler);
WEAK(hard_fault_handler);
WEAK(bus_fault_handler);
WEAK(usage_fault_handler);
WEAK(svc_handler);
WEAK(pendsv_handler);
WEAK(systick_handler);
WEAK(exti0_handler);
WEAK(exti1_handler);
WEAK(exti2_handler);
WEAK(exti3_handler);
WEAK(exti4_handler);
WEAK(exti9_5_handler);
WEAK(exti15_10_handler);
WEAK(tim2_handler);
WEAK(usart1_handler);
WEAK(usart2_handler);
WEAK(dma1_stream0_handler);
WEAK(dma1_stream1_handler);
WEAK(dma1_stream2_handler);
WEAK(dma1_stream3_handler);
WEAK(dma1_stream4_handler);
WEAK(dma1_stream5_handler);
WEAK(dma1_stream6_handler);
WEAK(dma1_stream7_handler);

typedef void handler(void);

__attribute__((section(".vectors"), used)) handler *const vectors[16 + 82] = {
    (handler *)stack_top,
    reset_handler,
    nmi_handler,
    hard_fault_handler,
    unexpected,
    bus_fault_handler,
    usage_fault_handler,
    [7 ... 10] = unexpected,
    [11] = svc_handler,
    [12 ... 13] = unexpected,
    [14] = pendsv_handler,
    [15] = systick_handler,
    [16 ... 21] = unexpected,
    [22] = exti0_handler,
    [23] = exti1_handler,
    [24] = exti2_handler,
    exti3_handler,
    exti4_handler,
    [27] = dma1_stream0_handler,
    dma1_stream1_handler,
    dma1_stream2_handler,
    dma1_stream3_handler,
    dma1_stream4_handler,
    dma1_stream5_handler,
    dma1_stream6_handler,
    [34 ... 38] = unexpected,
    [39] = exti9_5_handler,
    [40 ... 43] = unexpected,
    [44] = tim2_handler,
    [45 ... 52] = unexpected,
    [53] = usart1_handler,
    [54] = usart2_handler,
    [55] = unexpected,
    [56] = exti15_10_handler,
    [57 ... 62] = unexpected,
    [63] = dma1_stream7_handler,
    [64 ... 97] = unexpected,
};

void start_counting_cycles(void)
{
    DEMCR |= 1u << 24;
    DWT_CYCCNT = 0;
    DWT_CTRL |= 1;
}

void run_at_168_mhz(void)
{
    FLASH_ACR = 0x700 | 5;
    RCC_CR |= 1u << 16;
    while ((RCC_CR & 1u << 17) == 0) {
    }
    RCC_PLLCFGR = RCC_PLLCFGR_KEPT | 8 | 336u << 6 | 0u << 16 | 1u << 22 | 7u << 24;
    RCC_CFGR = 5u << 10 | 4u << 13;
    RCC_CR |= 1u << 24;
    while ((RCC_CR & 1u << 25) == 0) {
    }
    RCC_CFGR |= 2;
    while ((RCC_CFGR & 0xC) != 8) {
    }
}

void reset_handler(void)
{
    for (uint32_t *to = data_start, *from = data_load; to < data_end;) {
        *to++ = *from++;
    }
    for (uint32_t *at = bss_start; at < bss_end; at++) {
        *at = 0;
    }
    start_counting_cycles();
    main();
    test_end();
}

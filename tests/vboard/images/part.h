/*
 * Registers of an STM32F405 as RM0090 and PM0214 describe them, for images that test the virtual board. Written for
 * these tests alone, so that nobody's mistake is made twice.
 */
#ifndef PART_H
#define PART_H

#include <stdint.h>

#define REG(address) (*(volatile uint32_t *)(address))
#define REG16(address) (*(volatile uint16_t *)(address))
#define REG8(address) (*(volatile uint8_t *)(address))

#define RCC 0x40023800u
#define RCC_CR REG(RCC + 0x00)
#define RCC_PLLCFGR REG(RCC + 0x04)
#define RCC_PLLCFGR_KEPT (2u << 28) /* of the reserved bits */
#define RCC_CFGR REG(RCC + 0x08)
#define RCC_CIR REG(RCC + 0x0C)
#define RCC_AHB1RSTR REG(RCC + 0x10)
#define RCC_APB1RSTR REG(RCC + 0x20)
#define RCC_AHB1ENR REG(RCC + 0x30)
#define RCC_APB1ENR REG(RCC + 0x40)
#define RCC_APB2ENR REG(RCC + 0x44)
#define RCC_CSR REG(RCC + 0x74)

#define FLASH 0x40023C00u
#define FLASH_ACR REG(FLASH + 0x00)
#define FLASH_KEYR REG(FLASH + 0x04)
#define FLASH_SR REG(FLASH + 0x0C)
#define FLASH_CR REG(FLASH + 0x10)

#define GPIOA 0x40020000u
#define GPIOB 0x40020400u
#define GPIOC 0x40020800u
#define GPIO_MODER(port) REG((port) + 0x00)
#define GPIO_OTYPER(port) REG((port) + 0x04)
#define GPIO_PUPDR(port) REG((port) + 0x0C)
#define GPIO_IDR(port) REG((port) + 0x10)
#define GPIO_ODR(port) REG((port) + 0x14)
#define GPIO_BSRR(port) REG((port) + 0x18)
#define GPIO_AFRL(port) REG((port) + 0x20)
#define GPIO_AFRH(port) REG((port) + 0x24)

#define SYSCFG_EXTICR(n) REG(0x40013808u + 4 * (n))
#define EXTI 0x40013C00u
#define EXTI_IMR REG(EXTI + 0x00)
#define EXTI_EMR REG(EXTI + 0x04)
#define EXTI_RTSR REG(EXTI + 0x08)
#define EXTI_FTSR REG(EXTI + 0x0C)
#define EXTI_SWIER REG(EXTI + 0x10)
#define EXTI_PR REG(EXTI + 0x14)

#define TIM2 0x40000000u
#define TIM3 0x40000400u
#define TIM5 0x40000C00u
#define TIM_CR1(tim) REG((tim) + 0x00)
#define TIM_CR2(tim) REG((tim) + 0x04)
#define TIM_DIER(tim) REG((tim) + 0x0C)
#define TIM_SR(tim) REG((tim) + 0x10)
#define TIM_EGR(tim) REG((tim) + 0x14)
#define TIM_CCMR1(tim) REG((tim) + 0x18)
#define TIM_CCMR2(tim) REG((tim) + 0x1C)
#define TIM_CCER(tim) REG((tim) + 0x20)
#define TIM_CNT(tim) REG((tim) + 0x24)
#define TIM_PSC(tim) REG((tim) + 0x28)
#define TIM_ARR(tim) REG((tim) + 0x2C)
#define TIM_OR(tim) REG((tim) + 0x50)
#define TIM_CCR(tim, n) REG((tim) + 0x30 + 4 * (n))

#define ADC1 0x40012000u
#define ADC_SR REG(ADC1 + 0x00)
#define ADC_CR1 REG(ADC1 + 0x04)
#define ADC_CR2 REG(ADC1 + 0x08)
#define ADC_SMPR1 REG(ADC1 + 0x0C)
#define ADC_SQR1 REG(ADC1 + 0x2C)
#define ADC_SQR3 REG(ADC1 + 0x34)
#define ADC_DR REG(ADC1 + 0x4C)
#define ADC_CCR REG(ADC1 + 0x304)

#define DMA1 0x40026000u
#define DMA_LISR REG(DMA1 + 0x00)
#define DMA_HISR REG(DMA1 + 0x04)
#define DMA_LIFCR REG(DMA1 + 0x08)
#define DMA_HIFCR REG(DMA1 + 0x0C)
#define DMA_CR(stream) REG(DMA1 + 0x10 + 0x18 * (stream))
#define DMA_NDTR(stream) REG(DMA1 + 0x14 + 0x18 * (stream))
#define DMA_PAR(stream) REG(DMA1 + 0x18 + 0x18 * (stream))
#define DMA_M0AR(stream) REG(DMA1 + 0x1C + 0x18 * (stream))
#define DMA_M1AR(stream) REG(DMA1 + 0x20 + 0x18 * (stream))
#define DMA_FCR(stream) REG(DMA1 + 0x24 + 0x18 * (stream))

#define USART1 0x40011000u
#define USART2 0x40004400u
#define USART_SR(usart) REG((usart) + 0x00)
#define USART_DR(usart) REG((usart) + 0x04)
#define USART_BRR(usart) REG((usart) + 0x08)
#define USART_CR1(usart) REG((usart) + 0x0C)

#define IWDG 0x40003000u
#define IWDG_KR REG(IWDG + 0x00)
#define IWDG_PR REG(IWDG + 0x04)
#define IWDG_RLR REG(IWDG + 0x08)
#define IWDG_SR REG(IWDG + 0x0C)

#define SYST_CSR REG(0xE000E010)
#define SYST_RVR REG(0xE000E014)
#define SYST_CVR REG(0xE000E018)
#define NVIC_ISER(n) REG(0xE000E100 + 4 * (n))
#define NVIC_ICER(n) REG(0xE000E180 + 4 * (n))
#define NVIC_ISPR(n) REG(0xE000E200 + 4 * (n))
#define NVIC_ICPR(n) REG(0xE000E280 + 4 * (n))
#define NVIC_IABR(n) REG(0xE000E300 + 4 * (n))
#define NVIC_IPR(irq) REG8(0xE000E400 + (irq))
#define SCB_ICSR REG(0xE000ED04)
#define SCB_VTOR REG(0xE000ED08)
#define SCB_AIRCR REG(0xE000ED0C)
#define SCB_SCR REG(0xE000ED10)
#define SCB_SHPR(n) REG8(0xE000ED18 + (n) - 4)
#define SCB_SHCSR REG(0xE000ED24)
#define SCB_CFSR REG(0xE000ED28)
#define SCB_HFSR REG(0xE000ED2C)
#define SCB_BFAR REG(0xE000ED38)
#define SCB_CPACR REG(0xE000ED88)
#define MPU_CTRL REG(0xE000ED94)
#define DEMCR REG(0xE000EDFC)
#define DWT_CTRL REG(0xE0001000)
#define DWT_CYCCNT REG(0xE0001004)

enum {
    IRQ_EXTI0 = 6,
    IRQ_EXTI1 = 7,
    IRQ_EXTI2 = 8,
    IRQ_EXTI9_5 = 23,
    IRQ_TIM2 = 28,
    IRQ_USART1 = 37,
    IRQ_USART2 = 38,
    IRQ_EXTI15_10 = 40,
};

/* What a test looks at. */
extern volatile uint32_t result[32];

/* The run ends here. */
void test_end(void);

/* Runs before main. */
void start_counting_cycles(void);

/* 168 MHz from a crystal of 8 MHz, APB1 / 4, APB2 / 2, 5 wait states. */
void run_at_168_mhz(void);

static inline uint32_t cycles(void)
{
    return DWT_CYCCNT;
}

/* A clock that was enabled in RCC comes some cycles later (errata ES0182). */
static inline void settle(void)
{
    __asm__ volatile("dsb\n\tnop\n\tnop\n\tnop\n\tnop\n\tnop\n\tnop\n\tnop\n\tnop" ::: "memory");
}

#define RAMCODE __attribute__((section(".ramcode"), noinline, long_call))

#endif

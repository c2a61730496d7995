/*
 * The registers of an STM32F405 or F407 that this backend uses, and of their bits those that it sets or reads.
 *
 * Numbers after registers are sections of ST's reference manual RM0090; those of the core are sections of the
 * programming manual PM0214. tests/tools/test_stm32_registers.py holds every address and bit against
 * independent descriptions; it reads this file line by line, so each definition stays on one line.
 */
#ifndef STM32F4_H
#define STM32F4_H

#include <stdint.h>

#define STM32_REGISTER(address) (*(volatile uint32_t *)(uintptr_t)(address))

/* Reset and clock control */
#define RCC_BASE 0x40023800U
#define RCC_CR STM32_REGISTER(RCC_BASE + 0x00U)       /* 7.3.1 */
#define RCC_PLLCFGR STM32_REGISTER(RCC_BASE + 0x04U)  /* 7.3.2 */
#define RCC_CFGR STM32_REGISTER(RCC_BASE + 0x08U)     /* 7.3.3 */
#define RCC_AHB1RSTR STM32_REGISTER(RCC_BASE + 0x10U) /* 7.3.5 */
#define RCC_AHB2RSTR STM32_REGISTER(RCC_BASE + 0x14U) /* 7.3.6 */
#define RCC_APB1RSTR STM32_REGISTER(RCC_BASE + 0x20U) /* 7.3.8 */
#define RCC_APB2RSTR STM32_REGISTER(RCC_BASE + 0x24U) /* 7.3.9 */
#define RCC_AHB1ENR STM32_REGISTER(RCC_BASE + 0x30U)  /* 7.3.10 */
#define RCC_APB1ENR STM32_REGISTER(RCC_BASE + 0x40U)  /* 7.3.13 */
#define RCC_APB2ENR STM32_REGISTER(RCC_BASE + 0x44U)  /* 7.3.14 */
#define RCC_CSR STM32_REGISTER(RCC_BASE + 0x74U)      /* 7.3.21 */
#define RCC_CR_HSION (1U << 0)
#define RCC_CR_HSIRDY (1U << 1)
#define RCC_CR_HSEON (1U << 16)
#define RCC_CR_HSERDY (1U << 17)
#define RCC_CR_HSEBYP (1U << 18)
#define RCC_CR_CSSON (1U << 19)
#define RCC_CR_PLLON (1U << 24)
#define RCC_CR_PLLRDY (1U << 25)
#define RCC_CR_PLLI2SON (1U << 26)
#define RCC_CR_PLLI2SRDY (1U << 27)
#define RCC_PLLCFGR_PLLM(n) ((n) << 0)
#define RCC_PLLCFGR_PLLN(n) ((n) << 6)
#define RCC_PLLCFGR_PLLSRC (1U << 22)
#define RCC_PLLCFGR_PLLQ(n) ((n) << 24)
#define RCC_CFGR_SW(n) ((n) << 0)
#define RCC_CFGR_SWS(n) ((n) << 2)
#define RCC_CFGR_PPRE1(n) ((n) << 10)
#define RCC_CFGR_PPRE2(n) ((n) << 13)
#define RCC_AHB1ENR_GPIOAEN (1U << 0)
#define RCC_AHB1ENR_DMA1EN (1U << 21)
#define RCC_AHB1ENR_DMA2EN (1U << 22)
#define RCC_APB1RSTR_TIM5RST (1U << 3)
#define RCC_APB1ENR_TIM2EN (1U << 0)
#define RCC_APB1ENR_TIM3EN (1U << 1)
#define RCC_APB1ENR_TIM4EN (1U << 2)
#define RCC_APB1ENR_TIM5EN (1U << 3)
#define RCC_APB1ENR_USART2EN (1U << 17)
#define RCC_APB1ENR_USART3EN (1U << 18)
#define RCC_APB1ENR_PWREN (1U << 28)
#define RCC_APB2ENR_TIM1EN (1U << 0)
#define RCC_APB2ENR_USART1EN (1U << 4)
#define RCC_APB2ENR_ADC1EN (1U << 8)
#define RCC_CSR_LSION (1U << 0)
#define RCC_CSR_LSIRDY (1U << 1)
#define RCC_CSR_RMVF (1U << 24)
#define RCC_CSR_BORRSTF (1U << 25)
#define RCC_CSR_PORRSTF (1U << 27)
#define RCC_CSR_SFTRSTF (1U << 28)
#define RCC_CSR_IWDGRSTF (1U << 29)

/* Power control */
#define PWR_BASE 0x40007000U
#define PWR_CR STM32_REGISTER(PWR_BASE + 0x00U)  /* 5.4.1 */
#define PWR_CSR STM32_REGISTER(PWR_BASE + 0x04U) /* 5.4.2 */
#define PWR_CR_PVDE (1U << 4)
#define PWR_CR_PLS(n) ((n) << 5)
#define PWR_CSR_PVDO (1U << 2)

/* Flash interface */
#define FLASH_BASE 0x40023C00U
#define FLASH_ACR STM32_REGISTER(FLASH_BASE + 0x00U)   /* 3.9.1 */
#define FLASH_KEYR STM32_REGISTER(FLASH_BASE + 0x04U)  /* 3.9.3 */
#define FLASH_SR STM32_REGISTER(FLASH_BASE + 0x0CU)    /* 3.9.5 */
#define FLASH_CR STM32_REGISTER(FLASH_BASE + 0x10U)    /* 3.9.7 */
#define FLASH_OPTCR STM32_REGISTER(FLASH_BASE + 0x14U) /* 3.9.8 */
#define FLASH_ACR_LATENCY(n) ((n) << 0)
#define FLASH_ACR_PRFTEN (1U << 8)
#define FLASH_ACR_ICEN (1U << 9)
#define FLASH_ACR_DCEN (1U << 10)
#define FLASH_ACR_DCRST (1U << 12)
#define FLASH_SR_EOP (1U << 0)
#define FLASH_SR_OPERR (1U << 1)
#define FLASH_SR_WRPERR (1U << 4)
#define FLASH_SR_PGAERR (1U << 5)
#define FLASH_SR_PGPERR (1U << 6)
#define FLASH_SR_PGSERR (1U << 7)
#define FLASH_SR_BSY (1U << 16)
#define FLASH_CR_PG (1U << 0)
#define FLASH_CR_SER (1U << 1)
#define FLASH_CR_SNB(n) ((n) << 3)
#define FLASH_CR_PSIZE(n) ((n) << 8)
#define FLASH_CR_STRT (1U << 16)
#define FLASH_CR_LOCK (1U << 31)
#define FLASH_OPTCR_OPTLOCK (1U << 0)
#define FLASH_KEY_1 0x45670123U /* 3.6.1 */
#define FLASH_KEY_2 0xCDEF89ABU

/* Identification, 38.6.1 */
#define DBG_BASE 0xE0042000U
#define DBG_IDCODE STM32_REGISTER(DBG_BASE + 0x00U)

/* General-purpose pins; ports count from A = 0 */
#define GPIO_BASE 0x40020000U
#define GPIO_STRIDE 0x400U
#define GPIO_REGISTER(port, offset) STM32_REGISTER(GPIO_BASE + GPIO_STRIDE * (port) + (offset))
#define GPIO_MODER(port) GPIO_REGISTER(port, 0x00U)   /* 8.4.1 */
#define GPIO_OSPEEDR(port) GPIO_REGISTER(port, 0x08U) /* 8.4.3 */
#define GPIO_PUPDR(port) GPIO_REGISTER(port, 0x0CU)   /* 8.4.4 */
#define GPIO_IDR(port) GPIO_REGISTER(port, 0x10U)     /* 8.4.5 */
#define GPIO_BSRR(port) GPIO_REGISTER(port, 0x18U)    /* 8.4.7 */
#define GPIO_AFRL(port) GPIO_REGISTER(port, 0x20U)    /* 8.4.9 */
#define GPIO_AFRH(port) GPIO_REGISTER(port, 0x24U)    /* 8.4.10 */

/* What is at address 0; which port has the pin on a line, and the edges of the lines */
#define SYSCFG_BASE 0x40013800U
#define SYSCFG_MEMRMP STM32_REGISTER(SYSCFG_BASE + 0x00U)               /* 9.2.1 */
#define SYSCFG_EXTICR(n) STM32_REGISTER(SYSCFG_BASE + 0x08U + 4U * (n)) /* 9.2.3 to 9.2.6 */
#define EXTI_BASE 0x40013C00U
#define EXTI_IMR STM32_REGISTER(EXTI_BASE + 0x00U)   /* 12.3.1 */
#define EXTI_RTSR STM32_REGISTER(EXTI_BASE + 0x08U)  /* 12.3.3 */
#define EXTI_FTSR STM32_REGISTER(EXTI_BASE + 0x0CU)  /* 12.3.4 */
#define EXTI_SWIER STM32_REGISTER(EXTI_BASE + 0x10U) /* 12.3.5 */
#define EXTI_PR STM32_REGISTER(EXTI_BASE + 0x14U)    /* 12.3.6 */

/* TIM1 has 16 bits; the bring-up image captures pulses with it.
 *
 * The two timers of 32 bits. TIM2 is the unit's time and calls the step interrupt; the STEP pins are channels of both.
 * TIM5 captures the low-speed oscillator before that. */
#define TIM2_BASE 0x40000000U
#define TIM3_BASE 0x40000400U /* of 16 bits: DIR */
#define TIM4_BASE 0x40000800U /* of 16 bits: PWM; captures pulses, too */
#define TIM5_BASE 0x40000C00U
#define TIM1_BASE 0x40010000U
#define TIM_CR1(base) STM32_REGISTER((base) + 0x00U)   /* 18.4.1 */
#define TIM_DIER(base) STM32_REGISTER((base) + 0x0CU)  /* 18.4.4 */
#define TIM_SR(base) STM32_REGISTER((base) + 0x10U)    /* 18.4.5 */
#define TIM_EGR(base) STM32_REGISTER((base) + 0x14U)   /* 18.4.6 */
#define TIM_CCMR1(base) STM32_REGISTER((base) + 0x18U) /* 18.4.7 */
#define TIM_CCMR2(base) STM32_REGISTER((base) + 0x1CU) /* 18.4.8 */
#define TIM_CCER(base) STM32_REGISTER((base) + 0x20U)  /* 18.4.9 */
#define TIM_CNT(base) STM32_REGISTER((base) + 0x24U)   /* 18.4.10 */
#define TIM_PSC(base) STM32_REGISTER((base) + 0x28U)   /* 18.4.11 */
#define TIM_ARR(base) STM32_REGISTER((base) + 0x2CU)   /* 18.4.12 */
#define TIM_CCR1(base) STM32_REGISTER((base) + 0x34U)  /* 18.4.13 */
#define TIM_CCR2(base) STM32_REGISTER((base) + 0x38U)  /* 18.4.14 */
#define TIM2_CNT STM32_REGISTER(TIM2_BASE + 0x24U)     /* 18.4.10 */
#define TIM2_CCR4 STM32_REGISTER(TIM2_BASE + 0x40U)    /* 18.4.16 */
#define TIM5_CCMR2 STM32_REGISTER(TIM5_BASE + 0x1CU)   /* 18.4.8 */
#define TIM5_CCR4 STM32_REGISTER(TIM5_BASE + 0x40U)    /* 18.4.16 */
#define TIM5_OR STM32_REGISTER(TIM5_BASE + 0x50U)      /* 18.4.20 */
#define TIM_CR1_CEN (1U << 0)
#define TIM_CR1_ARPE (1U << 7)
#define TIM_DIER_CC1IE (1U << 1)
#define TIM_DIER_CC4IE (1U << 4)
#define TIM_DIER_CC1DE (1U << 9)
#define TIM_SR_CC1IF (1U << 1)
#define TIM_SR_CC2IF (1U << 2)
#define TIM_SR_CC4IF (1U << 4)
#define TIM_SR_CC1OF (1U << 9)
#define TIM_SR_CC2OF (1U << 10)
#define TIM_EGR_UG (1U << 0)
#define TIM_EGR_CC1G (1U << 1)
#define TIM_EGR_CC4G (1U << 4)
#define TIM_CCMR1_CC1S(n) ((n) << 0)
#define TIM_CCMR1_OC1PE (1U << 3)
#define TIM_CCMR1_OC1M(n) ((n) << 4)
#define TIM_CCMR1_CC2S(n) ((n) << 8)
#define TIM_CCMR1_OC2PE (1U << 11)
#define TIM_CCMR1_OC2M(n) ((n) << 12)
#define TIM_CCER_CC1E (1U << 0)
#define TIM_CCER_CC1P (1U << 1)
#define TIM_CCER_CC2E (1U << 4)
#define TIM_CCER_CC2P (1U << 5)
#define TIM_CCER_CC4E (1U << 12)
#define TIM5_CCMR2_CC4S(n) ((n) << 8)
#define TIM5_CCMR2_IC4PSC(n) ((n) << 10)
#define TIM5_OR_TI4_RMP(n) ((n) << 6)

/* What carries the edges into the timers, and on DMA2 what the line has received; the streams count from 0 */
#define DMA1_BASE 0x40026000U
#define DMA1_LIFCR STM32_REGISTER(DMA1_BASE + 0x08U) /* 10.5.3 */
#define DMA1_HIFCR STM32_REGISTER(DMA1_BASE + 0x0CU) /* 10.5.4 */
#define DMA1_STREAM(n) (DMA1_BASE + 0x10U + 0x18U * (n))
#define DMA2_BASE 0x40026400U
#define DMA2_LIFCR STM32_REGISTER(DMA2_BASE + 0x08U) /* 10.5.3 */
#define DMA2_STREAM(n) (DMA2_BASE + 0x10U + 0x18U * (n))
#define DMA_CR(stream) STM32_REGISTER((stream) + 0x00U)   /* 10.5.5 */
#define DMA_NDTR(stream) STM32_REGISTER((stream) + 0x04U) /* 10.5.6 */
#define DMA_PAR(stream) STM32_REGISTER((stream) + 0x08U)  /* 10.5.7 */
#define DMA_M0AR(stream) STM32_REGISTER((stream) + 0x0CU) /* 10.5.8 */
#define DMA_FCR(stream) STM32_REGISTER((stream) + 0x14U)  /* 10.5.10 */
#define DMA_CR_EN (1U << 0)
#define DMA_CR_DIR(n) ((n) << 6)
#define DMA_CR_CIRC (1U << 8)
#define DMA_CR_MINC (1U << 10)
#define DMA_CR_PSIZE(n) ((n) << 11)
#define DMA_CR_MSIZE(n) ((n) << 13)
#define DMA_CR_PL(n) ((n) << 16)
#define DMA_CR_CHSEL(n) ((n) << 25)

/* What converts the internal reference; CCR is that of all three converters */
#define ADC1_BASE 0x40012000U
#define ADC1_SR STM32_REGISTER(ADC1_BASE + 0x00U)    /* 13.13.1 */
#define ADC1_CR2 STM32_REGISTER(ADC1_BASE + 0x08U)   /* 13.13.3 */
#define ADC1_SMPR1 STM32_REGISTER(ADC1_BASE + 0x0CU) /* 13.13.4 */
#define ADC1_SQR3 STM32_REGISTER(ADC1_BASE + 0x34U)  /* 13.13.11 */
#define ADC1_DR STM32_REGISTER(ADC1_BASE + 0x4CU)    /* 13.13.14 */
#define ADC1_SR_EOC (1U << 1)
#define ADC1_CR2_ADON (1U << 0)
#define ADC1_CR2_SWSTART (1U << 30)
#define ADC1_SQR3_SQ1(n) ((n) << 0)
#define C_ADC_BASE 0x40012300U
#define C_ADC_CCR STM32_REGISTER(C_ADC_BASE + 0x04U) /* 13.13.16 */

/* The line; which of the three is the board's affair */
#define USART1_BASE 0x40011000U
#define USART2_BASE 0x40004400U
#define USART3_BASE 0x40004800U
#define USART_SR(base) STM32_REGISTER((base) + 0x00U)  /* 30.6.1 */
#define USART_DR(base) STM32_REGISTER((base) + 0x04U)  /* 30.6.2 */
#define USART_BRR(base) STM32_REGISTER((base) + 0x08U) /* 30.6.3 */
#define USART_CR1(base) STM32_REGISTER((base) + 0x0CU) /* 30.6.4 */
#define USART_CR2(base) STM32_REGISTER((base) + 0x10U) /* 30.6.5 */
#define USART_CR3(base) STM32_REGISTER((base) + 0x14U) /* 30.6.6 */
#define USART_SR_PE (1U << 0)
#define USART_SR_FE (1U << 1)
#define USART_SR_NF (1U << 2)
#define USART_SR_ORE (1U << 3)
#define USART_SR_RXNE (1U << 5)
#define USART_SR_TC (1U << 6)
#define USART_SR_TXE (1U << 7)
#define USART_CR1_RE (1U << 2)
#define USART_CR1_TE (1U << 3)
#define USART_CR1_RXNEIE (1U << 5)
#define USART_CR1_TCIE (1U << 6)
#define USART_CR1_TXEIE (1U << 7)
#define USART_CR1_PS (1U << 9)
#define USART_CR1_PCE (1U << 10)
#define USART_CR1_M (1U << 12)
#define USART_CR1_UE (1U << 13)
#define USART_CR2_STOP (1U << 12) /* two bits; 2: two stop bits */
#define USART_CR3_EIE (1U << 0)
#define USART_CR3_DMAR (1U << 6)

/* Independent watchdog */
#define IWDG_BASE 0x40003000U
#define IWDG_KR STM32_REGISTER(IWDG_BASE + 0x00U)  /* 21.4.1 */
#define IWDG_PR STM32_REGISTER(IWDG_BASE + 0x04U)  /* 21.4.2 */
#define IWDG_RLR STM32_REGISTER(IWDG_BASE + 0x08U) /* 21.4.3 */
#define IWDG_SR STM32_REGISTER(IWDG_BASE + 0x0CU)  /* 21.4.4 */
#define IWDG_SR_PVU (1U << 0)
#define IWDG_SR_RVU (1U << 1)

/* Interrupts: numbers, RM0090 12.1.3; controller, PM0214 4.3 */
#define EXTI0_IRQ 6U
#define EXTI4_IRQ 10U
#define EXTI9_5_IRQ 23U
#define TIM2_IRQ 28U
#define USART1_IRQ 37U
#define USART2_IRQ 38U
#define USART3_IRQ 39U
#define EXTI15_10_IRQ 40U
#define TIM5_IRQ 50U
#define NVIC_BASE 0xE000E000U
#define NVIC_ISER(n) STM32_REGISTER(NVIC_BASE + 0x100U + 4U * (n)) /* 4.3.2 */
#define NVIC_ICER(n) STM32_REGISTER(NVIC_BASE + 0x180U + 4U * (n)) /* 4.3.3 */
#define NVIC_ISPR(n) STM32_REGISTER(NVIC_BASE + 0x200U + 4U * (n)) /* 4.3.4 */
#define NVIC_ICPR(n) STM32_REGISTER(NVIC_BASE + 0x280U + 4U * (n)) /* 4.3.5 */
#define NVIC_IPR(n) STM32_REGISTER(NVIC_BASE + 0x400U + 4U * (n))  /* 4.3.7 */

/* SysTick, PM0214 4.5 */
#define STK_CTRL STM32_REGISTER(0xE000E010U)
#define STK_LOAD STM32_REGISTER(0xE000E014U)
#define STK_VAL STM32_REGISTER(0xE000E018U)
#define STK_CTRL_ENABLE (1U << 0)
#define STK_CTRL_TICKINT (1U << 1)
#define STK_CTRL_CLKSOURCE (1U << 2)

/* System control block, PM0214 4.4 */
#define SCB_ICSR STM32_REGISTER(0xE000ED04U)
#define SCB_VTOR STM32_REGISTER(0xE000ED08U)
#define SCB_AIRCR STM32_REGISTER(0xE000ED0CU)
#define SCB_SCR STM32_REGISTER(0xE000ED10U)
#define SCB_SHPR3 STM32_REGISTER(0xE000ED20U)
#define SCB_CFSR STM32_REGISTER(0xE000ED28U)
#define SCB_HFSR STM32_REGISTER(0xE000ED2CU)
#define SCB_BFAR STM32_REGISTER(0xE000ED38U)
#define SCB_DEMCR STM32_REGISTER(0xE000EDFCU)
#define SCB_DEMCR_TRCENA (1U << 24)
#define SCB_ICSR_PENDSTCLR (1U << 25)
#define SCB_ICSR_PENDSTSET (1U << 26)
#define SCB_ICSR_PENDSVCLR (1U << 27)
#define SCB_ICSR_PENDSVSET (1U << 28)
#define SCB_AIRCR_RESET 0x05FA0004U
#define SCB_AIRCR_NO_GROUPS 0x05FA0000U /* PRIGROUP 0: all bits of a priority tell who interrupts whom */

/* Counter of cycles, ARMv7-M C1.8 */
#define DWT_CTRL STM32_REGISTER(0xE0001000U)
#define DWT_CYCCNT STM32_REGISTER(0xE0001004U)
#define DWT_CTRL_CYCCNTENA (1U << 0)

#endif

/*
 * What the boot loader of the part leaves behind when it starts a program without a reset (--left-by-loader). ST's
 * AN2606 tells what it uses (HSI or HSE, the PLL, a USART or USB, SysTick, I2C at open drain, the most prescaler of a
 * watchdog that stands), not in which state it leaves; several projects report clocks and interrupts left on. So all of
 * it is left on here. The groups of priorities are those to which the driver of USB in ST's library sets them
 * (USB_OTG_BSP_EnableInterrupt: one bit of group), which loaders of boards have from there; nothing sets them back but
 * a reset (PM0214 4.4.5), and a program is started by a jump (AN3156).
 *
 * A loader with a system of tasks jumps from one of them: with the process stack in use, after floating-point
 * instructions, with interrupts masked in all three ways and the MPU on, by which nothing in SRAM is executed. Projects
 * report the stack (ArduPilot 14023), BASEPRI (MCUboot 1089) and the MPU (MCUboot 1635). And it may have slept deeply.
 */
#ifndef LOADER_H
#define LOADER_H

#include "core.h"
#include "flash.h"
#include "gpio.h"
#include "iwdg.h"
#include "rcc.h"

/* After a reset of the power: clocks, interrupts, flash, vectors and pins as a loader has them. */
void loader_leave(struct core *core, struct rcc *rcc, struct flash *flash, struct gpio *gpio, struct iwdg *iwdg);

#endif

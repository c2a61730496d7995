/*
 * What the boot loader of the part leaves behind when it starts a program without a reset (--left-by-loader). ST's
 * AN2606 tells what it uses (HSI or HSE, the PLL, a USART or USB, SysTick), not in which state it leaves; several
 * projects report clocks and interrupts left on. So all of it is left on here.
 */
#ifndef LOADER_H
#define LOADER_H

#include "core.h"
#include "flash.h"
#include "rcc.h"

/* After a reset of the power: clocks, interrupts, flash and vectors as a loader has them. */
void loader_leave(struct core *core, struct rcc *rcc, struct flash *flash);

#endif

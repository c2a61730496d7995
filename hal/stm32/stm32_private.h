/*
 * What the files of this backend share. Who runs where:
 *
 *   priority 0  TIM2     stm32_step.c   masked only with all interrupts (PRIMASK), for less than 2 us; for some 30 us
 *                                       where pulses are taken back and others laid
 *   priority 1  USART    stm32_line_half.c or stm32_line_full.c
 *   priority 2  SysTick  stm32_tick.c   held off by main through BASEPRI, for less than 2 us
 *               EXTI     stm32_tick.c   likewise
 *   priority 3  PendSV   stm32_tick.c   held off by main through BASEPRI, while it plans
 *
 * All of them, what they call and what they read lie in RAM (stm32f405.ld): the flash does not answer while it is being
 * written or erased. So do the fault handlers.
 */
#ifndef STM32_PRIVATE_H
#define STM32_PRIVATE_H

#include <stdbool.h>
#include <stdint.h>

#include "base_limits.h"
#include "hal_run.h"

enum {
    STM32_PRIORITY_STEP = 0,
    STM32_PRIORITY_LINE = 1,
    STM32_PRIORITY_TICK = 2,
    STM32_PRIORITY_PLAN = 3
};

/* Masks all interrupts; returns what stm32_unmask restores. */
static inline uint32_t stm32_mask(void)
{
    uint32_t before;
    __asm__ volatile("mrs %0, primask\n\tcpsid i" : "=r"(before)::"memory");
    return before;
}

static inline void stm32_unmask(uint32_t before)
{
    __asm__ volatile("msr primask, %0" ::"r"(before) : "memory");
}

static inline void stm32_barrier(void)
{
    __asm__ volatile("dsb\n\tisb" ::: "memory");
}

/* A clock enable of RCC, and the time until what it is for takes an access: one that comes sooner is lost (errata
 * ES0182, "delay after an RCC peripheral clock enabling"; a read-back alone was found to be too short). */
static inline void stm32_enable_clock(volatile uint32_t *enables, uint32_t bits)
{
    *enables |= bits;
    (void)*enables;
    (void)*enables;
    stm32_barrier();
}

/* stm32_clock.c. From any state, as a boot loader may have left another one. Called before there are variables and code
 * in RAM. */
struct stm32_clock {
    uint32_t core_hz;
    uint32_t apb1_hz;
    uint32_t apb2_hz;
    bool crystal;
};
struct stm32_clock stm32_clock_start(void);

/* stm32_board.c. Set at the start. */
extern struct stm32_clock stm32_board_clock;

/* stm32_driver.c. Off, before the start, too; every millisecond: off where no motor has moved for long. */
void stm32_driver_disable(void);
void stm32_driver_tick(void);

/* stm32_pins.c. Full duplex, the start leaves out the pin of the transmitter, which is low where that is off: it comes
 * when the line has started. Safe: outputs and motor drivers off, the bus let go; before the start, too. */
void stm32_pins_start(void);
void stm32_pins_start_sender(void);
void stm32_pins_make_safe(void);

/* stm32_pwm.c. The output is 0 from the start on; safe, before the start, too. */
void stm32_pwm_start(const struct stm32_clock *clock);
void stm32_pwm_make_safe(void);

/* stm32_io.c. All LEDs blinking together say that there is no crystal. */
uint8_t stm32_io_node(void);
void stm32_io_blink(bool on);

/* stm32_step.c */
void stm32_step_start(bool may_move);
void stm32_step_set_client(const struct hal_client *client);
void stm32_step_make_safe(void);
/* What the step interrupt has to do is more than 5 ms overdue: it does not run. */
bool stm32_step_is_stuck(void);
/* Nothing is laid, for any motor. */
bool stm32_step_is_quiet(void);
/* Pulses that were made later than asked for. */
extern uint32_t stm32_late_steps;
void stm32_step_interrupt(void);

/* stm32_tick.c. An event is what main has to look at; it ends a sleep. */
void stm32_tick_start(const struct hal_client *client, uint32_t core_hz, bool crystal);
void stm32_tick_interrupt(void);
void stm32_edge_interrupt(void);
/* Set while the unit looks at its inputs, which may stop motors, one after the other. */
extern volatile bool stm32_looking;
void stm32_plan_interrupt(void);
extern volatile bool stm32_event;
bool stm32_event_take(void);
void stm32_event_sleep(void);
/* An event comes in so many ticks, up to a millisecond. */
void stm32_event_alarm(uint32_t ticks);

/* stm32_edge.c: edges at the inputs. The interrupt of an input, from 0; the start; all edges held off until they are
 * let through again, in the interrupts of the tick and of edges only. */
uint32_t stm32_edge_irq(unsigned input);
void stm32_edge_start(void);
void stm32_edge_hold(void);
void stm32_edge_let_through(void);

/* stm32_line_half.c or stm32_line_full.c */
void stm32_line_start(const struct stm32_clock *clock);
void stm32_line_interrupt(void);
/* Every millisecond. Half duplex: lets the bus go when a transmission does not come to its end; full duplex: fetches
 * what has come. */
void stm32_line_tick(void);
/* Main has nothing to do. Half duplex: lets the bus go where the transmitter raises no interrupt (an emulator). */
void stm32_line_look(void);
/* Main is to look at the line so many ticks after its last look at the latest; UINT32_MAX: what comes wakes it. */
uint32_t stm32_line_look_ticks(void);

/* stm32_supply.c. After the step timer, before the watchdog. Watches the supply; takes 0.25 ms. */
void stm32_supply_start(void);

/* stm32_part.c, stm32_flash.c. The start takes the size of the part's flash, and locks what a boot loader left open. */
extern const uint32_t stm32_part_flash_kb_at;
void stm32_flash_start(uint32_t part_kb);

/* stm32_watchdog.c */
void stm32_watchdog_start(void);
void stm32_watchdog_main_lives(void);
/* Feeds the watchdog if main and the step interrupt live. Every millisecond. */
void stm32_watchdog_tick(void);

/* stm32_fault.c: the handler of every fault and of every interrupt that should not be, and what it keeps in memory that
 * only the loss of power clears. */
struct stm32_fault {
    uint32_t magic;
    uint32_t cause;     /* enum hal_board_cause */
    uint32_t exception; /* number of the exception, PM0214 2.3.2; 0 for an assertion */
    uint32_t status;    /* CFSR */
    uint32_t hard;      /* HFSR */
    uint32_t address;   /* BFAR */
    uint32_t pc;        /* of the instruction that was interrupted; 0 if the stack could not be read */
    uint32_t count;     /* faults since power-on */
};
enum {
    STM32_FAULT_MAGIC = 0x46415554
};
extern struct stm32_fault stm32_fault_record;
void stm32_fault_entry(void);
/* The step output has failed: a stream has stopped by itself, or a pulse has not been made. */
_Noreturn void stm32_fault_stop_output(void);
_Noreturn void stm32_fault_stop(const uint32_t *frame, uint32_t exception);

#endif

#include "base_limits.h"
#include "board.h"
#include "bringup.h"
#include "stm32_line.h"
#include "stm32_private.h"
#include "stm32f4.h"
#ifdef BOARD_STEP_CLASS
#include "stm32_gpio_private.h"
#endif

/* The vector table in RAM. */
extern uint32_t stm32_vectors[];

enum {
    EXCEPTIONS = 16,
    PENDSV = 14,
    SYSTICK = 15,
};

enum timed {
    TIMED_STEP,
    TIMED_LINE,
    TIMED_TICK,
    TIMED_EDGE,
    TIMED_PLAN,
    TIMED_REFILL, /* of steps of class 2 */
    TIMED
};

static const char *const names[TIMED] = {"step", "line", "tick", "edge", "plan", "refill"};

/* Each entry is written by its own interrupt only. */
static struct {
    volatile uint32_t count;
    volatile uint32_t longest;
} timed[TIMED];

/* The cycles of the handler, with those of interrupts that came between; without the entry and the return, which the
 * counter cannot see. */
static inline void note(enum timed which, uint32_t cycles)
{
    timed[which].count++;
    if (cycles > timed[which].longest) {
        timed[which].longest = cycles;
    }
}

static void time_step(void)
{
    uint32_t begin = DWT_CYCCNT;
    stm32_step_interrupt();
    note(TIMED_STEP, DWT_CYCCNT - begin);
}

static void time_line(void)
{
    uint32_t begin = DWT_CYCCNT;
    stm32_line_interrupt();
    note(TIMED_LINE, DWT_CYCCNT - begin);
}

static void time_tick(void)
{
    uint32_t begin = DWT_CYCCNT;
    stm32_tick_interrupt();
    note(TIMED_TICK, DWT_CYCCNT - begin);
}

static void time_edge(void)
{
    uint32_t begin = DWT_CYCCNT;
    stm32_edge_interrupt();
    note(TIMED_EDGE, DWT_CYCCNT - begin);
}

static void time_plan(void)
{
    uint32_t begin = DWT_CYCCNT;
    stm32_plan_interrupt();
    note(TIMED_PLAN, DWT_CYCCNT - begin);
}

#ifdef BOARD_STEP_CLASS
static void time_refill(void)
{
    uint32_t begin = DWT_CYCCNT;
    stm32_step_refill_interrupt();
    note(TIMED_REFILL, DWT_CYCCNT - begin);
}
#endif

static void set_vector(uint32_t number, void (*handler)(void))
{
    stm32_vectors[number] = (uint32_t)(uintptr_t)handler;
}

void bringup_cycles_start(void)
{
    SCB_DEMCR |= SCB_DEMCR_TRCENA;
    DWT_CYCCNT = 0;
    DWT_CTRL |= DWT_CTRL_CYCCNTENA;
    uint32_t mask = stm32_mask();
    set_vector(PENDSV, time_plan);
    set_vector(SYSTICK, time_tick);
    for (unsigned input = 0; input < UNIT_INPUTS; input++) {
        set_vector(EXCEPTIONS + stm32_edge_irq(input), time_edge);
    }
    set_vector(EXCEPTIONS + TIM2_IRQ, time_step);
#ifdef BOARD_STEP_CLASS
    set_vector(EXCEPTIONS + REFILL_IRQ, time_refill);
#endif
    set_vector(EXCEPTIONS + STM32_LINE_IRQ, time_line);
    stm32_barrier();
    stm32_unmask(mask);
}

void bringup_cycles_tell(void)
{
    hal_run_plan();
    for (unsigned i = 0; i < TIMED; i++) {
        say_name("cycles");
        say_word(names[i]);
        say_decimal(timed[i].count);
        say_decimal(timed[i].longest);
        say_line_end();
    }
}

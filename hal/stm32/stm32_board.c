#include "hal_board.h"

#include "base_tick.h"
#include "hal_line.h"
#include "hal_run.h"
#include "hal_time.h"
#include "stm32_line.h"
#include "stm32_private.h"
#include "stm32f4.h"

enum {
    IRQS_A_WORD = 32,
    PRIORITIES_A_WORD = 4,
    PRIORITY_SHIFT = 4
};

struct stm32_clock stm32_board_clock;
static enum hal_board_cause start_cause;

static void enable_interrupt(uint32_t irq, uint32_t priority)
{
    uint32_t place = irq % PRIORITIES_A_WORD * 8U;
    uint32_t others = NVIC_IPR(irq / PRIORITIES_A_WORD) & ~(0xFFU << place);
    NVIC_IPR(irq / PRIORITIES_A_WORD) = others | priority << (place + PRIORITY_SHIFT);
    NVIC_ISER(irq / IRQS_A_WORD) = UINT32_C(1) << (irq % IRQS_A_WORD);
}

/* The record outlives every reset but that of the power, and keeps the flags of the chip, which can be read once. Where
 * a boot loader has used its memory, the flags alone tell: of what resets by software the handler of faults is the one
 * to be expected; a debugger is taken for it. */
static enum hal_board_cause find_cause(void)
{
    uint32_t flags = RCC_CSR;
    RCC_CSR |= RCC_CSR_RMVF;
    bool power = (flags & (RCC_CSR_PORRSTF | RCC_CSR_BORRSTF)) != 0;
    if (power || stm32_fault_record.magic != STM32_FAULT_MAGIC) {
        stm32_fault_record = (struct stm32_fault){.magic = STM32_FAULT_MAGIC, .cause = HAL_BOARD_CAUSE_RESET};
        if (power || (flags & (RCC_CSR_SFTRSTF | RCC_CSR_IWDGRSTF)) == 0) {
            return HAL_BOARD_CAUSE_POWER;
        }
        stm32_fault_record.cause = HAL_BOARD_CAUSE_FAULT;
    }
    if ((flags & RCC_CSR_IWDGRSTF) != 0) {
        stm32_fault_record.cause = HAL_BOARD_CAUSE_WATCHDOG;
    }
    return (enum hal_board_cause)stm32_fault_record.cause;
}

void hal_board_init(void)
{
    start_cause = find_cause();
    stm32_step_start(stm32_board_clock.crystal);
    stm32_pwm_start(&stm32_board_clock);
    stm32_pins_start();
    stm32_supply_start();
    stm32_flash_start(*(const volatile uint16_t *)(uintptr_t)stm32_part_flash_kb_at);
    stm32_line_start(&stm32_board_clock);
    enable_interrupt(STM32_LINE_IRQ, STM32_PRIORITY_LINE);
    stm32_watchdog_start();
}

void hal_run_start(const struct hal_client *client)
{
    stm32_step_set_client(client);
    enable_interrupt(TIM2_IRQ, STM32_PRIORITY_STEP);
    stm32_tick_start(client, stm32_board_clock.core_hz, stm32_board_clock.crystal);
    stm32_edge_start();
    for (unsigned input = 0; input < UNIT_INPUTS; input++) {
        enable_interrupt(stm32_edge_irq(input), STM32_PRIORITY_TICK);
    }
}

enum hal_board_cause hal_board_start_cause(void)
{
    return start_cause;
}

bool hal_board_may_move(void)
{
    return stm32_board_clock.crystal;
}

bool hal_board_may_start_programs(void)
{
    return start_cause != HAL_BOARD_CAUSE_WATCHDOG && start_cause != HAL_BOARD_CAUSE_FAULT;
}

uint32_t hal_board_late_steps(void)
{
    return stm32_late_steps;
}

void hal_board_idle(uint64_t wake_tick)
{
    uint64_t look_tick = hal_time_now() + stm32_line_look_ticks();
    uint64_t end_tick = wake_tick < look_tick ? wake_tick : look_tick;
    stm32_watchdog_main_lives();
    stm32_line_look();
    while (!stm32_event_take()) {
        uint64_t now = hal_time_now();
        if (now >= end_tick) {
            break;
        }
        if (end_tick - now < TICKS_PER_MS) {
            stm32_event_alarm((uint32_t)(end_tick - now));
        }
        stm32_event_sleep();
    }
}

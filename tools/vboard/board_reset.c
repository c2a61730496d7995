/*
 * Resets, of the part and of single peripherals, and clocks that change or stop: what one model starts and others take
 * part in.
 */
#include "board.h"
#include "loader.h"

static void reset_processor(struct board *board)
{
    enum {
        WORD_BYTES = 4
    };
    struct cpu *cpu = &board->cpu;
    uint32_t sp = 0;
    uint32_t start = 0;
    cpu_clear(cpu);
    if (!memory_read_word(&board->memory, 0, &sp) || !memory_read_word(&board->memory, WORD_BYTES, &start) ||
        (start & 1U) == 0) {
        report_fail(&board->report, "the reset vector is %08x, which is no address of code", (unsigned)start);
    }
    cpu_start(cpu, sp & ~UINT32_C(3), start & ~UINT32_C(1));
    clock_poke(&board->clock);
}

static void reset_peripherals(struct board *board, enum reset_cause cause)
{
    iwdg_reset(&board->iwdg);
    flash_reset(&board->flash);
    for (unsigned i = 0; i < TIMERS; i++) {
        timer_reset(&board->timer[i]);
    }
    for (unsigned i = 0; i < USARTS; i++) {
        usart_reset(&board->usart[i]);
    }
    for (unsigned i = 0; i < DMA_CONTROLLERS; i++) {
        dma_reset(&board->dma[i]);
    }
    adc_reset(&board->adc);
    syscfg_reset(&board->syscfg);
    supply_reset(&board->supply);
    exti_reset(&board->exti);
    gpio_reset(&board->gpio);
    rcc_reset(&board->rcc, cause);
}

void board_reset(struct board *board, enum reset_cause cause)
{
    board->reset.wanted = RESET_NONE;
    board->reset_ps = clock_now_ps(&board->clock);
    board->reset_steps = recorder_active(&board->recorder, SIGNAL_STEP, PINS_MOTORS);
    board->reset_outputs = recorder_active(&board->recorder, SIGNAL_OUTPUT, PINS_OUTPUTS);
    if (cause == RESET_POWER || board->options->loader_uses_ram) {
        memory_forget(&board->memory);
    }
    board->resets[cause]++;
    board->stats.depth = 0;
    board->cpu.stalled_forever = board->supply.held;
    faults_reset(&board->faults);
    bus_reset(&board->bus);
    nvic_reset(&board->nvic);
    scb_reset(&board->scb);
    core_reset(&board->core);
    reset_peripherals(board, cause);
    art_reset(&board->fetch.art);
    reset_processor(board);
    if (cause == RESET_POWER && board->options->left_by_loader) {
        loader_leave(&board->core, &board->rcc, &board->flash, &board->gpio, &board->iwdg);
    }
}

static void reset_on_ahb1(struct board *board, unsigned bit)
{
    enum {
        DMA1 = 21,
        DMA2 = 22
    };
    if (bit < GPIO_PORTS) {
        gpio_reset_port(&board->gpio.port[bit]);
    } else if (bit == DMA1 || bit == DMA2) {
        dma_reset(&board->dma[bit - DMA1]);
    }
}

static void reset_on_apb1(struct board *board, unsigned bit)
{
    if (bit < TIMERS_ON_APB1) {
        timer_reset(&board->timer[bit]);
    } else if (bit == 17 || bit == 18) {
        usart_reset(&board->usart[bit - 16U]);
    } else if (bit == 28) {
        supply_reset(&board->supply);
    }
}

static void reset_on_apb2(struct board *board, unsigned bit)
{
    if (bit == 0) {
        timer_reset(&board->timer[TIMER_TIM1]);
    } else if (bit == 4) {
        usart_reset(&board->usart[0]);
    } else if (bit == 8) { /* all three converters */
        adc_reset(&board->adc);
    } else if (bit == 14) {
        syscfg_reset(&board->syscfg);
    }
}

static void reset_peripheral(struct board *board, uint32_t offset, unsigned bit)
{
    enum {
        AHB1 = 0x10,
        APB1 = 0x20,
        APB2 = 0x24
    };
    if (offset == AHB1) {
        reset_on_ahb1(board, bit);
    } else if (offset == APB1) {
        reset_on_apb1(board, bit);
    } else if (offset == APB2) {
        reset_on_apb2(board, bit);
    }
}

static void on_reset_bits(void *model, uint32_t offset, uint32_t bits)
{
    for (unsigned i = 0; i < 32; i++) {
        if ((bits >> i & 1U) != 0) {
            reset_peripheral(model, offset, i);
        }
    }
}

static void on_hold(void *model)
{
    struct board *board = model;
    for (unsigned i = 0; i < TIMERS; i++) {
        timer_hold(&board->timer[i]);
    }
}

static void on_release(void *model)
{
    struct board *board = model;
    for (unsigned i = 0; i < TIMERS; i++) {
        timer_release(&board->timer[i]);
    }
}

static void on_stop(void *model)
{
    static const enum event clocked[] = {EVENT_TIM2,    EVENT_TIM3,   EVENT_TIM4,   EVENT_TIM5,
                                         EVENT_SYSTICK, EVENT_USART1, EVENT_USART2, EVENT_USART3,
                                         EVENT_DMA1,    EVENT_DMA2,   EVENT_BUS,    EVENT_TIM1};
    struct board *board = model;
    for (unsigned i = 0; i < sizeof clocked / sizeof *clocked; i++) {
        clock_set(&board->clock, clocked[i], VTIME_NEVER);
    }
    board->cpu.stalled_forever = true;
    if (!board->iwdg.started) {
        report_fail(&board->report,
                    "the crystal has stopped and with it the processor; no watchdog runs that would reset it");
    }
}

struct rcc_outlet board_clock_outlet(struct board *board)
{
    return (struct rcc_outlet){
        .board = board, .hold = on_hold, .release = on_release, .stop = on_stop, .reset = on_reset_bits};
}

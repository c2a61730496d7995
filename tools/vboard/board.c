#include "board.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "complain.h"

uint64_t board_now_ps(const struct board *board)
{
    return vtime_ps_of_cycle(&board->time, board->cpu.now);
}

void board_finish(struct board *board, enum board_end end, const char *text)
{
    if (board->end == BOARD_RUNS) {
        board->end = end;
        (void)snprintf(board->text, sizeof board->text, "%s", text);
    }
    cpu_poke(&board->cpu);
}

/* Time, place and function of what the processor does. */
static void put_place(const struct board *board, char *text, size_t bytes)
{
    uint64_t ns = board_now_ps(board) / VTIME_PS_PER_NS;
    (void)snprintf(text, bytes, " (pc %08x in %s, at %u.%06u ms)", (unsigned)board->cpu.at,
                   image_function_at(&board->image, board->cpu.at), (unsigned)(ns / 1000000U),
                   (unsigned)(ns % 1000000U));
}

static void put_message(const struct board *board, char text[BOARD_TEXT_BYTES_MAX], const char *format,
                        va_list arguments) __attribute__((format(printf, 3, 0)));

static void put_message(const struct board *board, char text[BOARD_TEXT_BYTES_MAX], const char *format,
                        va_list arguments)
{
    (void)vsnprintf(text, BOARD_TEXT_BYTES_MAX, format, arguments);
    size_t length = strlen(text);
    put_place(board, text + length, BOARD_TEXT_BYTES_MAX - length);
}

void board_fail(struct board *board, const char *format, ...)
{
    char text[BOARD_TEXT_BYTES_MAX];
    va_list arguments;
    if (board->end != BOARD_RUNS) {
        return;
    }
    va_start(arguments, format);
    put_message(board, text, format, arguments);
    va_end(arguments);
    complain("%s", text);
    board_finish(board, BOARD_FAILED, text);
}

void board_warn(struct board *board, const char *format, ...)
{
    char text[BOARD_TEXT_BYTES_MAX];
    va_list arguments;
    if (board->warnings++ >= BOARD_WARNINGS_SHOWN) {
        return;
    }
    va_start(arguments, format);
    put_message(board, text, format, arguments);
    va_end(arguments);
    complain("warning: %s", text);
}

void board_request_reset(struct board *board, enum reset_cause cause)
{
    if (board->wanted_reset == RESET_NONE || cause == RESET_HELD) {
        board->wanted_reset = cause;
    }
    cpu_poke(&board->cpu);
}

void board_reset(struct board *board, enum reset_cause cause)
{
    board->wanted_reset = RESET_NONE;
    board->reset_ps = board_now_ps(board);
    board->reset_steps = recorder_active(board, SIGNAL_STEP, PINS_MOTORS);
    board->reset_outputs = recorder_active(board, SIGNAL_OUTPUT, PINS_OUTPUTS);
    if (cause == RESET_POWER) {
        memory_forget(&board->memory);
    }
    board->resets[cause]++;
    board->stats.depth = 0;
    board->cpu.stalled_forever = board->supply.held;
    faults_reset(board);
    bus_reset(board);
    nvic_reset(board);
    scb_reset(board);
    core_reset(board);
    iwdg_reset(board);
    flash_reset(board);
    timers_reset(board);
    usarts_reset(board);
    plain_reset(board);
    supply_reset(board);
    exti_reset(board);
    gpio_reset(board);
    rcc_reset(board, cause);
    art_reset(&board->cpu.art);
    if (!board->cpu.wait_states_fixed) {
        board->cpu.wait_states = 0;
    }
    cpu_reset(board);
    if (cause == RESET_POWER && board->options->left_by_loader) {
        loader_leave(board);
    }
}

static void reset_peripheral(struct board *board, uint32_t offset, unsigned bit)
{
    enum {
        AHB1 = 0x10,
        APB1 = 0x20,
        APB2 = 0x24
    };
    if (offset == AHB1 && bit < GPIO_PORTS) {
        gpio_reset_port(board, bit);
    } else if (offset == APB1 && bit < TIMERS) {
        timer_reset(board, bit);
    } else if (offset == APB1 && (bit == 17 || bit == 18)) {
        usart_reset(board, bit - 16U);
    } else if (offset == APB2 && bit == 4) {
        usart_reset(board, 0);
    }
}

void board_reset_peripherals(struct board *board, uint32_t offset, uint32_t bits)
{
    for (unsigned i = 0; i < 32; i++) {
        if ((bits >> i & 1U) != 0) {
            reset_peripheral(board, offset, i);
        }
    }
}

void board_lock_up(struct board *board)
{
    board->lockups++;
    board->cpu.stalled_forever = true;
    if (!board->iwdg.started) {
        board_fail(board, "lockup: a fault inside HardFault, and no watchdog that would reset; CFSR %08x, HFSR %08x",
                   (unsigned)board->scb.cfsr, (unsigned)board->scb.hfsr);
    }
}

void board_stop_clock(struct board *board)
{
    static const enum event clocked[] = {EVENT_TIM2,   EVENT_TIM3,   EVENT_TIM4,   EVENT_TIM5, EVENT_SYSTICK,
                                         EVENT_USART1, EVENT_USART2, EVENT_USART3, EVENT_BUS};
    for (unsigned i = 0; i < sizeof clocked / sizeof *clocked; i++) {
        events_set(board, clocked[i], VTIME_NEVER);
    }
    board->cpu.stalled_forever = true;
    if (!board->iwdg.started) {
        board_fail(board, "the crystal has stopped and with it the processor; no watchdog runs that would reset it");
    }
}

void board_sleep(struct board *board)
{
    struct cpu *cpu = &board->cpu;
    events_run(board, cpu->now);
    while (!nvic_can_wake(board) && !board_wants_stop(board)) {
        uint64_t next = board->events.next;
        if (next > cpu->now) {
            cpu->asleep_cycles += next - cpu->now;
            cpu->now = next;
        }
        events_run(board, cpu->now);
    }
}

void board_measure_event(struct board *board, uint64_t cycle)
{
    (void)cycle;
    stats_reset(board);
    profile_reset(board);
}

void board_end_event(struct board *board, uint64_t cycle)
{
    (void)cycle;
    board_finish(board, BOARD_TIME, "");
}

static bool find_end(struct board *board)
{
    uint32_t address = 0;
    uint32_t bytes = 0;
    if (board->options->end_at == NULL) {
        return true;
    }
    if (!image_find_symbol(&board->image, board->options->end_at, &address, &bytes)) {
        complain("--end-at %s: the program has no such symbol", board->options->end_at);
        return false;
    }
    board->cpu.cost.end_address = address & ~UINT32_C(1);
    return true;
}

static bool set_constants(struct board *board)
{
    bool good = true;
    for (unsigned i = 0; good && i < board->options->sets; i++) {
        good = image_set(board, board->options->set[i]);
    }
    return good;
}

static void set_cycle_model(struct board *board)
{
    const struct options *options = board->options;
    board->cpu.refill = options->refill;
    board->cpu.art_modelled = options->art;
    board->cpu.wait_states_fixed = options->wait_states >= 0;
    board->cpu.wait_states = options->wait_states >= 0 ? (uint32_t)options->wait_states : 0;
    board->bus.apb_wait = options->apb_wait;
}

static bool open_files(struct board *board)
{
    const struct options *options = board->options;
    return pins_read(&board->pins, options->pins) && recorder_open(board) && inputs_open(board) && rs485_open(board) &&
           tty_open(board) && profile_open(board, options->profile) && faults_open(board) && supply_open(board);
}

/* What is wired to the part, before power comes. */
static bool connect(struct board *board)
{
    const struct options *options = board->options;
    if (!open_files(board)) {
        return false;
    }
    for (unsigned i = 0; i < options->stucks; i++) {
        gpio_set_stuck(board, options->stuck[i].pin, options->stuck[i].level);
    }
    events_set_ps(board, EVENT_END, options->for_ps);
    if (options->crystal_stops_ps != VTIME_NEVER) {
        events_set_ps(board, EVENT_CRYSTAL, options->crystal_stops_ps);
    }
    if (options->measure_from_ps > 0) {
        events_set_ps(board, EVENT_MEASURE, options->measure_from_ps);
    }
    return true;
}

bool board_init(struct board *board, const struct options *options)
{
    memset(board, 0, sizeof *board);
    board->options = options;
    events_init(&board->events);
    board->flash.options = options->option_bytes;
    vtime_set_hclk(&board->time, 0, 1000000); /* until the reset sets it, at cycle 0 */
    if (!cpu_init(board) || !memory_init(board) || !bus_init(board)) {
        complain("the emulator cannot be set up; is there memory enough?");
        return false;
    }
    set_cycle_model(board);
    if (!flash_load(board, options->flash) || !image_load(board, options->elf) || !set_constants(board) ||
        !find_end(board) || !connect(board)) {
        return false;
    }
    board_reset(board, board->supply.held ? RESET_HELD : RESET_POWER);
    return true;
}

bool board_close(struct board *board)
{
    bool good = recorder_close(board);
    good = rs485_close(board) && good;
    good = profile_close(board) && good;
    return flash_save(board, board->options->flash) && good;
}

void board_discard(struct board *board)
{
    tty_close(board);
    inputs_close(board);
    recorder_discard(board);
    rs485_discard(board);
    profile_discard(board);
    image_discard(&board->image);
    cpu_discard(&board->cpu);
    memory_discard(&board->memory);
}

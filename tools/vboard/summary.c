#include "summary.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "board.h"

static void put_string(const char *text)
{
    (void)putchar('"');
    for (; *text != '\0'; text++) {
        unsigned char byte = (unsigned char)*text;
        if (byte < 0x20 || byte >= 0x7F || byte == '"' || byte == '\\') {
            (void)printf("\\u%04x", (unsigned)byte);
        } else {
            (void)putchar(byte);
        }
    }
    (void)putchar('"');
}

static void put_number(const char *name, uint64_t value)
{
    (void)printf("\"%s\":%" PRIu64 ",", name, value);
}

/* A time in picoseconds as whole microseconds with decimals, or null where there was none. */
static void put_us(const char *name, uint64_t ps)
{
    if (ps == VTIME_NEVER) {
        (void)printf("\"%s\":null,", name);
    } else {
        (void)printf("\"%s\":%" PRIu64 ".%06u,", name, ps / VTIME_PS_PER_US, (unsigned)(ps % VTIME_PS_PER_US));
    }
}

static void put_ratio(const char *name, uint64_t part, uint64_t whole)
{
    uint64_t millionths = whole == 0 ? 0 : vtime_scale(part, 1000000, whole);
    (void)printf("\"%s\":%" PRIu64 ".%06u,", name, millionths / 1000000U, (unsigned)(millionths % 1000000U));
}

static const char *stream_name(unsigned exception)
{
    static const char *const names[] = {"DMA1_Stream0", "DMA1_Stream1", "DMA1_Stream2", "DMA1_Stream3",
                                        "DMA1_Stream4", "DMA1_Stream5", "DMA1_Stream6"};
    unsigned stream = exception - (NVIC_IRQ0 + NVIC_IRQ_DMA1_STREAM0);
    return stream < sizeof names / sizeof *names ? names[stream] : "";
}

static const char *exception_name(unsigned exception)
{
    switch (exception) {
    case NVIC_NMI:
        return "NMI";
    case NVIC_HARD_FAULT:
        return "HardFault";
    case NVIC_MEM_MANAGE:
        return "MemManage";
    case NVIC_BUS_FAULT:
        return "BusFault";
    case NVIC_USAGE_FAULT:
        return "UsageFault";
    case NVIC_SVC:
        return "SVC";
    case NVIC_PENDSV:
        return "PendSV";
    case NVIC_SYSTICK:
        return "SysTick";
    case NVIC_IRQ0 + NVIC_IRQ_FLASH:
        return "FLASH";
    case NVIC_IRQ0 + NVIC_IRQ_RCC:
        return "RCC";
    case NVIC_IRQ0 + NVIC_IRQ_EXTI0:
        return "EXTI0";
    case NVIC_IRQ0 + NVIC_IRQ_EXTI1:
        return "EXTI1";
    case NVIC_IRQ0 + NVIC_IRQ_EXTI2:
        return "EXTI2";
    case NVIC_IRQ0 + NVIC_IRQ_EXTI3:
        return "EXTI3";
    case NVIC_IRQ0 + NVIC_IRQ_EXTI4:
        return "EXTI4";
    case NVIC_IRQ0 + NVIC_IRQ_EXTI9_5:
        return "EXTI9_5";
    case NVIC_IRQ0 + NVIC_IRQ_TIM2:
        return "TIM2";
    case NVIC_IRQ0 + NVIC_IRQ_TIM3:
        return "TIM3";
    case NVIC_IRQ0 + NVIC_IRQ_TIM4:
        return "TIM4";
    case NVIC_IRQ0 + NVIC_IRQ_TIM5:
        return "TIM5";
    case NVIC_IRQ0 + NVIC_IRQ_USART1:
        return "USART1";
    case NVIC_IRQ0 + NVIC_IRQ_USART2:
        return "USART2";
    case NVIC_IRQ0 + NVIC_IRQ_USART3:
        return "USART3";
    case NVIC_IRQ0 + NVIC_IRQ_EXTI15_10:
        return "EXTI15_10";
    case NVIC_IRQ0 + NVIC_IRQ_DMA1_STREAM7:
        return "DMA1_Stream7";
    default:
        return stream_name(exception);
    }
}

static void print_run(const struct board *board)
{
    static const char *const ends[] = {"", "time", "reached", "power_cut", "error"};
    const struct clock *clock = &board->clock;
    const struct cpu *cpu = &board->cpu;
    const struct stats *stats = &board->stats;
    uint64_t cycles = clock->now - stats->since_cycle;
    uint64_t asleep = clock->asleep_cycles - stats->since_asleep;
    (void)printf("\"ended\":\"%s\",\"error\":", ends[board->report.end]);
    put_string(board->report.text);
    (void)putchar(',');
    put_us("microseconds", clock_now_ps(&board->clock));
    put_number("hclk_hz", board->clock.time.hclk_hz);
    (void)printf("\"model\":{\"refill\":%u,\"wait_states\":%u,\"apb_wait\":%u,\"art\":%s},", (unsigned)cpu->refill,
                 (unsigned)board->flash.wait_states, (unsigned)board->bus.wires.apb_wait,
                 board->fetch.art_modelled ? "true" : "false");
    put_number("cycles", cycles);
    put_number("asleep_cycles", asleep);
    put_number("stalled_cycles", clock->stalled_cycles - stats->since_stalled);
    put_number("instructions", cpu->instructions - stats->since_instructions);
    put_ratio("load", cycles - asleep, cycles);
    put_us("real_microseconds", board->real_ns * VTIME_PS_PER_NS);
    put_ratio("emulated_mhz", clock->now - clock->asleep_cycles - clock->stalled_cycles, board->real_ns / 1000U);
    (void)printf("\"resets\":{\"power\":%u,\"software\":%u,\"watchdog\":%u},\"lockups\":%u,\"warnings\":%u,",
                 board->resets[RESET_POWER], board->resets[RESET_SOFTWARE], board->resets[RESET_WATCHDOG],
                 board->exceptions.lockups, board->report.warnings);
    (void)printf("\"supply\":{\"mv\":%u,\"least_mv\":%u,\"held\":%s,\"brown_outs\":%u},\"pin_resets\":%u,",
                 (unsigned)board->conditions.supply_mv, (unsigned)board->supply.least_mv,
                 board->supply.held ? "true" : "false", board->supply.brown_outs, board->resets[RESET_PIN]);
    (void)printf("\"last_reset\":{");
    put_us("microseconds", board->reset_ps);
    (void)printf("\"steps\":%u,\"outputs\":%u},", board->reset_steps, board->reset_outputs);
    (void)printf("\"faults\":{\"count\":%" PRIu64 ",\"cfsr\":%u,\"at\":%u,\"in\":", stats->faults,
                 (unsigned)stats->fault_bits, (unsigned)stats->fault_at);
    put_string(stats->faults == 0 ? "" : image_function_at(&board->image, stats->fault_at));
    (void)printf("},\n");
}

static void print_vectors(const struct board *board)
{
    const char *between = "";
    (void)printf("\"tail_chains\":%" PRIu64 ",\"vectors\":[", board->stats.tail_chains);
    for (unsigned i = 0; i < NVIC_EXCEPTIONS; i++) {
        const struct stats_vector *vector = &board->stats.vector[i];
        if (vector->count > 0) {
            (void)printf("%s\n{\"number\":%u,\"name\":\"%s\",", between, i, exception_name(i));
            put_number("count", vector->count);
            put_number("cycles", vector->cycles);
            put_number("min", vector->least);
            put_number("median", stats_median(vector));
            put_number("max", vector->most);
            (void)printf("\"latency_max\":%" PRIu64 "}", vector->latency_most);
            between = ",";
        }
    }
    (void)printf("],\n");
}

/* OSPEEDR (RM0090 8.4.3). */
static unsigned pin_speed(const struct board *board, struct pin pin)
{
    return pin.port < GPIO_PORTS ? board->gpio.port[pin.port].ospeedr >> 2U * pin.number & 3U : 0U;
}

static void print_motors(const struct board *board)
{
    const struct recorder *recorder = &board->recorder;
    put_number("tick_hz", recorder->tick_hz);
    put_us("first_step_microseconds", recorder->first_step_ps);
    (void)printf("\"motors\":[");
    for (unsigned i = 0; i < PINS_MOTORS; i++) {
        const struct recorder_motor *motor = &recorder->motor[i];
        (void)printf("%s\n{\"motor\":%u,", i == 0 ? "" : ",", i + 1U);
        put_number("pulses", motor->pulses);
        put_number("pin_speed", pin_speed(board, board->pins.pin[SIGNAL_STEP + i]));
        put_us("width_min", motor->width_least_ps);
        put_us("gap_min", motor->gap_least_ps);
        put_us("period_min", motor->period_least_ps);
        put_us("dir_setup_min", motor->setup_least_ps);
        put_us("dir_hold_min", motor->hold_least_ps);
        (void)printf("\"step\":%d,\"dir\":%d,\"led\":%d,\"position\":%" PRId64 "}", recorder->level[SIGNAL_STEP + i],
                     recorder->level[SIGNAL_DIRECTION + i], recorder->level[SIGNAL_LED + i], motor->position);
    }
    (void)printf("],\n\"outputs\":%u,", recorder_active(&board->recorder, SIGNAL_OUTPUT, PINS_OUTPUTS));
}

static void print_peripherals(const struct board *board)
{
    const struct rs485 *line = &board->line;
    const struct usart *usart = &board->usart[board->pins.usart];
    (void)printf("\"line\":{");
    put_number("baud", usart_baud(usart));
    put_number("sent", line->sent);
    put_number("unheard", line->unheard);
    put_number("breaks", line->breaks);
    put_number("heard", line->heard);
    put_number("collisions", line->collisions);
    put_number("overruns", usart->overruns);
    put_number("deaf", usart->deaf);
    put_us("release_max", line->release_most_ps);
    (void)printf("\"left\":%zu},\n\"flash\":{", line->bytes - line->next);
    put_number("operations", board->flash.operations);
    put_number("programs", board->flash.programs);
    put_number("erases", board->flash.erases);
    put_number("options", board->flash.options);
    put_number("option_writes", board->flash.option_writes);
    put_number("weakened", board->flash.weakened);
    put_number("acr", board->flash.acr);
    put_number("cr", board->flash.cr);
    put_number("sr", board->flash.sr);
    put_number("optcr", board->flash.optcr);
    (void)printf("\"stalls\":%" PRIu64 "},\n\"watchdog\":{\"started\":%s,", board->flash.stalls,
                 board->iwdg.started ? "true" : "false");
    put_us("longest", board->iwdg.longest_ps);
    (void)printf("\"refreshes\":%" PRIu64 "},\n", board->iwdg.refreshes);
}

/* Of the streams that have carried something, those of DMA2 from 8 on; times from the request to the arrival at the
 * peripheral. */
static void print_dma(const struct board *board)
{
    const char *between = "";
    (void)printf("\"dma\":{\"lost\":%" PRIu64 ",\"streams\":[", board->requests.lost);
    for (unsigned i = 0; i < DMA_CONTROLLERS * DMA_STREAMS; i++) {
        const struct dma_stream *stream = &board->dma[i / DMA_STREAMS].stream[i % DMA_STREAMS];
        if (stream->transfers > 0) {
            (void)printf("%s{\"stream\":%u,\"transfers\":%" PRIu64 ",\"wait_max\":%" PRIu64 "}", between, i,
                         stream->transfers, stream->wait_most);
            between = ",";
        }
    }
    (void)printf("]},\n");
}

/* The lowest address that may be stack: a symbol, or where the data of the program ends below its top. */
static uint32_t stack_limit(const struct board *board, uint32_t top)
{
    uint32_t limit = 0;
    uint32_t bytes = 0;
    if (board->options->stack_limit != NULL &&
        image_find_symbol(&board->image, board->options->stack_limit, &limit, &bytes)) {
        return limit;
    }
    bool in_sram = top - MEMORY_SRAM_BASE <= MEMORY_SRAM_BYTES;
    uint32_t base = in_sram ? MEMORY_SRAM_BASE : MEMORY_CCM_BASE;
    uint32_t end = board->image.ram_end[in_sram ? 0 : 1];
    return end >= base && end < top ? end : base;
}

/* The stack was never deeper than the words at its bottom that are still alike: as they were at power-on, or as the
 * program has painted them. */
static void print_stack(struct board *board)
{
    uint32_t top = 0;
    uint32_t pattern = 0;
    uint32_t word = 0;
    (void)memory_read_word(&board->memory, MEMORY_FLASH_BASE, &top);
    uint32_t limit = (stack_limit(board, top) + 3U) & ~UINT32_C(3);
    uint32_t at = limit;
    (void)memory_read_word(&board->memory, limit, &pattern);
    while (at < top && memory_read_word(&board->memory, at, &word) && word == pattern) {
        at += 4U;
    }
    (void)printf("\"stack\":{\"bytes\":%u,\"used\":%u},\n", (unsigned)(top - limit), (unsigned)(top - at));
}

static uint64_t read_bytes(const uint8_t *bytes, uint32_t length)
{
    uint64_t value = 0;
    for (uint32_t i = length; i > 0; i--) {
        value = value << 8 | bytes[i - 1U];
    }
    return value;
}

/* A variable of 1, 2, 4 or 8 bytes is a number, a larger one a list of words. */
static void print_watch(struct board *board, const char *name)
{
    uint32_t address = 0;
    uint32_t length = 0;
    put_string(name);
    (void)putchar(':');
    bool known = image_find_symbol(&board->image, name, &address, &length);
    const uint8_t *bytes = known ? memory_find(&board->memory, address, length == 0 ? 4 : length) : NULL;
    length = length == 0 ? 4 : length;
    if (bytes == NULL) {
        (void)printf("null");
    } else if (length <= 8) {
        (void)printf("%" PRIu64, read_bytes(bytes, length));
    } else {
        for (uint32_t i = 0; i + 4U <= length; i += 4U) {
            (void)printf("%c%" PRIu64, i == 0 ? '[' : ',', read_bytes(bytes + i, 4));
        }
        (void)putchar(']');
    }
}

void summary_print(struct board *board)
{
    (void)putchar('{');
    print_run(board);
    print_vectors(board);
    print_motors(board);
    print_peripherals(board);
    print_dma(board);
    print_stack(board);
    (void)printf("\"watch\":{");
    for (unsigned i = 0; i < board->options->watches; i++) {
        (void)printf("%s", i == 0 ? "" : ",");
        print_watch(board, board->options->watch[i]);
    }
    (void)printf("}}\n");
}

#include "board.h"

#include <string.h>

#include "complain.h"
#include "timer_capture.h"

#define HZ_BEFORE_RESET 1000000U /* at cycle 0, where the first reset sets another rate */

static void wire_processor(struct board *board)
{
    struct clock *clock = &board->clock;
    struct report *report = &board->report;
    const struct options *options = board->options;
    nvic_init(&board->nvic, (struct nvic_wires){.clock = clock, .cpu = &board->cpu, .report = report});
    scb_init(&board->scb,
             (struct scb_wires){
                 .clock = clock, .cpu = &board->cpu, .nvic = &board->nvic, .report = report, .reset = &board->reset});
    core_init(&board->core,
              (struct core_wires){.clock = clock, .nvic = &board->nvic, .scb = &board->scb, .idcode = options->idcode});
    board->fetch = (struct fetch){.clock = clock, .flash = &board->flash, .art_modelled = options->art};
    board->exceptions = (struct exceptions){.clock = clock,
                                            .cpu = &board->cpu,
                                            .fetch = &board->fetch,
                                            .memory = &board->memory,
                                            .flash = &board->flash,
                                            .nvic = &board->nvic,
                                            .scb = &board->scb,
                                            .bus = &board->bus,
                                            .iwdg = &board->iwdg,
                                            .stats = &board->stats,
                                            .profile = &board->profile,
                                            .report = report};
    board->stats.wires = (struct stats_wires){.clock = clock, .cpu = &board->cpu, .nvic = &board->nvic};
    board->profile.wires = (struct profile_wires){.clock = clock, .report = report, .stats = &board->stats};
    board->cpu.refill = options->refill;
    board->cpu.cost.shared_bus = options->shared_bus;
    board->fetch.shared_bus = options->shared_bus;
}

/* Clocks, supply and flash: what the part needs to run at all. */
static void wire_system(struct board *board)
{
    struct clock *clock = &board->clock;
    struct report *report = &board->report;
    const struct options *options = board->options;
    board->conditions = (struct conditions){.clock = clock, .report = report};
    flash_init(&board->flash, (struct flash_wires){.clock = clock,
                                                   .report = report,
                                                   .reset = &board->reset,
                                                   .nvic = &board->nvic,
                                                   .conditions = &board->conditions,
                                                   .memory = &board->memory,
                                                   .costs = &board->cpu.cost,
                                                   .settings = &options->flash_settings,
                                                   .wait_states = options->wait_states,
                                                   .prefetch_works = options->idcode != CORE_IDCODE_A});
    supply_init(&board->supply, (struct supply_wires){.clock = clock,
                                                      .report = report,
                                                      .reset = &board->reset,
                                                      .conditions = &board->conditions,
                                                      .flash = &board->flash,
                                                      .exti = &board->exti});
    rcc_init(&board->rcc, (struct rcc_wires){.clock = clock,
                                             .report = report,
                                             .nvic = &board->nvic,
                                             .conditions = &board->conditions,
                                             .memory = &board->memory,
                                             .outlet = board_clock_outlet(board),
                                             .crystal_hz = options->crystal_hz,
                                             .has_crystal = !options->no_crystal});
    iwdg_init(
        &board->iwdg,
        (struct iwdg_wires){
            .clock = clock, .report = report, .reset = &board->reset, .rcc = &board->rcc, .lsi_hz = options->lsi_hz});
}

/* Who is told of an edge at a pin. */
static void note_edge(void *model, struct pin pin, bool level, uint64_t cycle)
{
    struct board *board = model;
    recorder_note_edge(&board->recorder, pin, level, cycle);
    for (unsigned i = 0; i < TIMERS; i++) {
        timer_note_pin(&board->timer[i], pin, level, cycle);
    }
    wires_note_edge(&board->wires, pin, level, cycle);
}

static void wire_peripherals(struct board *board)
{
    struct clock *clock = &board->clock;
    struct report *report = &board->report;
    const struct options *options = board->options;
    exti_init(&board->exti,
              (struct exti_wires){.nvic = &board->nvic, .report = report, .mask_first = options->exti_mask_first});
    board->syscfg.exti = &board->exti;
    board->syscfg.memory = &board->memory;
    board->syscfg.clock = clock;
    gpio_init(&board->gpio, (struct gpio_wires){.clock = clock,
                                                .report = report,
                                                .exti = &board->exti,
                                                .watcher = {.note = note_edge, .model = board}});
    for (unsigned i = 0; i < TIMERS; i++) {
        timer_init(&board->timer[i], (struct timer_wires){.number = i,
                                                          .clock = clock,
                                                          .report = report,
                                                          .nvic = &board->nvic,
                                                          .conditions = &board->conditions,
                                                          .gpio = &board->gpio,
                                                          .requests = &board->requests,
                                                          .settings = &options->timer_settings,
                                                          .rcc = &board->rcc,
                                                          .lsi_hz = options->lsi_hz});
    }
    timer_capture_init(&board->timer[TIMER_TIM5]);
    for (unsigned i = 0; i < DMA_CONTROLLERS; i++) {
        board->requests.listener[i] = (struct request_listener){.model = &board->dma[i], .note = dma_note_request};
        dma_init(&board->dma[i], (struct dma_wires){.number = i,
                                                    .clock = clock,
                                                    .report = report,
                                                    .nvic = &board->nvic,
                                                    .memory = &board->memory,
                                                    .bus = &board->bus,
                                                    .requests = &board->requests});
    }
    adc_init(&board->adc, (struct adc_wires){.clock = clock, .report = report, .conditions = &board->conditions});
    for (unsigned i = 0; i < USARTS; i++) {
        usart_init(&board->usart[i], (struct usart_wires){.number = i,
                                                          .clock = clock,
                                                          .report = report,
                                                          .nvic = &board->nvic,
                                                          .conditions = &board->conditions,
                                                          .gpio = &board->gpio,
                                                          .requests = i == 0 ? &board->requests : NULL});
    }
}

/* What stands around the part; the pins have been read. */
static void wire_surroundings(struct board *board)
{
    struct clock *clock = &board->clock;
    const struct options *options = board->options;
    struct rs485_listener client = {.model = &board->tty, .hear = tty_send};
    tty_init(&board->tty, clock, &board->line);
    lockstep_init(&board->lockstep, clock, &board->line, &board->wires, &board->report);
    if (options->lockstep) {
        client = (struct rs485_listener){.model = &board->lockstep, .hear = lockstep_hear};
    }
    rs485_init(&board->line, (struct rs485_wires){.clock = clock,
                                                  .pins = &board->pins,
                                                  .usart = &board->usart[board->pins.usart],
                                                  .listener = client,
                                                  .baud = options->baud,
                                                  .format = options->format});
    board->recorder.wires = (struct recorder_wires){.clock = clock,
                                                    .report = &board->report,
                                                    .pins = &board->pins,
                                                    .timer = &board->timer[options->timer_settings.steps],
                                                    .line = &board->line,
                                                    .ticks_from_timer = options->ticks_from_timer};
    wires_init(&board->wires, clock, &board->gpio);
    inputs_init(&board->inputs, (struct inputs_wires){.clock = clock, .pins = &board->pins, .gpio = &board->gpio});
    faults_init(&board->faults, (struct faults_wires){.clock = clock,
                                                      .cpu = &board->cpu,
                                                      .memory = &board->memory,
                                                      .dma = board->dma,
                                                      .flash = &board->flash,
                                                      .nvic = &board->nvic,
                                                      .reset = &board->reset,
                                                      .image = &board->image});
}

static void on_measure(void *model, uint64_t cycle)
{
    struct board *board = model;
    (void)cycle;
    stats_reset(&board->stats);
    profile_reset(&board->profile);
}

static void on_end(void *model, uint64_t cycle)
{
    struct board *board = model;
    (void)cycle;
    report_finish(&board->report, REPORT_TIME, "");
}

static void wire(struct board *board)
{
    clock_init(&board->clock, HZ_BEFORE_RESET);
    clock_attach(&board->clock, EVENT_MEASURE, on_measure, board);
    clock_attach(&board->clock, EVENT_END, on_end, board);
    board->report = (struct report){.clock = &board->clock, .image = &board->image, .at = &board->cpu.at};
    board->reset = (struct reset){.clock = &board->clock};
    wire_processor(board);
    wire_system(board);
    wire_peripherals(board);
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
        good = image_set(&board->image, &board->memory, board->options->set[i]);
    }
    return good;
}

static bool open_line(struct board *board)
{
    const struct options *options = board->options;
    if (!rs485_open(&board->line, options->line_script, options->line_log)) {
        return false;
    }
    if (options->lockstep) {
        lockstep_open(&board->lockstep);
        return true;
    }
    if (options->pty != NULL) {
        return tty_open_pty(&board->tty, options->pty);
    }
    return !options->tcp || tty_open_tcp(&board->tty, options->tcp_port);
}

static bool open_files(struct board *board)
{
    const struct options *options = board->options;
    return recorder_open(&board->recorder, options->steps, options->vcd) &&
           inputs_open(&board->inputs, options->node, options->inputs) && open_line(board) &&
           profile_open(&board->profile, options->profile) &&
           faults_open(&board->faults, options->fault, options->faults) &&
           supply_open(&board->supply, options->supply, options->thresholds);
}

/* What is wired to the part, before power comes. */
static bool connect(struct board *board)
{
    const struct options *options = board->options;
    if (!pins_read(&board->pins, options->pins)) {
        return false;
    }
    wire_surroundings(board);
    if (!open_files(board)) {
        return false;
    }
    for (unsigned i = 0; i < options->stucks; i++) {
        gpio_set_stuck(&board->gpio, options->stuck[i].pin, options->stuck[i].level);
    }
    for (unsigned i = 0; i < options->wires; i++) {
        wires_connect(&board->wires, &options->wire[i]);
    }
    clock_set_ps(&board->clock, EVENT_END, options->for_ps);
    if (options->crystal_stops_ps != VTIME_NEVER) {
        clock_set_ps(&board->clock, EVENT_CRYSTAL, options->crystal_stops_ps);
    }
    if (options->measure_from_ps > 0) {
        clock_set_ps(&board->clock, EVENT_MEASURE, options->measure_from_ps);
    }
    return true;
}

static bool build_processor(struct board *board)
{
    uint32_t flash_kb = (uint32_t)board->options->flash_settings.kb;
    return cpu_open(&board->cpu) && memory_init(&board->memory, board->cpu.engine, flash_kb, ADC_CALIBRATION) &&
           bus_init(&board->bus, (struct bus_wires){.clock = &board->clock,
                                                    .cpu = &board->cpu,
                                                    .report = &board->report,
                                                    .profile = &board->profile,
                                                    .rcc = &board->rcc,
                                                    .conditions = &board->conditions,
                                                    .core = &board->core,
                                                    .apb_wait = board->options->apb_wait});
}

bool board_init(struct board *board, const struct options *options)
{
    memset(board, 0, sizeof *board);
    board->options = options;
    wire(board);
    if (!build_processor(board)) {
        complain("the emulator cannot be set up; is there memory enough?");
        return false;
    }
    board_attach_peripherals(board);
    if (!flash_load(&board->flash, options->flash) || !image_load(&board->image, &board->memory, options->elf) ||
        !set_constants(board) || !find_end(board) || !connect(board)) {
        return false;
    }
    board_reset(board, board->supply.held ? RESET_HELD : RESET_POWER);
    return true;
}

bool board_close(struct board *board)
{
    bool good = recorder_close(&board->recorder);
    good = rs485_close(&board->line) && good;
    good = profile_close(&board->profile) && good;
    return flash_save(&board->flash, board->options->flash) && good;
}

void board_discard(struct board *board)
{
    tty_close(&board->tty);
    inputs_close(&board->inputs);
    recorder_discard(&board->recorder);
    rs485_discard(&board->line);
    profile_discard(&board->profile);
    image_discard(&board->image);
    cpu_discard(&board->cpu);
    memory_discard(&board->memory);
}

#include "events.h"

#include "board.h"

typedef void event_handler(struct board *board, uint64_t cycle);

static event_handler *const handlers[EVENTS] = {
    [EVENT_TIM2] = tim2_event,
    [EVENT_TIM3] = tim3_event,
    [EVENT_TIM4] = tim4_event,
    [EVENT_TIM5] = tim5_event,
    [EVENT_SYSTICK] = systick_event,
    [EVENT_USART1] = usart1_event,
    [EVENT_USART2] = usart2_event,
    [EVENT_USART3] = usart3_event,
    [EVENT_BUS] = bus_event,
    [EVENT_FLASH] = flash_event,
    [EVENT_RCC] = rcc_event,
    [EVENT_CRYSTAL] = rcc_crystal_event,
    [EVENT_IWDG] = iwdg_event,
    [EVENT_LINE] = rs485_event,
    [EVENT_INPUTS] = inputs_event,
    [EVENT_FAULT] = faults_event,
    [EVENT_SUPPLY] = supply_event,
    [EVENT_THROTTLE] = tty_event,
    [EVENT_MEASURE] = board_measure_event,
    [EVENT_END] = board_end_event,
};

void events_init(struct events *events)
{
    for (unsigned i = 0; i < EVENTS; i++) {
        events->due[i] = VTIME_NEVER;
        events->due_ps[i] = VTIME_NEVER;
    }
    events->next = VTIME_NEVER;
}

static void find_next(struct board *board)
{
    struct events *events = &board->events;
    uint64_t next = VTIME_NEVER;
    for (unsigned i = 0; i < EVENTS; i++) {
        next = events->due[i] < next ? events->due[i] : next;
    }
    events->next = next;
    cpu_lower_deadline(&board->cpu, next);
}

void events_set(struct board *board, enum event event, uint64_t cycle)
{
    struct events *events = &board->events;
    uint64_t before = events->due[event];
    events->due[event] = cycle;
    events->due_ps[event] = VTIME_NEVER;
    if (cycle <= events->next) {
        events->next = cycle;
        cpu_lower_deadline(&board->cpu, cycle);
    }
    if (before == events->next && cycle > before) {
        find_next(board);
    }
}

void events_set_ps(struct board *board, enum event event, uint64_t ps)
{
    events_set(board, event, vtime_cycle_of_ps(&board->time, ps));
    board->events.due_ps[event] = ps;
}

void events_run(struct board *board, uint64_t cycle)
{
    struct events *events = &board->events;
    while (events->next <= cycle) {
        unsigned event = 0;
        while (events->due[event] != events->next) {
            event++;
        }
        uint64_t due = events->next;
        board->event_cycle = due;
        events_set(board, (enum event)event, VTIME_NEVER);
        handlers[event](board, due);
    }
    board->event_cycle = cycle;
}

void events_rescale(struct board *board)
{
    struct events *events = &board->events;
    for (unsigned i = 0; i < EVENTS; i++) {
        if (events->due_ps[i] != VTIME_NEVER) {
            events->due[i] = vtime_cycle_of_ps(&board->time, events->due_ps[i]);
        }
    }
    find_next(board);
}

/*
 * The host backend: a deterministic machine with virtual time on which the unmodified firmware runs.
 *
 * Comes in: scripts of input levels and of the line, flash contents, switches for misbehaviour. Goes out: an edge
 * log through a listener. Time jumps from event to event; when nothing happens nothing is spent. The same run twice
 * gives the same calls in the same order. A machine belongs to its caller; the hal functions work on the one that was
 * selected last. What the headers of the seam forbid (arming a motor twice, holding an interrupt twice, ...) ends in
 * an assertion.
 */
#ifndef HOST_MACHINE_H
#define HOST_MACHINE_H

#include <stdbool.h>
#include <stdint.h>

#include "base_limits.h"
#include "hal_board.h"
#include "hal_flash.h"
#include "hal_io.h"
#include "hal_line.h"
#include "hal_run.h"
#include "hal_trace.h"

/* Ticks from a STEP edge until the step interrupt has put the pin back low and main can run: 2.5 us. */
#define HOST_PULSE_TICKS UINT32_C(210)

/* DIR, after the rising edge of a pulse and before that of one the other way; and what it may take to change it. */
#define HOST_HOLD_TICKS UINT32_C(420)
#define HOST_SETUP_TICKS UINT32_C(420)
#define HOST_TURN_US UINT32_C(12)

/* Ticks of one pass of the main loop while there is more to run at once: 20 us. */
#define HOST_PASS_TICKS UINT32_C(1680)

/* Ticks of a byte on the line: ten bits at 19 200 Bd. */
#define HOST_LINE_BYTE_TICKS UINT32_C(43750)

enum {
    HOST_LINE_HEARD_MAX = 256,  /* bytes received and not yet read, the last one broken; what comes beyond is lost */
    HOST_LINE_TO_SEND_MAX = 64, /* bytes given and not yet sent */
    HOST_LAID_MAX = 64,         /* pulses of a motor that wait */
};

/* What the machine tells, in order of time; ticks count from the start of the machine, not from its epoch. Entries
 * may be null. Of levels and directions only changes at the pins are told. */
struct host_listener {
    void *context;
    void (*step)(void *context, uint64_t tick, unsigned motor, bool backward);      /* rising edge of STEP at the pin */
    void (*simulated)(void *context, uint64_t tick, unsigned motor, bool backward); /* one that is disconnected */
    void (*connection)(void *context, uint64_t tick, unsigned motor, bool connected); /* of STEP and DIR */
    void (*direction)(void *context, uint64_t tick, unsigned motor, bool backward);
    /* What hal_step_set_polarity has set, if that changes; steps and directions are told as if it were not there. */
    void (*polarity)(void *context, uint64_t tick, unsigned motor, bool falling, bool turned);
    void (*pwm)(void *context, uint64_t tick, uint32_t permille);
    void (*led)(void *context, uint64_t tick, unsigned led, bool on);
    void (*input)(void *context, uint64_t tick, uint8_t levels);
    void (*output)(void *context, uint64_t tick, uint8_t levels);
    void (*trace)(void *context, uint64_t tick, unsigned motor, enum hal_trace_event event, int64_t value);
    void (*line)(void *context, uint64_t tick, uint8_t value); /* a byte has been sent; the end of its stop bit */
};

struct host_input {
    uint64_t tick; /* from the start of the machine */
    uint8_t input; /* 1 to 8 */
    bool level;
};

/* A byte that comes to the unit by the line; the end of its stop bit. */
struct host_line_byte {
    uint64_t tick; /* from the start of the machine */
    uint8_t value;
    bool broken;
};

struct host_line {
    const struct host_line_byte *script; /* sorted by tick */
    uint32_t script_length;
    uint32_t script_next;
    struct hal_line_byte heard[HOST_LINE_HEARD_MAX]; /* a ring */
    uint32_t heard_first;
    uint32_t heard_count;
    uint8_t to_send[HOST_LINE_TO_SEND_MAX]; /* a ring; the first is on the bus */
    uint32_t to_send_first;
    uint32_t to_send_count;
    bool refused;        /* main wants to give more than there was room for */
    uint32_t byte_ticks; /* what a byte that is sent takes */
    uint64_t sent_tick;  /* the end of the byte on the bus; TICK_NEVER: the bus is free */
    uint64_t next_tick;  /* the next event of script or bus; TICK_NEVER: none */
    uint8_t node;
    uint32_t rate_bd; /* as the unit has set them; 0: it has not */
    enum hal_line_format format;
};

/* What of its word or area a flash operation gets done when it goes wrong. */
enum host_flash_done {
    HOST_FLASH_FIRST_HALF,
    HOST_FLASH_LAST_HALF,
    HOST_FLASH_NOTHING,
    HOST_FLASH_ALL,
};

/* Switches for misbehaviour; all zero: none. */
struct host_faults {
    uint32_t flash_cut_after; /* power fails at this flash operation (1 = the first word or erase since the start):
                                 it is left half done, and all later ones do nothing; all report success; 0: never */
    uint32_t flash_fail_at;   /* this flash operation reports an error; 0: never */
    uint32_t flash_silent_at; /* this flash operation goes wrong and reports success; 0: never */
    enum host_flash_done flash_done;  /* of the operation that goes wrong */
    uint32_t late_step_ticks;         /* every step interrupt comes this much after the edge */
    uint32_t late_tick_ticks;         /* every tick interrupt comes this much after the change of an input */
    uint32_t keep_ticks;              /* a pulse that is due so soon is not taken back any more */
    bool no_crystal;                  /* the board allows no motion */
    bool no_step_timer;               /* the board's steps are made by an interrupt; it only says so */
    bool no_flash;                    /* the part is too small for the areas */
    enum hal_board_cause start_cause; /* why the board has started */
};

/* The pulses of a motor that wait: a ring. */
struct host_laid {
    uint64_t tick[HOST_LAID_MAX];
    uint32_t first;
    uint32_t count;
    uint64_t made;   /* the rising edge of the last one made */
    uint64_t last;   /* and of the last one laid that has not been taken back */
    uint64_t turn;   /* DIR changes, ticks from the start; TICK_NEVER: it does not */
    uint32_t turned; /* pulses that wait for that */
};

struct host_machine {
    uint64_t epoch; /* hal_time_now at the start */
    uint64_t now;   /* ticks from the start */
    uint64_t wake;  /* the next pass of main, ticks from the start; TICK_NEVER: none */
    uint64_t sense; /* the tick interrupt that is due, likewise */
    struct hal_client client;
    struct host_listener listener;
    struct host_faults faults;
    const struct host_input *script; /* sorted by tick */
    uint32_t script_length;
    uint32_t script_next;
    uint32_t ahead_ticks;        /* pulses are laid this far ahead, or one; 0 unless set */
    uint64_t armed[UNIT_MOTORS]; /* the next edge, ticks from the start; TICK_NEVER: none */
    uint64_t step[UNIT_MOTORS];  /* the step interrupt that is due, likewise */
    struct host_laid laid[UNIT_MOTORS];
    bool backward[UNIT_MOTORS]; /* DIR as set; the pin shows it while connected */
    bool led[HAL_IO_LEDS];
    bool connected[UNIT_MOTORS]; /* STEP and DIR reach their pins; so they do at the start */
    bool falling[UNIT_MOTORS];   /* the active edge of STEP falls */
    bool turned[UNIT_MOTORS];    /* the levels of DIR are the other way round */
    uint64_t enabled_tick;       /* when a motion has last switched the drivers on; TICK_NEVER: none has */
    bool step_held;
    bool plan_held;
    uint8_t inputs;
    uint8_t outputs;
    uint32_t pwm_permille;
    struct host_line line;
    uint64_t late_steps;       /* pulses laid for a tick that had gone by; 0 in every good run */
    uint64_t pulses;           /* pulses made, connected or not */
    uint32_t flash_operations; /* words and erases since the start or restart */
    uint32_t flash_rewrites;   /* words that were written when not erased; 0 in every good run */
    uint8_t flash[HAL_FLASH_AREAS][HAL_FLASH_AREA_BYTES];
};

/* A machine at time 0 (hal_time_now gives `epoch`), erased flash, node 1, no script, no faults, no listener. */
void host_machine_init(struct host_machine *machine, uint64_t epoch);

/* Makes this machine the one that the hal functions work on. */
void host_machine_select(struct host_machine *machine);

/* Gives the machine its inputs over time, sorted by tick; the array must outlive the run. What is already past
 * comes at once. */
void host_machine_set_script(struct host_machine *machine, const struct host_input *script, uint32_t length);

/* Gives the machine what it hears on the line, sorted by tick, in place of what was left of the script before; the
 * array must outlive the run. What is already past comes at once. */
void host_machine_set_line(struct host_machine *machine, const struct host_line_byte *script, uint32_t length);

/* Sets what a byte takes that the machine sends; 0: nothing. At the start HOST_LINE_BYTE_TICKS. */
void host_machine_set_byte_ticks(struct host_machine *machine, uint32_t ticks);

/* Sets what switch S1 shows. */
void host_machine_set_node(struct host_machine *machine, uint8_t node);

/* Selects the machine and gives input 1 to 8 a level now, besides the script; between two runs. */
void host_machine_set_input(struct host_machine *machine, unsigned input, bool level);

/* Turns the power off and on: pins at 0, interrupts stopped, faults cleared, bytes of the line that are in the machine
 * lost; flash, inputs, scripts, node and time stay. The firmware starts again when the caller initialises it again. */
void host_machine_restart(struct host_machine *machine);

/* The main loop's body, as the machine calls it: does one pass and returns the tick of the unit's time at which it
 * wants to be called again at the latest (TICK_NEVER: never). */
typedef uint64_t host_main_pass(void *context);

/* Selects the machine and runs main and interrupts: all that happens before `until` ticks from the start, where time
 * then stands, or up to the pass after which `done` (may be null) says so. With TICK_NEVER for `until` it ends, at the
 * last event, when nothing is left to happen. Main makes a pass at once, and again whenever its wake-up is due, an
 * interrupt has work for it, an input has changed, a byte has come by the line, or there is room again for bytes that
 * the line did not take. Of what falls on the same tick, pulses come first, in the order of the motors, then inputs
 * and the tick interrupt, then the line, then main. */
void host_machine_run(struct host_machine *machine, uint64_t until, host_main_pass *pass, bool (*done)(void *context),
                      void *context);

/* Main makes a pass at this tick at the latest; for listeners. */
void host_machine_wake(struct host_machine *machine, uint64_t tick);

/* After a run: the tick, from the start, of the next thing that happens in the machine; TICK_NEVER: nothing does. */
uint64_t host_machine_next_tick(const struct host_machine *machine);

#endif

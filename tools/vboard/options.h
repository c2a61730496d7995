/*
 * The command line.
 */
#ifndef OPTIONS_H
#define OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "complain.h"
#include "faults.h"
#include "flash.h"
#include "gpio.h"
#include "supply.h"
#include "timer_counter.h"
#include "usart.h"
#include "wires.h"

enum {
    OPTIONS_WATCHES_MAX = 32,
    OPTIONS_STUCK_MAX = 16,
    OPTIONS_SETS_MAX = 8,
};

struct options_stuck {
    struct pin pin;
    bool level;
};

struct options {
    const char *elf;
    const char *pins;
    const char *inputs;
    const char *line_script;
    const char *line_log;
    const char *steps;
    const char *vcd;
    const char *flash;
    const char *profile;
    const char *pty;
    const char *supply;      /* null: 3.3 V */
    const char *end_at;      /* symbol of a function; null: none */
    const char *stack_limit; /* symbol; null: found from the image */
    const char *watch[OPTIONS_WATCHES_MAX];
    unsigned watches;
    const char *set[OPTIONS_SETS_MAX]; /* NAME=HEXBYTES */
    unsigned sets;
    struct options_stuck stuck[OPTIONS_STUCK_MAX];
    unsigned stucks;
    struct wire wire[WIRES_MAX];
    unsigned wires;
    bool tcp;
    bool lockstep;
    unsigned tcp_port;
    uint64_t for_ps;
    uint64_t measure_from_ps;
    uint64_t crystal_hz;
    uint64_t crystal_stops_ps; /* NEVER */
    uint64_t lsi_hz;
    uint64_t baud;
    enum usart_format format;
    struct flash_settings flash_settings;
    struct timer_settings timer_settings;
    const char *fault[FAULTS_MAX];
    unsigned faults;
    unsigned node;
    enum supply_corner thresholds;
    uint32_t idcode; /* DBGMCU_IDCODE */
    uint32_t refill;
    uint32_t apb_wait;
    int wait_states; /* -1: as FLASH_ACR says */
    bool art;
    bool shared_bus;
    bool no_crystal;
    bool exti_mask_first;
    bool left_by_loader;
    bool loader_uses_ram; /* after every reset */
    bool ticks_from_timer;
};

extern const char options_usage[];
extern const char options_usage_more[];

/* EXIT_DONE, or EXIT_USAGE after a complaint. */
enum exit_status options_read(struct options *options, int count, char *const arguments[]);

#endif

/*
 * A script of instructions, as a PLC program gives them: lines `ms,axis,INSTRUCTION,...`; `#` starts a comment. Times
 * have up to 6 decimals, and never go back.
 *
 *     ms,axis,POS_INIT[,space]                 ms,axis,POS_RESET
 *     ms,axis,POS_MODE,len,accel               ms,axis,POS_CAPTURE
 *     ms,axis,POS_MODE_ABS,position,accel      ms,axis,POS_HOME,method,position,accel
 *     ms,axis,POS_CONTROL,feed[,mp]            ms,0,SETTING,register,value
 *     ms,axis,READ
 *
 * A feed is in 1/65 536 mm/min, or whole with `mm/min` after it. The script plays in the place of the linked PLC
 * program: what is due is executed in the pass of the unit that comes next. READ keeps what the axis shows then.
 */
#ifndef POS_SCRIPT_H
#define POS_SCRIPT_H

#include <stdbool.h>
#include <stdint.h>

#include "host_machine.h"
#include "infile.h"
#include "positioning.h"

enum pos_script_kind {
    POS_SCRIPT_INIT,
    POS_SCRIPT_MODE,
    POS_SCRIPT_CONTROL,
    POS_SCRIPT_RESET,
    POS_SCRIPT_MODE_ABS,
    POS_SCRIPT_HOME,
    POS_SCRIPT_CAPTURE,
    POS_SCRIPT_READ,
    POS_SCRIPT_SETTING,
    POS_SCRIPT_KINDS,
};

enum {
    POS_SCRIPT_VALUES = 3
};

struct pos_script_line {
    uint64_t tick;   /* from the start */
    uint32_t number; /* in the file, from 1 */
    int64_t values[POS_SCRIPT_VALUES];
    unsigned count; /* of the values */
    uint8_t kind;   /* enum pos_script_kind */
    uint8_t axis;

    /* When it has been executed: enum pos_error, of a setting enum modbus_exception; what READ has kept. */
    unsigned result;
    struct pos_values read;
    uint64_t done_tick;
};

struct pos_script {
    const struct host_machine *machine;
    struct pos_script_line *lines;
    uint32_t count;
    uint32_t next; /* the first that has not been executed */
};

/* Reads a script. False after a complaint that says where and why. */
bool pos_script_read(struct pos_script *script, const struct infile *file);

/* It plays from now on, on a machine; NULL: none plays. */
void pos_script_play(struct pos_script *script, const struct host_machine *machine);

/* As struct run_partner wants them. */
uint64_t pos_script_pass(void *context);
bool pos_script_is_over(const void *context);

/* The word of an instruction. */
const char *pos_script_word(enum pos_script_kind kind);

void pos_script_discard(struct pos_script *script);

#endif

/*
 * A vector file as a host reads it: the lines that follow each other, one at a time, and beside them those with a time.
 *
 * The file has been checked (gve_check.h): a line is a command without faults. Memory: an entry for each line with a
 * time, on the heap; the file is the caller's.
 */
#ifndef GVE_SCRIPT_H
#define GVE_SCRIPT_H

#include <stdbool.h>
#include <stdint.h>

#include "gve_file.h"

struct gve_script_line {
    struct gve_file_line line;
    uint8_t opcode; /* enum gve_opcode; GVE_OPCODES: ;@probe */
    bool repeated;  /* it has been answered with code 1 */
    uint64_t tick;  /* when it is to be sent, from the start; 0: as soon as it is its turn */
};

/* A place in the file to come back to. */
struct gve_script_place {
    struct gve_file file;
    struct gve_file_line line;
};

struct gve_script {
    struct gve_script_place place; /* after the last line taken */
    struct gve_script_line *timed; /* sorted by tick */
    uint32_t timed_count;
    uint32_t timed_taken;
};

/* False after a complaint: there is not memory enough. */
bool gve_script_begin(struct gve_script *script, const struct infile *file);

/* Takes the next line without a time. False: there is none. */
bool gve_script_next(struct gve_script *script, struct gve_script_line *line);

/* Whether that will be ;@probe. */
bool gve_script_probes_next(const struct gve_script *script);

/* The tick of the next line with a time; TICK_NEVER: there is none. */
uint64_t gve_script_timed_tick(const struct gve_script *script);

/* Takes that line; puts one that has been taken back, for another tick. */
void gve_script_take_timed(struct gve_script *script, struct gve_script_line *line);
void gve_script_put_back(struct gve_script *script, const struct gve_script_line *line);

void gve_script_discard(struct gve_script *script);

#endif

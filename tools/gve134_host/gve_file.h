/*
 * A vector file (*.gve): the commands of the unit, one in a line, with comments and times beside them.
 *
 *   ; a comment, to the end of the line        blanks before and after a command do not count
 *   L1000,1000,20                              a command without ! and address is for the interpolator
 *   !7V300                                     with them for the unit that it names: 0 or 7
 *   @250.5 H                                   beside the others, 250.5 ms after the start; up to 6 decimals
 *   ;@wait 2.5                                 comments to the unit: the host waits 2.5 s before the next command;
 *   ;@probe                                    goes back to where the sensor was touched (gve_probing.h)
 */
#ifndef GVE_FILE_H
#define GVE_FILE_H

#include <stdbool.h>
#include <stdint.h>

#include "gve_command.h"
#include "infile.h"

struct gve_file {
    const struct infile *file;
    uint32_t next;    /* offset of the next line */
    uint64_t wait_ns; /* for which the lines before it ask */
    bool asks;        /* they ask for that, or for a pause */
};

/* What stands in a line. */
struct gve_file_line {
    uint32_t offset; /* of its first byte in the file */
    uint32_t number; /* from 1 */
    uint32_t place;  /* offset in the line of the command's text, or of what is wrong */
    uint32_t length; /* of the command's text; 0 where there is no command */
    uint8_t address; /* enum gve_address */
    bool timed;
    bool probes;       /* it is no command, but ;@probe */
    uint64_t ns;       /* of one that is timed: from the start */
    uint64_t wait_ns;  /* for which the host waits before it; of one that is not timed */
    bool asked;        /* before it the host is asked for a wait or a pause; of one that is not timed */
    const char *wrong; /* what is wrong with it, if it is not the command itself; else null */
    const uint8_t *text;
};

struct gve_file gve_file_of(const struct infile *file);

/* Finds the next line that has anything in it. False: there is none. */
bool gve_file_next(struct gve_file *file, struct gve_file_line *line);

#endif

/*
 * The GVE134 unit of a page: what the WebAssembly module gve134-unit exports besides the functions of paced_line.h.
 */
#ifndef GVE_UNIT_H
#define GVE_UNIT_H

#include <stdint.h>

#include "paced_line.h"

/* See paced_line_begin; the line has the rate of the image as it is delivered. */
struct paced_line *gve_unit_begin(uint64_t real_ns);

#endif

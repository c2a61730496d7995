/*
 * The GVE134 unit as the programs see it that let units run.
 */
#ifndef GVE_KIND_H
#define GVE_KIND_H

#include "unit_kind.h"

/* The rate of the line of the image as it is delivered. */
#define GVE_BAUD UINT64_C(115200)

extern const struct unit_kind gve_kind_of_unit;

/* What a byte takes on the line, to the nearest tick. */
uint32_t gve_byte_ticks(uint64_t baud);

/* Reads the value of --baud, one of the rates that an image can have, into a uint64_t. False after a complaint. */
bool gve_read_baud(const char *value, uint64_t *baud);

#endif

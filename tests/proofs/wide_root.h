/*
 * Contracts of the parts of the square root in base_wide.c, proved with base_wide_root_word.acsl and
 * base_wide_root.acsl.
 */
#ifndef WIDE_ROOT_H
#define WIDE_ROOT_H

#include "squares.h"

#include <stdint.h>

/*@ requires 0x40000000 <= value;
    assigns \nothing;
    ensures 0x8000 <= \result <= 0xFFFF && root_found(value, \result);
*/
static uint32_t root_of_word(uint32_t value);

#endif

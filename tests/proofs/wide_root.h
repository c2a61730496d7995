/*
 * Contracts of the parts of the square root in base_wide.c, proved with base_wide_root_word.acsl,
 * base_wide_root.acsl and base_wide_root_wide.acsl.
 */
#ifndef WIDE_ROOT_H
#define WIDE_ROOT_H

#include "squares.h"
#include "wide.h"

#include <stdint.h>

/*@ requires 0x40000000 <= value;
    assigns \nothing;
    ensures 0x8000 <= \result <= 0xFFFF && root_found(value, \result);
*/
static uint32_t root_of_word(uint32_t value);

/* What root_of_two_words finds: its struct is known in the source only. */
/*@ predicate root_and_rest(integer value, integer root, integer rest) =
        0x80000000 <= root <= 0xFFFFFFFF && root_found(value, root) && square(root) + rest == value;
*/

/*@ requires 0x4000000000000000 <= value.high;
    assigns \nothing;
    ensures root_found(value(value), \result);
*/
static uint64_t root_of_four_words(struct wide value);

#endif

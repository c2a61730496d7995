/*
 * Masks of 16 bits, and all bits turned over. As in numbers.h, the `admit lemma`s are assumed.
 */
#ifndef MASKS_H
#define MASKS_H

/*@ admit lemma mask_16: \forall integer x; 0 <= x ==> (x & 0xFFFF) == x % 0x10000;
    admit lemma complement: \forall integer x; ~x == -1 - x;
*/
#endif

/*
 * Products of what is equal.
 */
#ifndef EQUALS_H
#define EQUALS_H

/*@ predicate equal_two(integer a, integer b, integer x, integer y) = a == x && b == y;
    lemma equal_two: \forall integer a, b, x, y; equal_two(a, b, x, y) ==> a * b == x * y;
*/

#endif

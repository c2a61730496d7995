/*
 * What WP sees of the compilers' header: atomic loads and stores are plain ones, as one interrupt runs at a
 * time. That they are in the right order is shown by ring.pml.
 */
#ifndef ATOMICS_H
#define ATOMICS_H

#include <stdatomic.h>
#include <stdbool.h>

#undef atomic_load_explicit
#undef atomic_store_explicit
#undef atomic_exchange_explicit
#define atomic_load_explicit(object, order) (*(object))
#define atomic_store_explicit(object, value, order) (*(object) = (value))
#define atomic_exchange_explicit(object, value, order) exchange(object, value)

/*@ requires \valid(object);
    assigns *object;
    ensures *object == value && \result == \old(*object);
*/
static inline bool exchange(bool *object, bool value)
{
    bool old = *object;
    *object = value;
    return old;
}

#endif

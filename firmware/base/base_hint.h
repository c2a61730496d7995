/*
 * A hint to the compiler for code that counts cycles: the condition seldom holds, so the other way goes straight on.
 */
#ifndef BASE_HINT_H
#define BASE_HINT_H

#if defined(__GNUC__)
#define BASE_SELDOM(condition) __builtin_expect((condition) ? 1 : 0, 0)
#else
#define BASE_SELDOM(condition) (condition)
#endif

#endif

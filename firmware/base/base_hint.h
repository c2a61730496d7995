/*
 * Hints to the compiler.
 *
 * BASE_SELDOM, for code that counts cycles: the condition seldom holds, so the other way goes straight on.
 * BASE_APART, for a function with large locals: it is not made part of its caller, which would hold them for longer.
 */
#ifndef BASE_HINT_H
#define BASE_HINT_H

#if defined(__GNUC__)
#define BASE_SELDOM(condition) __builtin_expect((condition) ? 1 : 0, 0)
#define BASE_APART __attribute__((noinline))
#else
#define BASE_SELDOM(condition) (condition)
#define BASE_APART
#endif

#endif

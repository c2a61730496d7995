/*
 * <assert.h> of a small image. What is kept of a failure is where it was: no words that nobody would read.
 */
#ifndef STM32_SMALL_ASSERT_H
#define STM32_SMALL_ASSERT_H

_Noreturn void __assert_func(const char *file, int line, const char *function, const char *expression);

#define assert(condition) ((condition) ? (void)0 : __assert_func((void *)0, 0, (void *)0, (void *)0))
#define static_assert _Static_assert

#endif

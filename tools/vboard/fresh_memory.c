/*
 * Unicorn 2.0 clears the gigabyte that it has mapped for the code that it translates, of which a run here needs a
 * few megabytes. Such memory is 0 as it comes from the system; clearing it takes longer than most runs, and makes a
 * gigabyte of each process resident. So the program has a memset of its own, which the library finds before that of
 * the C library.
 */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Nothing else here is as large. */
#define FRESH_BYTES_MIN ((size_t)512 * 1024 * 1024)

#ifdef __GLIBC__
/* Of the C library: the same, where `room` is not less than `n`. */
void *__memset_chk(void *s, int c, size_t n, size_t room);

__attribute__((visibility("default"))) void *memset(void *s, int c, size_t n)
{
    return c == 0 && n >= FRESH_BYTES_MIN ? s : __memset_chk(s, c, n, SIZE_MAX);
}
#endif

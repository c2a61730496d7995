/* A constant whose value the run may have changed before power-on. */
#include "part.h"

extern const uint32_t constant;
const uint32_t constant = 7;

int main(void)
{
    const uint32_t *place = &constant;
    __asm__ volatile("" : "+r"(place));
    result[0] = *place;
    return 0;
}

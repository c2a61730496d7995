/*
 * The speeds of the GVE134 unit: what the tests against exact numbers are made of.
 *
 * Comes in on standard input: cases of whole numbers, one case a line: twice
 *     d1 d2 d3 d4 V B short corrected
 * and then
 *     factor  VL1 VL2 VL3 VL4  VJ1 VJ2 VJ3 VJ4
 * Goes out, a line a case: U and E^2 of the first vector, the border where the second joins it, the factor a sixteenth
 * up and down. Exit status 2: the input is no such thing.
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "gve_speeds.h"

static int64_t read_number(void)
{
    int64_t number;
    if (scanf("%" SCNd64, &number) != 1) {
        (void)fprintf(stderr, "gve-speeds-probe: a number is missing\n");
        exit(2);
    }
    return number;
}

static struct gve_vector read_vector(void)
{
    struct gve_modal modal;
    int32_t steps[PATH_AXES];
    gve_modal_init(&modal);
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        steps[axis] = (int32_t)read_number();
    }
    modal.speed = (uint32_t)read_number();
    modal.brake = (uint32_t)read_number();
    modal.short_pulses = (uint32_t)read_number();
    modal.corrected = read_number() != 0;
    return gve_speeds_take(&modal, steps);
}

static void read_four(uint32_t values[PATH_AXES])
{
    for (unsigned axis = 0; axis < PATH_AXES; axis++) {
        values[axis] = (uint32_t)read_number();
    }
}

int main(void)
{
    while (scanf(" ") != EOF && !feof(stdin)) {
        uint32_t limit[PATH_AXES];
        uint32_t jump[PATH_AXES];
        struct gve_vector before = read_vector();
        struct gve_vector after = read_vector();
        uint32_t factor = (uint32_t)read_number();
        read_four(limit);
        read_four(jump);
        (void)printf("%" PRIu32 " %" PRIu64 " %" PRIu32 " %" PRIu32 " %" PRIu32 "\n",
                     gve_speeds_limit(&before, factor, limit), gve_speeds_extent2(&before),
                     gve_speeds_border(&before, &after, jump), gve_factor_up(factor), gve_factor_down(factor));
    }
    return 0;
}

#include "sim_options.h"

#include <stddef.h>
#include <string.h>

#include "units.h"

enum {
    SECONDS_DECIMALS = 9
};

/* 31 years. */
#define DURATION_NS_MAX UINT64_C(1000000000000000000)
#define EPOCH_MAX UINT64_C(1000000000000000000)

struct sim_options sim_options_init(void)
{
    return (struct sim_options){
        .duration_ns = SIM_OPTIONS_DURATION_NS,
        .paths.range = {.points = CURVE_POINTS_DEFAULT, .to_tick = TICK_NEVER},
    };
}

static bool read_seconds(const char *name, const char *value, uint64_t *ns)
{
    const struct argument_number range = {.decimals = SECONDS_DECIMALS, .most = DURATION_NS_MAX};
    if (!arguments_read_number(value, range, ns)) {
        complain("%s %s: not a time; write seconds with up to 9 decimals, as 2.5", name, value);
        return false;
    }
    return true;
}

bool sim_options_read_duration(void *target, const char *value)
{
    const struct argument_number range = {.decimals = SECONDS_DECIMALS, .least = 1, .most = DURATION_NS_MAX};
    struct sim_options *options = target;
    if (!arguments_read_number(value, range, &options->duration_ns)) {
        complain("--for %s: not a time; write seconds above 0 with up to 9 decimals, as 2.5", value);
        return false;
    }
    return true;
}

bool sim_options_read_from(void *target, const char *value)
{
    struct sim_options *options = target;
    uint64_t ns = 0;
    bool good = read_seconds("--from", value, &ns);
    options->paths.range.from_tick = units_ticks_of_ns(ns);
    return good;
}

bool sim_options_read_to(void *target, const char *value)
{
    struct sim_options *options = target;
    uint64_t ns = 0;
    bool good = read_seconds("--to", value, &ns);
    options->paths.range.to_tick = units_ticks_of_ns(ns);
    return good;
}

bool sim_options_read_real(void *target, const char *value)
{
    struct sim_options *options = target;
    return read_seconds("--real", value, &options->real_ns);
}

bool sim_options_read_progress(void *target, const char *value)
{
    struct sim_options *options = target;
    return read_seconds("--progress", value, &options->progress_ns);
}

bool sim_options_read_points(void *target, const char *value)
{
    struct sim_options *options = target;
    const struct argument_number range = {.least = CURVE_POINTS_MIN, .most = CURVE_POINTS_MAX};
    uint64_t points = 0;
    if (!arguments_read_number(value, range, &points)) {
        complain("--points %s: write how many points a curve may have, %d to %d", value, CURVE_POINTS_MIN,
                 CURVE_POINTS_MAX);
        return false;
    }
    options->paths.range.points = (uint32_t)points;
    return true;
}

bool sim_options_read_epoch(void *target, const char *value)
{
    struct sim_options *options = target;
    if (!arguments_read_number(value, (struct argument_number){.most = EPOCH_MAX}, &options->epoch)) {
        complain("--epoch %s: not a time; write ticks from 0 to 10^18, as 4294967295", value);
        return false;
    }
    return true;
}

static bool is_same(const char *a, const char *b)
{
    return a != NULL && b != NULL && strcmp(a, b) == 0;
}

bool sim_options_are_whole(const struct sim_options *options)
{
    const struct recorder_paths *paths = &options->paths;
    const char *const all[] = {paths->steps, paths->trace, paths->vcd, paths->curve};
    for (size_t i = 1; i < sizeof all / sizeof all[0]; i++) {
        for (size_t j = 0; j < i; j++) {
            if (is_same(all[i], all[j])) {
                complain("two outputs go to the same file; give --steps, --trace, --vcd and --curve a file each");
                return false;
            }
        }
    }
    return true;
}

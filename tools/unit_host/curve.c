#include "curve.h"

#include <assert.h>
#include <stdlib.h>

#include "complain.h"
#include "hal_trace.h"
#include "line.h"
#include "units.h"

enum {
    NS_PER_US = 1000,
    TIME_DECIMALS = 6,
    SPEED_DECIMALS = 3,
    ITEM_BYTES_MAX = 96,
};

static_assert(CURVE_POINTS_MIN - THIN_POINTS_PER_COLUMN >= 0, "a line has a column at least");

/* Keeps a point if it belongs to the part, or is the one before or after it. */
static void put_point(const struct curve *curve, struct curve_motor *motor, uint64_t tick, int64_t milli_speed)
{
    motor->tick = tick > motor->tick ? tick : motor->tick;
    struct thin_point point = {.tick = motor->tick, .milli_speed = milli_speed, .position = motor->position};
    if (point.tick < curve->range.from_tick) {
        motor->before = point;
        motor->has_before = true;
        return;
    }
    if (motor->is_over) {
        return;
    }
    if (motor->has_before) {
        thin_put(&motor->thin, &motor->before);
        motor->has_before = false;
    }
    motor->is_over = point.tick > curve->range.to_tick;
    thin_put(&motor->thin, &point);
}

/* Keeps a single change of the position, if it belongs to the part. */
static void put_change(const struct curve *curve, struct curve_motor *motor, const struct timeline_event *event)
{
    uint32_t room = curve->range.points;
    if (event->tick <= curve->range.from_tick) {
        motor->steps_before = event->value;
    } else if (event->tick <= curve->range.to_tick && motor->steps_count <= room) {
        if (motor->steps_count < room) {
            motor->steps[motor->steps_count] = (struct curve_step){.tick = event->tick, .position = event->value};
        }
        motor->steps_count++;
    }
}

bool curve_begin(struct curve *curve, struct outfile *file, const struct curve_range *range)
{
    *curve = (struct curve){.file = file, .range = *range, .cut_tick = TICK_NEVER};
    curve->outputs = malloc(range->points * sizeof *curve->outputs);
    bool good = curve->outputs != NULL;
    for (unsigned i = 0; i < UNIT_MOTORS && good; i++) {
        curve->motors[i].steps = malloc(range->points * sizeof *curve->motors[i].steps);
        good = thin_begin(&curve->motors[i].thin, range->points) && curve->motors[i].steps != NULL &&
               curve_commands_begin(&curve->motors[i].commands, range->points);
        if (good) {
            put_point(curve, &curve->motors[i], 0, 0);
        }
    }
    if (!good) {
        complain("there is not memory enough for a curve of %lu points; ask for less with --points",
                 (unsigned long)range->points);
    }
    return good;
}

static void put_step(struct curve *curve, struct curve_motor *motor, const struct timeline_event *event)
{
    if (event->interval_ticks != motor->interval_ticks) { /* most are alike, and a division takes long */
        motor->interval_ticks = event->interval_ticks;
        motor->interval_speed = (int64_t)units_milli_speed(event->interval_ticks);
    }
    int64_t size = motor->interval_speed;
    int64_t milli_speed = event->value < motor->position ? -size : size;
    if (motor->fresh) {
        put_point(curve, motor, motor->move_tick, milli_speed);
        motor->fresh = false;
    }
    put_point(curve, motor, event->tick - event->interval_ticks / 2U, milli_speed);
    motor->milli_speed = milli_speed;
    motor->position = event->value;
}

static void put_trace(struct curve *curve, struct curve_motor *motor, const struct timeline_event *event)
{
    if (event->detail == HAL_TRACE_MOVE) {
        put_point(curve, motor, event->tick, 0);
        motor->moving = true;
        motor->fresh = true;
        motor->move_tick = event->tick;
        motor->milli_speed = 0;
    } else if (event->detail == HAL_TRACE_DONE) {
        put_point(curve, motor, event->tick, motor->milli_speed);
        put_point(curve, motor, event->tick, 0);
        motor->moving = false;
    }
}

static void put_position(struct curve *curve, struct curve_motor *motor, const struct timeline_event *event)
{
    put_point(curve, motor, event->tick, motor->moving ? motor->milli_speed : 0);
    motor->position = event->value;
    put_point(curve, motor, event->tick, motor->moving ? motor->milli_speed : 0);
}

static void put_outputs(struct curve *curve, const struct timeline_event *event)
{
    unsigned levels = (unsigned)event->value;
    for (unsigned i = 0; i < UNIT_OUTPUTS; i++) {
        if (((levels ^ curve->levels) >> i & 1U) == 0) {
            continue;
        }
        if (curve->outputs_count == curve->range.points) {
            curve->cut_tick = curve->cut_tick == TICK_NEVER ? event->tick : curve->cut_tick;
            break;
        }
        curve->outputs[curve->outputs_count++] = (struct curve_output){
            .tick = event->tick, .number = (uint8_t)(i + 1U), .level = (uint8_t)(levels >> i & 1U)};
    }
    curve->levels = (uint8_t)levels;
}

void curve_put(struct curve *curve, const struct timeline_event *event)
{
    bool of_motor = event->motor != 0 && event->kind != TIMELINE_LED;
    struct curve_motor *motor = of_motor ? &curve->motors[event->motor - 1U] : NULL;
    if (event->kind == TIMELINE_OUTPUT) {
        put_outputs(curve, event);
    } else if (motor != NULL && event->kind == TIMELINE_STEP) {
        put_step(curve, motor, event);
        put_change(curve, motor, event);
    } else if (motor != NULL && event->kind == TIMELINE_TRACE) {
        put_trace(curve, motor, event);
    } else if (motor != NULL && event->kind == TIMELINE_POSITION) {
        put_position(curve, motor, event);
        put_change(curve, motor, event);
    }
}

void curve_put_command(struct curve *curve, unsigned motor, uint64_t tick, int64_t ordinal)
{
    const struct curve_command command = {.tick = tick, .ordinal = ordinal};
    curve_commands_put(&curve->motors[motor].commands, &command, curve->range.from_tick, curve->range.to_tick);
}

static void put_text(struct curve *curve, const char *text)
{
    outfile_commit(curve->file, line_put_string(outfile_reserve(curve->file, ITEM_BYTES_MAX), text));
}

static char *put_time(char *at, uint64_t tick)
{
    return line_put_fixed(at, units_ns_of_ticks(tick) / NS_PER_US, TIME_DECIMALS);
}

typedef char *put_value(char *at, const struct thin_point *point);

static char *put_point_time(char *at, const struct thin_point *point)
{
    return put_time(at, point->tick);
}

static char *put_point_speed(char *at, const struct thin_point *point)
{
    bool backward = point->milli_speed < 0;
    if (backward) {
        *at++ = '-';
    }
    return line_put_fixed(at, (uint64_t)(backward ? -point->milli_speed : point->milli_speed), SPEED_DECIMALS);
}

static char *put_point_position(char *at, const struct thin_point *point)
{
    return line_put_signed(at, point->position);
}

/* "name":[value,...] of all points that are left. */
static void put_list(struct curve *curve, const struct thin *thin, const char *name, put_value *put)
{
    put_text(curve, name);
    for (uint32_t i = 0; i < thin->count; i++) {
        struct thin_point points[THIN_POINTS_PER_COLUMN];
        unsigned count = thin_list_column(&thin->columns[i], points);
        for (unsigned j = 0; j < count; j++) {
            char *at = outfile_reserve(curve->file, ITEM_BYTES_MAX);
            if (i + j > 0) {
                *at++ = ',';
            }
            outfile_commit(curve->file, put(at, &points[j]));
        }
    }
    put_text(curve, "]");
}

/* ,"before":position,"steps":[[time,position],...] */
static void put_steps(struct curve *curve, const struct curve_motor *motor)
{
    put_text(curve, ",\"before\":");
    outfile_commit(curve->file, line_put_signed(outfile_reserve(curve->file, ITEM_BYTES_MAX), motor->steps_before));
    if (motor->steps_count > curve->range.points) {
        put_text(curve, ",\"steps\":null");
        return;
    }
    put_text(curve, ",\"steps\":[");
    for (uint32_t i = 0; i < motor->steps_count; i++) {
        char *at = line_put_string(outfile_reserve(curve->file, ITEM_BYTES_MAX), i == 0 ? "[" : ",[");
        at = put_time(at, motor->steps[i].tick);
        *at++ = ',';
        at = line_put_signed(at, motor->steps[i].position);
        *at++ = ']';
        outfile_commit(curve->file, at);
    }
    put_text(curve, "]");
}

static void put_motor(struct curve *curve, unsigned motor)
{
    const struct thin *thin = &curve->motors[motor].thin;
    char *at = line_put_string(outfile_reserve(curve->file, ITEM_BYTES_MAX), motor == 0 ? "\n" : ",\n");
    at = line_put_string(at, "{\"motor\":");
    outfile_commit(curve->file, line_put_unsigned(at, motor + 1U));
    put_list(curve, thin, ",\"t\":[", put_point_time);
    put_list(curve, thin, ",\"speed\":[", put_point_speed);
    put_list(curve, thin, ",\"position\":[", put_point_position);
    put_steps(curve, &curve->motors[motor]);
    curve_commands_write(&curve->motors[motor].commands, curve->file);
    put_text(curve, "}");
}

static void put_all_outputs(struct curve *curve)
{
    put_text(curve, "],\n\"outputs\":[");
    for (uint32_t i = 0; i < curve->outputs_count; i++) {
        const struct curve_output *output = &curve->outputs[i];
        char *at = line_put_string(outfile_reserve(curve->file, ITEM_BYTES_MAX), i == 0 ? "[" : ",[");
        at = put_time(at, output->tick);
        *at++ = ',';
        at = line_put_unsigned(at, output->number);
        *at++ = ',';
        at = line_put_unsigned(at, output->level);
        *at++ = ']';
        outfile_commit(curve->file, at);
    }
    char *at = line_put_string(outfile_reserve(curve->file, ITEM_BYTES_MAX), "],\"outputs_cut\":");
    at = curve->cut_tick == TICK_NEVER ? line_put_string(at, "null") : put_time(at, curve->cut_tick);
    outfile_commit(curve->file, line_put_string(at, "}\n"));
}

void curve_end(struct curve *curve, uint64_t end_tick)
{
    put_text(curve, "{\"motors\":[");
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        struct curve_motor *motor = &curve->motors[i];
        put_point(curve, motor, end_tick, motor->moving ? motor->milli_speed : 0);
        put_motor(curve, i);
    }
    put_all_outputs(curve);
}

void curve_discard(struct curve *curve)
{
    for (unsigned i = 0; i < UNIT_MOTORS; i++) {
        thin_discard(&curve->motors[i].thin);
        free(curve->motors[i].steps);
        curve->motors[i].steps = NULL;
        curve_commands_discard(&curve->motors[i].commands);
    }
    free(curve->outputs);
    curve->outputs = NULL;
}

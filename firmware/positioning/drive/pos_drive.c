#include "pos_drive.h"

#include <assert.h>

#include "base_tick.h"
#include "hal_time.h"

enum {
    AXIS = 0,                         /* of the path */
    LEAD_TICKS = 235 * TICKS_PER_US,  /* planning takes 0.15 ms beside four at their top rate, or more (bench) */
    GO_ON_TICKS = 700 * TICKS_PER_US, /* meanwhile the others are planned */
};

/* A section; and what of a measure may be left when there is room for the next one, so that none is short. */
#define SECTION_PULSES ((uint64_t)INT32_MAX)

void pos_drive_init(struct pos_drive *drive, unsigned motor)
{
    drive->motor = (uint8_t)motor;
    drive->measure = (struct pos_measure){.pulses = 0};
    drive->to_add = 0;
    drive->origin_steps = 0;
    drive->start_tick = 0;
    drive->wake_tick = 0;
    drive->room = 0;
    drive->speed = 0;
    drive->stirred = false;
    drive->stirred_at = UINT64_MAX;
    drive->noted = UINT64_MAX;
    drive->noted_speed = 0;
    step_channel_init(&drive->channel, motor);
    group_init(&drive->group, drive->ring, POS_DRIVE_SECTIONS);
    group_connect(&drive->group, motor, &drive->channel, AXIS);
}

static uint32_t positioning_speed_of(const void *context, uint32_t section)
{
    const struct pos_drive *drive = context;
    (void)section;
    return drive->speed;
}

/* The measure is handed over as far as there is room. */
static void add(struct pos_drive *drive)
{
    while (drive->to_add != 0U && group_room(&drive->group) != 0U) {
        uint64_t pulses = drive->to_add < SECTION_PULSES ? drive->to_add : SECTION_PULSES;
        const struct path_vector vector = {
            .steps = {[AXIS] = drive->measure.backward ? -(int32_t)pulses : (int32_t)pulses},
            .speed = drive->speed,
            .accel = drive->measure.accel,
            .extent2 = pulses * pulses,
            .border_speed = PATH_SPEED_MAX,
            .straight = drive->to_add != drive->measure.pulses,
        };
        bool added = group_add(&drive->group, &vector);
        assert(added);
        (void)added;
        drive->to_add -= pulses;
    }
}

void pos_drive_aim(struct pos_drive *drive, const struct pos_measure *measure)
{
    assert(measure->pulses <= POS_DRIVE_PULSES_MAX);
    group_forget(&drive->group);
    group_set_manner(&drive->group, &(struct group_manner){.start_speed = measure->start_speed,
                                                           .fault_accel = measure->fault_accel,
                                                           .before = &drive->before,
                                                           .lead_ticks = LEAD_TICKS,
                                                           .go_on_ticks = GO_ON_TICKS,
                                                           .between_steps = true});
    drive->measure = *measure;
    drive->origin_steps = pos_drive_steps(drive);
    drive->to_add = measure->pulses;
    drive->speed = 1;
    add(drive);
}

static uint64_t made(const struct pos_drive *drive)
{
    int64_t way = pos_drive_steps(drive) - drive->origin_steps;
    return (uint64_t)(drive->measure.backward ? -way : way);
}

static uint32_t speed_at(struct pos_drive *drive, uint64_t pulses)
{
    return group_speed_at(&drive->group, (uint32_t)(pulses / SECTION_PULSES), (uint32_t)(pulses % SECTION_PULSES));
}

/* Before it is planned anew. The path forgets how fast it was at a pulse, where it is changed again before the next. */
static void stir(struct pos_drive *drive)
{
    uint64_t pulses = made(drive);
    if (pulses == drive->stirred_at && pulses != drive->noted) {
        drive->noted_speed = speed_at(drive, pulses);
        drive->noted = pulses;
    }
    drive->stirred_at = pulses;
    drive->stirred = true;
}

void pos_drive_start(struct pos_drive *drive, uint32_t speed, uint64_t start_tick)
{
    drive->speed = speed;
    drive->start_tick = start_tick;
    drive->stirred = true;
    drive->stirred_at = UINT64_MAX;
    drive->noted = UINT64_MAX;
    group_set_speeds(&drive->group, &(struct group_speeds){.of = positioning_speed_of, .context = drive});
    bool started = group_start(&drive->group, start_tick);
    assert(started);
    (void)started;
}

void pos_drive_change(struct pos_drive *drive, uint32_t speed)
{
    drive->speed = speed;
    stir(drive);
    group_set_speeds(&drive->group, &(struct group_speeds){.of = positioning_speed_of, .context = drive});
}

void pos_drive_hold(struct pos_drive *drive)
{
    stir(drive);
    (void)group_stop(&drive->group, AXIS_CAUSE_PAUSE);
}

void pos_drive_fault(struct pos_drive *drive)
{
    stir(drive);
    (void)group_stop(&drive->group, AXIS_CAUSE_FAULT);
}

bool pos_drive_stop_isr(struct pos_drive *drive, bool fault)
{
    return group_stop_isr(&drive->group, fault ? AXIS_CAUSE_FAULT : AXIS_CAUSE_HIGH);
}

void pos_drive_plan_isr(struct pos_drive *drive)
{
    group_plan_isr(&drive->group);
}

bool pos_drive_resume(struct pos_drive *drive, uint32_t speed)
{
    if (group_cause(&drive->group) != AXIS_CAUSE_PAUSE) {
        return false;
    }
    pos_drive_change(drive, speed);
    return group_resume(&drive->group);
}

/* Whether nothing has happened since the last poll that would make the next one do something. */
static bool is_fed(const struct pos_drive *drive)
{
    return !drive->stirred && hal_time_now() < drive->wake_tick && step_channel_is_running(&drive->channel) &&
           step_channel_room(&drive->channel) == drive->room;
}

uint64_t pos_drive_poll(struct pos_drive *drive)
{
    if (!is_fed(drive)) {
        drive->stirred = false;
        drive->wake_tick = group_poll(&drive->group);
        add(drive);
        drive->room = step_channel_room(&drive->channel);
    }
    return drive->wake_tick;
}

bool pos_drive_take_end(struct pos_drive *drive)
{
    return group_take_end(&drive->group);
}

uint64_t pos_drive_end_tick(const struct pos_drive *drive)
{
    uint64_t rest_tick = group_end_tick(&drive->group);
    uint64_t pulse_tick = tick_extend(step_channel_end_tick(&drive->channel), rest_tick);
    return pulse_tick == rest_tick + 1U ? pulse_tick : rest_tick;
}

bool pos_drive_is_busy(const struct pos_drive *drive)
{
    return group_is_busy(&drive->group);
}

uint64_t pos_drive_left(const struct pos_drive *drive)
{
    return drive->measure.pulses - made(drive);
}

int64_t pos_drive_steps(const struct pos_drive *drive)
{
    return step_channel_position(&drive->channel);
}

int64_t pos_drive_steps_held(const struct pos_drive *drive)
{
    return step_channel_position_held(&drive->channel);
}

uint32_t pos_drive_speed(struct pos_drive *drive)
{
    if (!pos_drive_is_busy(drive) || hal_time_now() < drive->start_tick) {
        return 0;
    }
    uint64_t pulses = made(drive);
    return pulses == drive->noted ? drive->noted_speed : speed_at(drive, pulses);
}

#include "pos_frame.h"

void pos_frame_init(struct pos_frame *frame, const struct pos_scale *scale, uint32_t backlash_um)
{
    *frame = (struct pos_frame){.step = 0};
    pos_frame_reset(frame, scale, backlash_um, 0);
}

void pos_frame_reset(struct pos_frame *frame, const struct pos_scale *scale, uint32_t backlash_um, int64_t motor_steps)
{
    uint32_t backlash = (uint32_t)pos_measure_step(scale, backlash_um);
    frame->scale = *scale;
    if (backlash != frame->backlash) {
        frame->backlash = backlash;
        frame->motor_steps = motor_steps - frame->step - (int64_t)backlash;
    }
    frame->base_step = frame->step;
    frame->base_um = 0;
    frame->zero_step = frame->step;
    frame->zero_um = 0;
    frame->referenced = false;
}

int64_t pos_frame_step_of(const struct pos_frame *frame, int64_t motor_steps)
{
    int64_t highest = motor_steps - frame->motor_steps;
    int64_t lowest = highest - (int64_t)frame->backlash;
    if (frame->step < lowest) {
        return lowest;
    }
    return frame->step > highest ? highest : frame->step;
}

void pos_frame_follow(struct pos_frame *frame, int64_t motor_steps)
{
    frame->step = pos_frame_step_of(frame, motor_steps);
}

int64_t pos_frame_position_um(const struct pos_frame *frame, int64_t step)
{
    return frame->zero_um + pos_measure_um(&frame->scale, step - frame->zero_step);
}

static void aim(const struct pos_frame *frame, int64_t base_step, int64_t base_um, struct pos_target *target)
{
    *target = (struct pos_target){
        .step = base_step + pos_measure_step(&frame->scale, base_um), .base_step = base_step, .base_um = base_um};
}

bool pos_frame_may_aim(const struct pos_frame *frame, int32_t way_um)
{
    int64_t base_um = frame->base_um + way_um;
    return base_um <= POS_MEASURE_UM_MAX && base_um >= -POS_MEASURE_UM_MAX;
}

void pos_frame_aim(const struct pos_frame *frame, int32_t way_um, struct pos_target *target)
{
    aim(frame, frame->base_step, frame->base_um + way_um, target);
}

void pos_frame_aim_at(const struct pos_frame *frame, int32_t position_um, struct pos_target *target)
{
    aim(frame, frame->zero_step, position_um - frame->zero_um, target);
}

void pos_frame_limit(const struct pos_frame *frame, struct pos_target *target, int64_t min_um, int64_t max_um)
{
    int64_t last = frame->zero_step + pos_measure_last_step(&frame->scale, max_um - frame->zero_um);
    int64_t first = frame->zero_step + pos_measure_first_step(&frame->scale, min_um - frame->zero_um);
    if (target->step > frame->step && target->step > last) {
        target->step = last > frame->step ? last : frame->step;
        target->cut = true;
    } else if (target->step < frame->step && target->step < first) {
        target->step = first < frame->step ? first : frame->step;
        target->cut = true;
    } else {
        /* it is inside, or as far inwards as was told */
    }
}

struct pos_way pos_frame_way(const struct pos_frame *frame, int64_t motor_steps, int64_t step)
{
    int64_t motor_target = step + frame->motor_steps;
    if (step > frame->step) {
        return (struct pos_way){.pulses = (uint64_t)(motor_target + (int64_t)frame->backlash - motor_steps)};
    }
    bool backward = step < frame->step;
    return (struct pos_way){.pulses = backward ? (uint64_t)(motor_steps - motor_target) : 0U, .backward = backward};
}

int64_t pos_frame_left_um(const struct pos_frame *frame, const struct pos_target *target)
{
    int64_t end_um = target->cut ? pos_measure_um(&frame->scale, target->step - target->base_step) : target->base_um;
    return end_um - pos_measure_um(&frame->scale, frame->step - target->base_step);
}

void pos_frame_reach(struct pos_frame *frame, const struct pos_target *target)
{
    frame->base_step = target->base_step;
    frame->base_um = target->base_um;
}

void pos_frame_give_up(struct pos_frame *frame)
{
    if (frame->step != frame->base_step + pos_measure_step(&frame->scale, frame->base_um)) {
        frame->base_step = frame->step;
        frame->base_um = 0;
    }
}

void pos_frame_refer(struct pos_frame *frame, int64_t step, int64_t position_um)
{
    frame->zero_step = step;
    frame->zero_um = position_um;
    frame->base_step = step;
    frame->base_um = 0;
    frame->referenced = true;
}

#include "pos_watch.h"

#include "pos_drive.h"

bool pos_watch_is_active(int32_t input, uint8_t inputs)
{
    if (input == 0) {
        return false;
    }
    bool high = input > 0;
    unsigned bit = (unsigned)(high ? input : -input) - 1U;
    return (((unsigned)inputs >> bit & 1U) != 0) == high;
}

static void tell(struct pos_watch *watch)
{
    atomic_store_explicit(&watch->happened, true, memory_order_relaxed);
}

/* Whether what is sought has been found. */
static bool seek(struct pos_watch *watch, bool active)
{
    bool was_active = watch->reference_was_active;
    watch->reference_was_active = active;
    if (watch->seek == (uint8_t)POS_SEEK_ACTIVE) {
        return active;
    }
    return watch->seek == (uint8_t)POS_SEEK_INACTIVE && was_active && !active;
}

static void sense_capture(struct pos_watch *watch, const struct pos_drive *drive, bool active)
{
    if (watch->armed && active && !watch->capture_was_active) {
        watch->armed = false;
        watch->captured = true;
        tell(watch);
        watch->captured_motor_steps = pos_drive_steps(drive);
    }
    watch->capture_was_active = active;
}

bool pos_watch_sense_isr(struct pos_watch *watch, struct pos_drive *drive, uint8_t inputs)
{
    bool stops = false;
    sense_capture(watch, drive, pos_watch_is_active(watch->capture, inputs));
    if (seek(watch, pos_watch_is_active(watch->reference, inputs))) {
        watch->seek = (uint8_t)POS_SEEK_NOTHING;
        watch->reference_hit = true;
        tell(watch);
        watch->reference_motor_steps = pos_drive_steps(drive);
        stops = pos_drive_stop_isr(drive, false);
    }
    if (pos_watch_is_active(watch->limit, inputs) && pos_drive_stop_isr(drive, true)) {
        watch->limit_hit = true;
        tell(watch);
        stops = true;
    }
    return stops;
}

#include "thin.h"

#include <assert.h>
#include <stdlib.h>

bool thin_begin(struct thin *thin, uint32_t points)
{
    assert(points >= THIN_POINTS_PER_COLUMN);
    /* One point more than may stay is there before columns are widened. */
    *thin = (struct thin){.columns = malloc((points + (size_t)1) * sizeof *thin->columns), .points_max = points};
    return thin->columns != NULL;
}

static uint32_t at_most_all(uint32_t points)
{
    return points < THIN_POINTS_PER_COLUMN ? points : THIN_POINTS_PER_COLUMN;
}

static struct thin_point *first_of(bool keep, struct thin_point *kept, struct thin_point *other)
{
    return keep ? kept : other;
}

/* `other` follows `column`. */
static void merge(struct thin_column *column, struct thin_column *other)
{
    struct thin_column *c = column;
    struct thin_column *o = other;
    c->taken = at_most_all(c->taken + o->taken);
    c->last = o->last;
    c->slowest = *first_of(c->slowest.milli_speed <= o->slowest.milli_speed, &c->slowest, &o->slowest);
    c->fastest = *first_of(c->fastest.milli_speed >= o->fastest.milli_speed, &c->fastest, &o->fastest);
    c->lowest = *first_of(c->lowest.position <= o->lowest.position, &c->lowest, &o->lowest);
    c->highest = *first_of(c->highest.position >= o->highest.position, &c->highest, &o->highest);
}

/* Takes the last point where it exceeds the others. Of points that go on in one direction only the last one can, so it
 * waits until the next one, of this speed and position, does not go on. */
static void take_last(struct thin_column *column, int64_t milli_speed, int64_t position)
{
    const struct thin_point *last = &column->last;
    if (milli_speed >= last->milli_speed && last->milli_speed < column->slowest.milli_speed) {
        column->slowest = *last;
    }
    if (milli_speed <= last->milli_speed && last->milli_speed > column->fastest.milli_speed) {
        column->fastest = *last;
    }
    if (position >= last->position && last->position < column->lowest.position) {
        column->lowest = *last;
    }
    if (position <= last->position && last->position > column->highest.position) {
        column->highest = *last;
    }
}

/* No point of the column follows. */
static void close_column(struct thin_column *column)
{
    take_last(column, column->last.milli_speed, column->last.position);
}

/* Makes the columns twice as wide. */
static void widen(struct thin *thin)
{
    uint32_t count = 0;
    close_column(&thin->columns[thin->count - 1U]);
    thin->shift++;
    thin->points = 0;
    for (uint32_t i = 0; i < thin->count; i++) {
        struct thin_column column = thin->columns[i];
        column.index >>= 1U;
        if (count > 0 && thin->columns[count - 1U].index == column.index) {
            merge(&thin->columns[count - 1U], &column);
        } else {
            thin->columns[count++] = column;
        }
    }
    thin->count = count;
    for (uint32_t i = 0; i < count; i++) {
        thin->points += thin->columns[i].taken;
    }
}

static bool is_in_last(const struct thin *thin, uint64_t tick)
{
    return thin->count > 0 && thin->columns[thin->count - 1U].index == tick >> thin->shift;
}

static void begin_column(struct thin *thin, const struct thin_point *given)
{
    struct thin_point point = *given;
    point.ordinal = thin->ordinals;
    if (thin->count > 0) {
        close_column(&thin->columns[thin->count - 1U]);
    }
    thin->columns[thin->count++] =
        (struct thin_column){point.tick >> thin->shift, 1, point, point, point, point, point, point};
}

void thin_put(struct thin *thin, const struct thin_point *point)
{
    bool is_one_more = true;
    if (is_in_last(thin, point->tick)) {
        struct thin_column *column = &thin->columns[thin->count - 1U];
        take_last(column, point->milli_speed, point->position);
        column->last = *point;
        column->last.ordinal = thin->ordinals;
        is_one_more = column->taken < THIN_POINTS_PER_COLUMN;
        column->taken += is_one_more ? 1U : 0U;
    } else {
        begin_column(thin, point);
    }
    thin->ordinals++;
    thin->points += is_one_more ? 1U : 0U;
    while (thin->points > thin->points_max) {
        widen(thin);
    }
}

/* Puts a point at its place among those of its column, if it is not there yet. */
static unsigned insert(struct thin_point *points, unsigned count, const struct thin_point *point)
{
    unsigned at = count;
    while (at > 0 && points[at - 1U].ordinal > point->ordinal) {
        at--;
    }
    if (at > 0 && points[at - 1U].ordinal == point->ordinal) {
        return count;
    }
    for (unsigned i = count; i > at; i--) {
        points[i] = points[i - 1U];
    }
    points[at] = *point;
    return count + 1U;
}

unsigned thin_list_column(const struct thin_column *column, struct thin_point points[THIN_POINTS_PER_COLUMN])
{
    struct thin_column closed = *column;
    close_column(&closed);
    const struct thin_point *all[THIN_POINTS_PER_COLUMN] = {
        &closed.first, &closed.slowest, &closed.fastest, &closed.lowest, &closed.highest, &closed.last,
    };
    unsigned count = 0;
    for (unsigned i = 0; i < THIN_POINTS_PER_COLUMN; i++) {
        count = insert(points, count, all[i]);
    }
    return count;
}

void thin_discard(struct thin *thin)
{
    free(thin->columns);
    *thin = (struct thin){.columns = NULL};
}

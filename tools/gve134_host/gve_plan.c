#include "gve_plan.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gve_command.h"
#include "gve_file.h"
#include "gve_speeds.h"
#include "outfile.h"
#include "path.h"
#include "path_lay.h"
#include "path_look.h"

#define PAUSE_MARK ";@pause"

enum {
    RING = 128, /* vectors that the unit looks ahead */
    TURN_US = 12,
    PLANE_AXES = 2, /* those of the course */
    LINE_ROOM = 4096,
    MS_PER_S = 1000,
    ACCEL_UNIT = 1000,
};

struct planner {
    struct gve_modal modal;
    struct gve_vector before;
    struct path path;
    struct path_section ring[RING];
    double scale[GVE_PLAN_SCALES];
    bool moves; /* the chain has left its stand */

    struct outfile course;
    double place[PLANE_AXES]; /* pulses */

    uint64_t vectors;
    uint64_t chains;
    uint64_t runs;
    uint64_t pauses;
    double seconds;
    double peak_mm;
    double peak[PATH_AXES];
};

static double larger(double a, double b)
{
    return a > b ? a : b;
}

/* The highest speed in a section that has been laid: at one of its corners. */
static double peak_of(struct path *path, uint32_t count)
{
    const struct path_course *course = path_lay_course(path, count);
    uint64_t most = 2U * path_section_of(path, count)->leave2;
    for (unsigned leg = 0; leg < course->legs; leg++) {
        most = course->leg[leg].twice_speed2 > most ? course->leg[leg].twice_speed2 : most;
    }
    return sqrt((double)most / 2) / PATH_SPEED_UNITS;
}

static void note_peaks(struct planner *planner, const struct path_section *section, double speed)
{
    double way2 = 0;
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        double part = fabs((double)section->vector.steps[axis]) / section->length;
        planner->peak[axis] = larger(planner->peak[axis], speed * part);
        if (axis < (unsigned)GVE_PLAN_SCALES) {
            way2 += part * part / (planner->scale[axis] * planner->scale[axis]);
        }
    }
    planner->peak_mm = larger(planner->peak_mm, speed * sqrt(way2));
}

static void put_place(struct planner *planner, double seconds)
{
    double row[PLANE_AXES + 1];
    char *room = outfile_reserve(&planner->course, sizeof row);
    for (unsigned axis = 0; axis < (unsigned)PLANE_AXES; axis++) {
        row[axis] = planner->place[axis] / planner->scale[axis];
    }
    row[PLANE_AXES] = seconds;
    memcpy(room, row, sizeof row);
    outfile_commit(&planner->course, room + sizeof row);
}

static void note_course(struct planner *planner, const struct path_section *section, struct wide end)
{
    if (!outfile_is_open(&planner->course)) {
        return;
    }
    struct wide ticks = wide_subtract(end, section->entered);
    for (unsigned axis = 0; axis < (unsigned)PLANE_AXES; axis++) {
        planner->place[axis] += section->vector.steps[axis];
    }
    put_place(planner, ((double)ticks.high + ldexp((double)ticks.low, -64)) / TICK_HZ);
}

static void begin_chain(struct planner *planner)
{
    if (outfile_is_open(&planner->course)) {
        put_place(planner, (double)NAN);
    }
    bool started = path_start(&planner->path, 0);
    (void)started;
    planner->moves = true;
    planner->chains++;
    planner->seconds += (double)planner->modal.pause_ms / (double)MS_PER_S;
}

static void lay_section(struct planner *planner)
{
    uint32_t count = planner->path.laid;
    path_lay_next(&planner->path);
    const struct path_section *section = path_section_of(&planner->path, count);
    note_peaks(planner, section, peak_of(&planner->path, count));
    note_course(planner, section, path_lay_course(&planner->path, count)->end_time);
}

/* The unit stands when all that it has been told is done. */
static void end_chain(struct planner *planner)
{
    struct path *path = &planner->path;
    if (path->end == path->first) {
        return;
    }
    if (!planner->moves) {
        begin_chain(planner);
    }
    while (!path_is_laid(path)) {
        lay_section(planner);
    }
    planner->seconds += (double)path->rest.entry.time.high / TICK_HZ;
    planner->moves = false;
    path_init(path, planner->ring, RING, TURN_US);
}

static void make_room(struct planner *planner)
{
    struct path *path = &planner->path;
    if (!planner->moves) {
        begin_chain(planner);
    }
    if (path->laid - path->first > 1U) {
        path_drop(path, path->laid - 1U); /* the last one that was laid is still asked for */
    }
    lay_section(planner);
    path_drop(path, path->laid - 1U);
}

static void enter(struct planner *planner, const int32_t steps[PATH_AXES])
{
    struct path *path = &planner->path;
    struct gve_vector vector = gve_speeds_take(&planner->modal, steps);
    struct path_vector added = {
        .speed = gve_speeds_limit(&vector, GVE_FACTOR_ONE, planner->modal.limit),
        .accel = vector.accel * (uint32_t)ACCEL_UNIT * STEP_ACCEL_PER_ACCEL,
        .extent2 = gve_speeds_extent2(&vector),
        .border_speed = PATH_SPEED_MAX,
    };
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        added.steps[axis] = steps[axis];
    }
    if (path->end != path->first) {
        added.border_speed = gve_speeds_border(&planner->before, &vector, planner->modal.jump);
    }
    while (!path_add(path, &added)) {
        make_room(planner);
    }
    planner->before = vector;
    planner->vectors++;
}

static void take_vector(struct planner *planner, const struct gve_command *command)
{
    const int32_t *steps = command->numbers;
    bool rests = steps[0] == 0 && steps[1] == 0 && steps[2] == 0 && steps[3] == 0;
    if (command->opcode == GVE_LINE) {
        end_chain(planner);
    }
    if (!rests) {
        enter(planner, steps);
    }
}

static void take_axes(uint32_t values[PATH_AXES], const struct gve_command *command)
{
    for (unsigned axis = 0; axis < (unsigned)PATH_AXES; axis++) {
        values[axis] = (uint32_t)command->numbers[axis];
    }
}

static void take(struct planner *planner, const struct gve_command *command)
{
    uint32_t number = (uint32_t)command->numbers[0];
    switch (command->opcode) {
    case GVE_LINE:
    case GVE_CONTINUE:
        take_vector(planner, command);
        break;
    case GVE_PAUSE:
        planner->modal.pause_ms = number;
        break;
    case GVE_SHORT:
        planner->modal.short_pulses = number;
        break;
    case GVE_ACCELERATION:
        planner->modal.accel = number;
        break;
    case GVE_SPEED:
        planner->modal.speed = number;
        break;
    case GVE_BRAKE:
        planner->modal.brake = number;
        break;
    case GVE_CORRECTED:
    case GVE_UNCORRECTED:
        planner->modal.corrected = command->opcode == GVE_CORRECTED;
        break;
    case GVE_LIMITS:
        take_axes(planner->modal.limit, command);
        break;
    case GVE_JUMPS:
        take_axes(planner->modal.jump, command);
        break;
    case GVE_REFERENCE:
        end_chain(planner);
        planner->runs++;
        break;
    case GVE_SET_POSITION:
        end_chain(planner);
        if (number < (uint32_t)PLANE_AXES) {
            planner->place[number] = command->numbers[1];
        }
        break;
    default:
        break;
    }
}

/* False after a complaint. */
static bool take_line(struct planner *planner, const char *text, uint64_t number)
{
    struct infile one = {.path = "-", .bytes = (uint8_t *)(uintptr_t)text, .length = (uint32_t)strlen(text)};
    struct gve_file lines = gve_file_of(&one);
    struct gve_file_line line = {0};
    if (strncmp(text, PAUSE_MARK, strlen(PAUSE_MARK)) == 0) {
        planner->pauses++;
    }
    if (!gve_file_next(&lines, &line) || line.probes) {
        return true;
    }
    uint32_t length = line.length <= (uint32_t)GVE_TEXT_BYTES_MAX ? line.length : 0;
    struct gve_reading reading = gve_command_read(line.text, length, (enum gve_address)line.address);
    if (line.wrong != NULL || reading.fault != GVE_FAULT_NONE) {
        complain("line %" PRIu64 ": %s; gve134 check tells more", number,
                 line.wrong != NULL ? line.wrong : gve_fault_text(reading.fault));
        return false;
    }
    take(planner, &reading.command);
    return true;
}

static enum exit_status print_plan(const struct planner *planner)
{
    (void)printf("{\"vectors\":%" PRIu64 ",\"chains\":%" PRIu64 ",\"seconds\":%.6f,\"peak_mm_per_s\":%.6f,",
                 planner->vectors, planner->chains, planner->seconds, planner->peak_mm);
    (void)printf("\"peaks\":[%.3f,%.3f,%.3f,%.3f],\"runs\":%" PRIu64 ",\"pauses\":%" PRIu64 "}\n", planner->peak[0],
                 planner->peak[1], planner->peak[2], planner->peak[3], planner->runs, planner->pauses);
    return finish_output();
}

/* False after a complaint. */
static bool take_input(struct planner *planner)
{
    char line[LINE_ROOM];
    for (uint64_t number = 1; fgets(line, sizeof line, stdin) != NULL; number++) {
        if (!take_line(planner, line, number)) {
            return false;
        }
    }
    end_chain(planner);
    return outfile_close(&planner->course) && outfile_publish(&planner->course);
}

enum exit_status gve_plan_input(char *const scales[GVE_PLAN_SCALES], const char *course_path)
{
    static struct planner planner;
    gve_modal_init(&planner.modal);
    path_init(&planner.path, planner.ring, RING, TURN_US);
    for (unsigned axis = 0; axis < (unsigned)GVE_PLAN_SCALES; axis++) {
        planner.scale[axis] = strtod(scales[axis], NULL);
        if (!(planner.scale[axis] > 0)) {
            complain("%s are no pulses a mm; write a number above 0", scales[axis]);
            return EXIT_USAGE;
        }
    }
    if (!outfile_open(&planner.course, course_path)) {
        return EXIT_REFUSED;
    }
    enum exit_status status = take_input(&planner) ? print_plan(&planner) : EXIT_REFUSED;
    outfile_discard(&planner.course);
    return status;
}

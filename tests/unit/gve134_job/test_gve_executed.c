/* How many vectors of a job are over, told from positions: never too many. */
#include "unity.h"

#include <stdio.h>
#include <string.h>

#include "gve_executed.h"
#include "gve_queue.h"

enum {
    AXES = GVE_EXECUTED_AXES,
    TRIALS = 2000,
    PATH_VECTORS = 40,
};

static struct gve_executed executed;

static void begin(int32_t x, int32_t y, int32_t z, int32_t a)
{
    gve_executed_init(&executed, (const int32_t[]){x, y, z, a});
}

void setUp(void)
{
    memset(&executed, 0xA5, sizeof executed);
    begin(0, 0, 0, 0);
}

void tearDown(void)
{
}

static void take(const char *commands)
{
    gve_executed_take(&executed, (const uint8_t *)commands, (uint32_t)strlen(commands));
}

static void take_times(const char *command, unsigned times)
{
    for (unsigned i = 0; i < times; i++) {
        take(command);
    }
}

static uint32_t look_with(const char *perhaps, int32_t x, int32_t y, int32_t z, int32_t a)
{
    return gve_executed_look(&executed, (const int32_t[]){x, y, z, a}, (const uint8_t *)perhaps,
                             (uint32_t)strlen(perhaps));
}

static uint32_t look(int32_t x, int32_t y, int32_t z, int32_t a)
{
    return look_with("", x, y, z, a);
}

static void assert_place(int32_t x, int32_t y, int32_t z, int32_t a)
{
    const uint32_t place[] = {(uint32_t)x, (uint32_t)y, (uint32_t)z, (uint32_t)a};
    TEST_ASSERT_EQUAL_HEX32_ARRAY(place, executed.place, AXES);
}

void test_it_follows_as_many_vectors_as_the_queue_has_places(void)
{
    TEST_ASSERT_EQUAL_UINT(GVE_QUEUE_VECTORS, GVE_EXECUTED_PLACES);
}

void test_of_a_path_it_tells_the_vector_on_which_the_axes_are(void)
{
    take("C10,0,0,0\nC0,10,0,0\nB100\nC10,10,0,0");
    TEST_ASSERT_EQUAL_UINT(0, look(0, 0, 0, 0));
    TEST_ASSERT_EQUAL_UINT(0, look(9, 0, 0, 0));
    TEST_ASSERT_EQUAL_UINT(1, look(10, 0, 0, 0));
    TEST_ASSERT_EQUAL_UINT(1, look(10, 7, 0, 0));
    TEST_ASSERT_EQUAL_UINT(2, look(15, 15, 0, 0));
    assert_place(10, 10, 0, 0);
    TEST_ASSERT_EQUAL_UINT(3, look(20, 20, 0, 0));
    TEST_ASSERT_EQUAL_UINT(3, gve_executed_done(&executed));
}

void test_a_place_is_on_a_vector_only_as_the_pulses_are_made(void)
{
    take("C4,2,0,-1\nC100,0,0,0");
    TEST_ASSERT_EQUAL_UINT(0, look(3, 1, 0, 0));
    TEST_ASSERT_EQUAL_UINT(1, look(4, 2, 0, -1));

    static const int32_t off[][AXES] = {{3, 2, 0, 0}, {3, 1, 0, -1}, {3, 1, 1, 0}, {3, 1, 0, 1}};
    for (unsigned i = 0; i < 4; i++) {
        begin(0, 0, 0, 0);
        take("C4,2,0,-1\nC1,1,1,1");
        const int32_t *at = off[i];
        TEST_ASSERT_EQUAL_UINT(0, look(at[0], at[1], at[2], at[3]));
        TEST_ASSERT_EQUAL_UINT(0, executed.gone);
    }
}

void test_parts_of_the_longest_vectors_are_told_apart(void)
{
    take("C2147483647,2147483646,0,0\nC1,0,0,0");
    TEST_ASSERT_EQUAL_UINT(0, look(2147483646, 2147483645, 0, 0));
    TEST_ASSERT_EQUAL_UINT64(4294967291, executed.gone);
    TEST_ASSERT_EQUAL_UINT(0, look(1, 1, 0, 0));
    TEST_ASSERT_EQUAL_UINT64(4294967291, executed.gone);
    TEST_ASSERT_EQUAL_UINT(0, look(2147483646, 2147483646, 0, 0));
    TEST_ASSERT_EQUAL_UINT64(4294967291, executed.gone);
    TEST_ASSERT_EQUAL_UINT(1, look(2147483647, 2147483646, 0, 0));
}

void test_positions_are_told_modulo_2_to_the_32(void)
{
    begin(INT32_MAX - 5, INT32_MIN + 5, 0, 0);
    take("C10,-10,0,0\nC10,-10,0,0");
    TEST_ASSERT_EQUAL_UINT(0, look(INT32_MIN + 2, INT32_MAX - 2, 0, 0));
    TEST_ASSERT_EQUAL_UINT(1, look(INT32_MIN + 6, INT32_MAX - 6, 0, 0));
    assert_place(INT32_MIN + 4, INT32_MAX - 4, 0, 0);
}

void test_axes_that_go_back_are_on_the_next_vector(void)
{
    take("C9,0,0,0\nC-9,0,0,0\nC9,0,0,0");
    TEST_ASSERT_EQUAL_UINT(0, look(2, 0, 0, 0));
    TEST_ASSERT_EQUAL_UINT(0, look(6, 0, 0, 0));
    TEST_ASSERT_EQUAL_UINT(0, look(6, 0, 0, 0));
    TEST_ASSERT_EQUAL_UINT(1, look(5, 0, 0, 0));
    TEST_ASSERT_EQUAL_UINT(1, look(1, 0, 0, 0));
    TEST_ASSERT_EQUAL_UINT(2, look(4, 0, 0, 0));
}

void test_a_vector_after_one_that_is_over_is_looked_at_from_its_begin(void)
{
    take("C100,0,0,0\nC5,0,0,0\nC-5,0,0,0");
    TEST_ASSERT_EQUAL_UINT(1, look(100, 0, 0, 0));
    TEST_ASSERT_EQUAL_UINT(1, look(103, 0, 0, 0));

    begin(0, 0, 0, 0);
    take("C100,0,0,0");
    TEST_ASSERT_EQUAL_UINT(0, look(50, 0, 0, 0));
    take("L5,0,0,0\nC-5,0,0,0");
    TEST_ASSERT_EQUAL_UINT(1, look(103, 0, 0, 0));
}

void test_a_place_on_no_vector_changes_nothing(void)
{
    take("C9,0,0,0\nC9,0,0,0");
    TEST_ASSERT_EQUAL_UINT(1, look(10, 0, 0, 0));
    TEST_ASSERT_EQUAL_UINT(1, look(-500, 0, 0, 0));
    TEST_ASSERT_EQUAL_UINT(2, look(18, 0, 0, 0));
}

void test_an_axis_that_the_job_does_not_move_is_no_matter(void)
{
    take("C5,0,0,0\nC5,0,0,0");
    TEST_ASSERT_EQUAL_UINT(1, look(7, 0, 0, 7));
}

void test_what_the_queue_cannot_hold_is_over(void)
{
    take_times("C1,0,0,0", GVE_EXECUTED_PLACES);
    TEST_ASSERT_EQUAL_UINT(0, gve_executed_done(&executed));
    take_times("C1,0,0,0", 3);
    TEST_ASSERT_EQUAL_UINT(3, gve_executed_done(&executed));
    assert_place(3, 0, 0, 0);
    TEST_ASSERT_EQUAL_UINT(131, look(131, 0, 0, 0));
}

void test_vectors_without_pulses_take_no_place_however_many_they_are(void)
{
    take_times("C1,0,0,0", 100);
    take_times("C0,0,0,0", 5000);
    take_times("C1,0,0,0", 28);
    TEST_ASSERT_EQUAL_UINT(0, gve_executed_done(&executed));
    TEST_ASSERT_EQUAL_UINT(99, look(99, 0, 0, 0));
    TEST_ASSERT_EQUAL_UINT(5100, look(100, 0, 0, 0));
    TEST_ASSERT_EQUAL_UINT(5128, look(128, 0, 0, 0));
}

void test_vectors_without_pulses_are_over_where_nothing_waits(void)
{
    take("C0,0,0,0\nL0,0,0,0");
    TEST_ASSERT_EQUAL_UINT(2, gve_executed_done(&executed));
    take("C5,0,0,0\nC0,0,0,0");
    TEST_ASSERT_EQUAL_UINT(2, gve_executed_done(&executed));
}

void test_each_vector_is_counted_once_in_the_end(void)
{
    take_times("C1,0,0,0\nC0,0,0,0", 300);
    TEST_ASSERT_EQUAL_UINT(2 * (300 - GVE_EXECUTED_PLACES), gve_executed_done(&executed));
    TEST_ASSERT_EQUAL_UINT(600, look(300, 0, 0, 0));
}

void test_before_an_l_all_is_over(void)
{
    take("C5,0,0,0\nC5,0,0,0\nL5,0,0,0");
    TEST_ASSERT_EQUAL_UINT(2, gve_executed_done(&executed));
    assert_place(10, 0, 0, 0);
}

void test_before_an_n_all_is_over_and_positions_count_anew(void)
{
    take("C5,6,0,0\nNX-70");
    TEST_ASSERT_EQUAL_UINT(1, gve_executed_done(&executed));
    assert_place(-70, 6, 0, 0);
    take("C5,0,0,0\nN");
    TEST_ASSERT_EQUAL_UINT(2, gve_executed_done(&executed));
    assert_place(0, 0, 0, 0);
    take("C5,0,0,0");
    TEST_ASSERT_EQUAL_UINT(2, look(2, 0, 0, 0));
}

void test_axes_that_stand_have_executed_all(void)
{
    take("C5,0,0,0\nC5,0,0,0");
    gve_executed_stand(&executed, (const int32_t[]){8, -1, 2, 3});
    TEST_ASSERT_EQUAL_UINT(2, gve_executed_done(&executed));
    assert_place(8, -1, 2, 3);
}

void test_what_drops_vectors_or_changes_their_place_makes_the_number_unknown(void)
{
    static const char *const commands[] = {"D", "K", "R", "J", "!7J", "WX5,10,5,10"};
    for (unsigned i = 0; i < sizeof commands / sizeof commands[0]; i++) {
        begin(0, 0, 0, 0);
        take("C5,0,0,0");
        take(commands[i]);
        take("C5,0,0,0");
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(GVE_EXECUTED_UNKNOWN, look(5, 0, 0, 0), commands[i]);
        TEST_ASSERT_EQUAL_HEX32(GVE_EXECUTED_UNKNOWN, gve_executed_done(&executed));
    }
}

void test_other_commands_change_nothing(void)
{
    take("C5,0,0,0\nV1000\n!7V300\nO0,FB\nH\nG\nXU\nL1,2,3,4,5\nC\nC5,0,0,0");
    TEST_ASSERT_EQUAL_UINT(0, gve_executed_done(&executed));
    TEST_ASSERT_EQUAL_UINT(1, look(7, 0, 0, 0));
}

void test_a_number_that_was_lost_stays_unknown(void)
{
    gve_executed_lose(&executed);
    take("L5,0,0,0");
    gve_executed_stand(&executed, (const int32_t[]){5, 0, 0, 0});
    TEST_ASSERT_EQUAL_HEX32(GVE_EXECUTED_UNKNOWN, look(5, 0, 0, 0));
}

/* ---- what was perhaps taken ---- */

void test_axes_on_what_was_perhaps_taken_have_executed_all_before(void)
{
    take("C5,0,0,0");
    TEST_ASSERT_EQUAL_UINT(3, look_with("C0,5,0,0\nB50\nC1,1,0,0\nC7,0,0,0", 8, 6, 0, 0));
    TEST_ASSERT_EQUAL_UINT(1, gve_executed_done(&executed));
    take("C0,5,0,0\nC1,1,0,0\nC7,0,0,0");
    TEST_ASSERT_EQUAL_UINT(3, look(8, 6, 0, 0));
}

void test_an_l_that_was_perhaps_taken_counts_as_others_do(void)
{
    take("C5,0,0,0");
    TEST_ASSERT_EQUAL_UINT(1, look_with("L5,0,0,0", 7, 0, 0, 0));
}

void test_of_what_was_perhaps_taken_nothing_is_over_where_the_axes_stand_before_it(void)
{
    take("C5,0,0,0");
    TEST_ASSERT_EQUAL_UINT(1, look_with("C0,0,0,0\nC0,0,0,0\nC0,0,3,0", 5, 0, 0, 0));
    TEST_ASSERT_EQUAL_UINT(1, look_with("C0,0,0,0\nC0,0,0,0\nC0,0,3,0", 5, 0, 0, 0));
}

void test_an_axis_that_only_what_was_perhaps_taken_moves_counts(void)
{
    take("L0,1,0,0");
    TEST_ASSERT_EQUAL_UINT(1, look_with("C3,2,0,0\nC0,-1,0,0", 2, 2, 0, 0));
}

/* ---- any path ---- */

static uint64_t seed;

static uint32_t random_below(uint32_t limit)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)(seed >> 33) % limit;
}

static int32_t random_step(void)
{
    return random_below(3) == 0 ? 0 : (int32_t)random_below(19) - 9;
}

static uint32_t longest(const int32_t steps[AXES])
{
    uint32_t found = 0;
    for (unsigned axis = 0; axis < (unsigned)AXES; axis++) {
        uint32_t length = (uint32_t)(steps[axis] < 0 ? -steps[axis] : steps[axis]);
        found = length > found ? length : found;
    }
    return found;
}

/* Axes somewhere on a vector, but at its end. */
static uint32_t look_on(const int32_t begins[AXES], const int32_t steps[AXES], const char *perhaps)
{
    uint32_t length = longest(steps);
    uint32_t part = random_below(100 * length);
    int32_t at[AXES];
    for (unsigned axis = 0; axis < (unsigned)AXES; axis++) {
        at[axis] = begins[axis] + steps[axis] * (int32_t)part / (int32_t)(100 * length);
    }
    return look_with(perhaps, at[0], at[1], at[2], at[3]);
}

/* On a path of which the unit takes a few vectors at a time, some of them before it is known. */
static void follow_path(void)
{
    int32_t place[AXES] = {0};
    begin(0, 0, 0, 0);
    for (uint32_t made = 0; made < (uint32_t)PATH_VECTORS;) {
        char text[40];
        int32_t steps[AXES];
        for (unsigned axis = 0; axis < (unsigned)AXES; axis++) {
            steps[axis] = random_step();
        }
        (void)snprintf(text, sizeof text, "C%d,%d,%d,%d", (int)steps[0], (int)steps[1], (int)steps[2], (int)steps[3]);
        bool known = random_below(2) == 0;
        if (known) {
            take(text);
        }
        if (longest(steps) > 0) {
            TEST_ASSERT_LESS_OR_EQUAL_UINT(made, look_on(place, steps, known ? "" : text));
        }
        if (!known) {
            take(text);
        }
        for (unsigned axis = 0; axis < (unsigned)AXES; axis++) {
            place[axis] += steps[axis];
        }
        made++;
        TEST_ASSERT_LESS_OR_EQUAL_UINT(made, look(place[0], place[1], place[2], place[3]));
    }
    gve_executed_stand(&executed, place);
    TEST_ASSERT_EQUAL_UINT(PATH_VECTORS, gve_executed_done(&executed));
}

void test_on_any_path_never_more_are_told_than_are_over(void)
{
    for (uint32_t trial = 0; trial < (uint32_t)TRIALS; trial++) {
        seed = trial;
        follow_path();
    }
}

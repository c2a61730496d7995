/* What each command does in each state. */
#include "gve_rig.h"

enum state {
    REST,
    WORK,
    BRAKING,
    ENDED,
    WAITING,
    LOCKED,
    STATES,
};

/* Commands, and for each state the answer and then ST6 with its answer's digit; NULL: as it was. */
struct row {
    const char *command;
    const char *answer[STATES];
    const char *flags[STATES];
};

static const char *const flags_of_state[STATES] = {"0,00", "0,40", "0,41", "8,90", "8,D0", "8,88"};
static const char *const name_of_state[STATES] = {"rest", "work", "braking", "ended", "waiting", "locked"};

/* clang-format off */
static const struct row rows[] = {
    {"0L100", {"0", "1", "1", "8", "9", "F"}, {"0,40", NULL, NULL, "8,D0", NULL, NULL}},
    {"0L0,0,0", {"0", "1", "1", "8", "9", "F"}, {0}},
    {"0C100", {"0", "0", "0", "8", "8", "F"}, {"0,40", NULL, NULL, "8,D0", NULL, NULL}},
    {"0C0,0,0", {"0", "0", "0", "8", "8", "F"}, {0}},
    {"0WX-50,1000,50,1000", {"D", "7", "7", "F", "F", "F"}, {"8,80", NULL, NULL, NULL, NULL, NULL}},
    {"0N", {"0", "7", "7", "8", "F", "8"}, {0}},
    {"0NY7", {"0", "7", "7", "8", "F", "8"}, {0}},
    {"0EW40,05", {"0", "7", "7", "8", "F", "8"}, {0}},
    {"0EUW40,5", {"0", "7", "7", "8", "F", "8"}, {0}},
    {"0EFW40,1.5", {"0", "7", "7", "8", "F", "8"}, {0}},
    {"7EW40,05", {"0", "7", "7", "8", "F", "8"}, {0}},
    {"0H", {"8", "8", "8", "8", "8", "8"}, {"8,90", "8,D0", "8,D0", "8,90", "8,D0", "8,98"}},
    {"0G", {"6", "6", "6", "6", "0", "E"}, {NULL, NULL, NULL, "0,00", "0,40", NULL}},
    {"0D", {"0", "7", "7", "0", "0", "0"}, {NULL, NULL, NULL, "0,00", "0,00", "0,00"}},
    {"0K", {"0", "7", "7", "0", "0", "8"}, {NULL, NULL, NULL, "0,00", "0,00", NULL}},
    {"0R", {"6", "7", "7", "E", "E", "E"}, {0}},
    {"0SW6,00", {"0", "0", "0", "0", "0", "8"}, {NULL, NULL, NULL, "0,00", "0,40", NULL}},
    {"0SW6,01", {"0", "0", "0", "0", "0", "8"}, {NULL, "0,41", NULL, "0,00", "0,40", NULL}},
    {"0SW6,10", {"0", "0", "0", "0", "0", "8"}, {"0,10", NULL, NULL, "0,10", "0,50", "8,98"}},
    {"0SW6,80", {"8", "0", "0", "8", "8", "8"}, {"8,80", NULL, NULL, "8,80", "8,C0", NULL}},
    {"0SW6,90", {"8", "0", "0", "8", "8", "8"}, {"8,90", NULL, NULL, NULL, NULL, "8,98"}},
    {"0SW6,6E", {"0", "0", "0", "0", "0", "8"}, {NULL, NULL, NULL, "0,00", "0,40", NULL}},
    {"0SW6,FF", {"8", "0", "0", "8", "8", "8"}, {"8,90", "0,41", NULL, NULL, NULL, "8,98"}},
    {"0XA", {"0", "0", "0", "8", "8", "8"}, {0}},
    {"0XU", {"0", "0", "0", "8", "8", "8"}, {0}},
    {"0XD", {"0", "0", "0", "8", "8", "8"}, {0}},
    {"0XM50", {"0", "0", "0", "8", "8", "8"}, {0}},
    {"0V500", {"0", "0", "0", "8", "8", "8"}, {0}},
    {"0SW0,05", {"0", "0", "0", "8", "8", "8"}, {0}},
    {"0SW4,FF", {"0", "0", "0", "8", "8", "8"}, {0}},
    {"0O0,FB", {"0", "0", "0", "8", "8", "8"}, {0}},
    {"7V300", {"0", "0", "0", "8", "8", "8"}, {0}},
    {"0%-", {"0", "0", "0", "8", "8", "8"}, {0}},
    {"0*E1", {"4", "4", "4", "C", "C", "C"}, {0}},
    {"0Y", {"3", "3", "3", "B", "B", "B"}, {0}},
    {"0V9", {"5", "5", "5", "D", "D", "D"}, {0}},
    {"0Q", {"0,FFFFFFFF", "0,FFFFFFFF", "0,FFFFFFFF", "8,FFFFFFFF", "8,FFFFFFFF", "8,FFFFFFFF"}, {0}},
    {"7?", {"0,IP134/200 v1 22.11.2026", "0,IP134/200 v1 22.11.2026", "0,IP134/200 v1 22.11.2026",
            "8,IP134/200 v1 22.11.2026", "8,IP134/200 v1 22.11.2026", "8,IP134/200 v1 22.11.2026"}, {0}},
};
/* clang-format on */

void setUp(void)
{
    rig_set_up();
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

static void bring(enum state state)
{
    rig_set_up();
    switch (state) {
    case REST:
        break;
    case WORK:
        rig_expect("0L100000", "0");
        rig_run_ms(100);
        break;
    case BRAKING:
        rig_expect("0V20000", "0");
        rig_expect("0L100000", "0");
        rig_run_ms(1000);
        rig_expect("0SW6,01", "0");
        break;
    case ENDED:
        rig_expect("0H", "8");
        break;
    case WAITING:
        rig_expect("0L100000", "0");
        rig_run_ms(100);
        rig_expect("0H", "8");
        break;
    case LOCKED:
        host_machine_restart(&machine);
        machine.faults.start_cause = HAL_BOARD_CAUSE_WATCHDOG;
        rig_begin();
        break;
    case STATES:
        TEST_FAIL();
        break;
    }
}

static void expect_in(enum state state, const char *command, const char *answer)
{
    char where[100];
    (void)snprintf(where, sizeof where, "%s while %s", command, name_of_state[state]);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(answer, rig_ask(command), where);
}

void test_each_command_in_each_state_has_its_answer_and_leaves_its_state(void)
{
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        for (unsigned state = 0; state < STATES; state++) {
            const char *flags = rows[i].flags[state];
            bring((enum state)state);
            expect_in((enum state)state, rows[i].command, rows[i].answer[state]);
            expect_in((enum state)state, "0SR6", flags != NULL ? flags : flags_of_state[state]);
        }
    }
}

void test_what_is_refused_has_no_effect(void)
{
    bring(WORK);
    rig_expect("0L77", "1");
    rig_expect("0NX5", "7");
    rig_expect("0D", "7");
    rig_expect("0EW40,05", "7");
    rig_expect("0H", "8");
    rig_expect("0G", "0");
    rig_run_ms(110000);
    rig_expect("0P", "0,100000,0");
    rig_expect("0ER40", "0,FF");
}

void test_a_vector_that_is_entered_after_a_stop_waits_for_g(void)
{
    bring(ENDED);
    rig_expect("0L100", "8");
    rig_expect("0C50", "8");
    rig_expect("0L1", "9");
    rig_run_ms(2000);
    rig_expect("0P", "8,0,0");
    rig_expect("0G", "0");
    rig_run_ms(2000);
    rig_expect("0P", "0,150,0");
}

void test_what_is_deleted_does_not_move_any_more(void)
{
    bring(WAITING);
    int64_t stood = rig_position[0];
    rig_expect("0C500", "8");
    rig_expect("0D", "0");
    rig_expect("0G", "6");
    rig_run_ms(2000);
    TEST_ASSERT_EQUAL_INT64(stood, rig_position[0]);
    rig_expect("0L10", "0");
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL_INT64(stood + 10, rig_position[0]);
}

void test_after_deleting_the_next_vector_begins_at_the_pulses_made(void)
{
    rig_expect("0V3333", "0");
    rig_expect("0L10000,-7001", "0");
    rig_run_ms(700);
    rig_expect("0H", "8");
    int64_t x = rig_position[0];
    int64_t y = rig_position[1];
    rig_expect("0D", "0");
    rig_expect("0L1000,999", "0");
    rig_run_ms(5000);
    TEST_ASSERT_EQUAL_INT64(x + 1000, rig_position[0]);
    TEST_ASSERT_EQUAL_INT64(y + 999, rig_position[1]);
}

void test_a_vector_that_joins_while_the_path_brakes_waits_with_the_rest(void)
{
    bring(BRAKING);
    rig_expect("0C1000", "0");
    rig_run_ms(3000);
    rig_expect("0SR6", "8,C0");
    rig_expect("0G", "0");
    rig_run_ms(60000);
    rig_expect("0P", "0,101000,0");
}

void test_a_stop_by_sw6_is_answered_at_once_and_goes_on(void)
{
    bring(BRAKING);
    rig_run_ms(3000);
    rig_expect("0SR6", "8,C0");
    rig_expect("0SR4", "8,00");
    int64_t stood = rig_position[0];
    rig_expect("0SW6,40", "0");
    rig_run_ms(60000);
    TEST_ASSERT_LESS_THAN_INT64(100000, stood);
    rig_expect("0P", "0,100000,0");
}

void test_sw6_leaves_the_causes(void)
{
    rig_expect("0SW4,0A", "0");
    rig_expect("0SW5,40", "0");
    rig_expect("0SW6,80", "8");
    rig_expect("0SW6,00", "0");
    rig_expect("0SR4", "0,0A");
    rig_expect("0SR5", "0,40");
}

void test_intcom_that_sw6_has_set_stays_through_an_interrupt(void)
{
    rig_expect("0SW6,10", "0");
    rig_expect("0SW0,01", "0");
    rig_input(1, false);
    rig_expect("0L100", "0");
    rig_run_ms(10);
    rig_expect("0SR6", "8,D0");
    rig_expect("0D", "0");
    rig_expect("0SR6", "0,00");
}

void test_g_clears_the_causes_also_where_nothing_waits(void)
{
    rig_expect("0SW4,0A", "0");
    rig_expect("0SW5,40", "0");
    rig_expect("0H", "8");
    rig_expect("0SR4", "8,0A");
    rig_expect("0G", "6");
    rig_expect("0SR4", "0,00");
    rig_expect("0SR5", "0,00");
    rig_expect("0SR6", "0,00");
}

void test_g_that_is_refused_at_rest_has_no_effect(void)
{
    rig_expect("0SW4,0A", "0");
    rig_expect("0G", "6");
    rig_expect("0SR4", "0,0A");
}

void test_d_clears_the_causes(void)
{
    rig_expect("0SW4,0A", "0");
    rig_expect("0SW5,40", "0");
    rig_expect("0D", "0");
    rig_expect("0SR4", "0,00");
    rig_expect("0SR5", "0,00");
}

void test_a_halt_while_the_path_brakes_for_an_interrupt_sets_both(void)
{
    rig_expect("0SW1,80", "0");
    rig_expect("0V20000", "0");
    rig_expect("0L100000", "0");
    rig_run_ms(1000);
    rig_input(8, false);
    rig_run_ms(10);
    rig_expect("0SR6", "0,41");
    rig_expect("0H", "8");
    rig_expect("0SR6", "8,D0");
    rig_expect("0SR5", "8,80");
}

void test_a_halt_on_the_last_ramp_ends_with_nothing_left(void)
{
    rig_expect("0V20000", "0");
    rig_expect("0L40000", "0");
    rig_run_ms(2500);
    rig_expect("0H", "8");
    rig_expect("0SR6", "8,90");
    rig_expect("0P", "8,40000,0");
    rig_expect("0G", "6");
    rig_expect("0SR6", "0,00");
}

void test_holds_without_number_move_no_pulse(void)
{
    rig_expect("0V30000", "0");
    rig_expect("0L50000,-33333,1,7", "0");
    rig_expect("0C-50000,20000,5,-7", "0");
    for (unsigned i = 0; i < 40; i++) {
        rig_run_ms(20 + 13U * i);
        const char *answer = rig_ask("0H");
        TEST_ASSERT_EQUAL_STRING("8", answer);
        answer = rig_ask("0G");
        TEST_ASSERT_TRUE(strcmp(answer, "0") == 0 || strcmp(answer, "6") == 0);
    }
    rig_run_ms(20000);
    rig_expect("0P4", "0,0,-13333,6,0");
}

void test_the_flags_tell_a_full_queue(void)
{
    rig_expect("0F", "0,00");
    rig_expect("0L100000", "0");
    rig_expect("0F", "0,40");
    for (unsigned i = 1; i < GVE_QUEUE_VECTORS; i++) {
        rig_expect("0C10", "0");
    }
    rig_expect("0F", "0,60");
    rig_expect("0SR6", "0,40");
    rig_expect("0H", "8");
    rig_expect("0F", "8,F0");
    rig_expect("0C10", "9");
    rig_expect("0C0,0,0", "9");
}

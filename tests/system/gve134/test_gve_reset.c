/* J at any time; the line of the whole unit: what waits, what is heard, what is sent again. */
#include "gve_rig.h"
#include "hal_line.h"

#include <stddef.h>

void setUp(void)
{
    rig_set_up();
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
}

static void expect_sent(const char *bytes, const char *heard)
{
    rig_heard_count = 0;
    rig_send(bytes);
    rig_run_ms(5);
    rig_heard[rig_heard_count] = '\0';
    TEST_ASSERT_EQUAL_STRING_MESSAGE(heard, rig_heard, bytes);
}

/* All is as section "After a reset" has it. */
static void assert_fresh(void)
{
    struct gve_modal modal;
    gve_modal_init(&modal);
    rig_expect("0@", "0,0");
    rig_expect("0P4", "0,0,0,0,0");
    rig_expect("0PL", "0,0,0,0,0");
    for (unsigned status = 0; status < 8; status++) {
        char command[20];
        (void)snprintf(command, sizeof command, "0SR%u", status);
        rig_expect(command, "0,00");
    }
    TEST_ASSERT_EQUAL_MEMORY(&modal, &unit.queue.modal, offsetof(struct gve_modal, corrected));
    TEST_ASSERT_FALSE(unit.queue.modal.corrected);
    TEST_ASSERT_EQUAL_UINT32(GVE_FACTOR_ONE, unit.queue.factor);
    TEST_ASSERT_EQUAL_HEX8(0, machine.outputs);
    TEST_ASSERT_EQUAL_UINT32(0, machine.pwm_permille);
    TEST_ASSERT_FALSE(unit.queue.kept.valid);
}

static void reset(void)
{
    rig_heard_count = 0;
    rig_send("!0J\r");
    unsigned made = rig_pulses[0];
    TEST_ASSERT_EQUAL_STRING("0", rig_answer_within(2));
    rig_run_ms(50);
    TEST_ASSERT_UINT_WITHIN(1, made, rig_pulses[0]);
    memset(rig_position, 0, sizeof rig_position);
}

static void change_all(void)
{
    static const char *const commands[] = {
        "0T5",        "0$9",    "0A50",    "0V5000", "0B6000", "0VK",     "0VL900,900,900,900",
        "0VJ1,2,3,4", "0XM5",   "0SW0,10", "0SW1,1", "0SW2,2", "0SW3,80", "0SW4,44",
        "0SW5,55",    "0O0,00",
    };
    for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++) {
        rig_expect(commands[i], "0");
    }
    rig_expect("7V345", "0");
    rig_expect("0NX500", "0");
}

void test_a_unit_is_fresh_after_power_on_and_after_j(void)
{
    assert_fresh();
    change_all();
    rig_expect("0%+", "0,5C");
    rig_expect("0J,C7", "0,5C");
    assert_fresh();
    change_all();
    rig_expect("7J", "0");
    assert_fresh();
}

void test_a_reset_at_any_time_of_a_path_leaves_a_fresh_unit(void)
{
    for (unsigned i = 0; i < 50; i++) {
        rig_set_up();
        rig_expect("0V30000", "0");
        rig_expect("0A100", "0");
        rig_expect("0L10000,-7000", "0");
        rig_expect("0C-10000,-7000", "0");
        rig_run_ticks(i * 1234567U);
        reset();
        assert_fresh();
        rig_expect("0L-100,30", "0");
        rig_run_ms(1000);
        rig_expect("0P", "0,-100,30");
        TEST_ASSERT_EQUAL_INT64(-100, rig_position[0]);
        TEST_ASSERT_EQUAL_INT64(30, rig_position[1]);
    }
}

void test_a_reset_while_the_path_brakes_or_waits_leaves_a_fresh_unit(void)
{
    for (unsigned ms = 0; ms < 1400; ms += 100) {
        rig_set_up();
        rig_expect("0V20000", "0");
        rig_expect("0L60000", "0");
        rig_run_ms(1200);
        rig_expect("0SW6,01", "0");
        rig_run_ms(ms);
        reset();
        assert_fresh();
        rig_run_ms(1000);
        rig_expect("0P", "0,0,0");
    }
}

void test_a_reset_in_a_pause_lets_no_pulse_come(void)
{
    rig_expect("0T24", "0");
    rig_expect("0L50", "0");
    while (strcmp(rig_ask("0L50"), "1") == 0) {
    }
    reset();
    rig_run_ms(1000);
    rig_expect("0P", "0,0,0");
}

void test_after_a_reset_there_is_no_pause(void)
{
    rig_expect("0L5000", "0");
    rig_run_ms(500);
    reset();
    TEST_ASSERT_EQUAL_UINT64(0, unit.queue.last_tick);
}

void test_j_while_h_waits_is_answered_alone(void)
{
    rig_expect("0V20000", "0");
    rig_expect("0L60000", "0");
    rig_run_ms(1200);
    expect_sent("!0H\r", "");
    expect_sent("!0P\r!0H\r!0J\r", "0\r");
    rig_run_ms(2000);
    TEST_ASSERT_EQUAL_UINT32(2, rig_heard_count);
    assert_fresh();
}

void test_what_comes_after_j_is_for_the_fresh_unit(void)
{
    expect_sent("!0V500\r!0J\r!0@\r!0V77\r!0@\r", "0\r0\r0,0\r0\r0,1\r");
    TEST_ASSERT_EQUAL_UINT32(77, unit.queue.modal.speed);
}

void test_j_waits_for_no_answer_that_goes_out(void)
{
    expect_sent("!0?\r!0J\r!0P\r", "0,IP134/200 v1 22.11.2026\r0\r0,0,0\r");
}

void test_j_takes_effect_when_its_answer_is_out(void)
{
    static const char version[] = "0,IP134/200 v1 22.11.2026\r";
    char heard[200];
    (void)snprintf(heard, sizeof heard, "%s%s%s0\r0,0,0\r", version, version, version);
    rig_heard_count = 0;
    rig_send("!0?\r!0?\r!0?\r!0J\r!0P\r");
    rig_run_ms(20);
    rig_heard[rig_heard_count] = '\0';
    TEST_ASSERT_EQUAL_STRING(heard, rig_heard);
}

void test_after_j_a_pulse_that_can_not_be_taken_back_is_waited_for(void)
{
    rig_expect("0L1000", "0");
    rig_run_ms(500);
    machine.faults.keep_ticks = 2 * TICKS_PER_MS;
    reset();
    assert_fresh();
    rig_expect("0L10", "0");
    rig_run_ms(500);
    rig_expect("0P", "0,10,0");
}

void test_many_bytes_that_come_at_once_are_all_taken(void)
{
    static struct host_line_byte burst[200];
    for (unsigned i = 0; i < 200; i++) {
        burst[i] = (struct host_line_byte){.tick = machine.now + 1U, .value = (uint8_t)"!0N\r"[i % 4U]};
    }
    host_machine_set_line(&machine, burst, 200);
    rig_run_ms(50);
    rig_expect("0@", "0,50");
}

void test_commands_that_come_before_an_answer_is_out_are_executed_in_order(void)
{
    rig_expect("0L1000", "0");
    rig_run_ms(300);
    expect_sent("!0H\r!0V77\r!0@\r", "");
    rig_run_ms(500);
    rig_heard[rig_heard_count] = '\0';
    TEST_ASSERT_EQUAL_STRING("8\r8\r8,3\r", rig_heard);
}

/* The answer of 26 characters is not yet out when the command after it has come. */
void test_a_command_that_comes_before_an_answer_is_out_is_executed_after_it(void)
{
    rig_heard_count = 0;
    rig_send("!0?\r!0O0,FE\r");
    while (!rig_has_answer()) {
        TEST_ASSERT_EQUAL_HEX8(0, rig_outputs);
        rig_run_ticks(RIG_BYTE_TICKS);
    }
    rig_run_ms(1);
    TEST_ASSERT_NOT_EQUAL_HEX8(0, rig_outputs);
}

/* So slowly that they are still there when the axes stand. */
static void fill_line(void)
{
    host_machine_set_byte_ticks(&machine, 1000U * RIG_BYTE_TICKS);
    while (hal_line_write('x')) {
    }
    rig_heard_count = 0;
}

static const char *heard_after_what_filled_it(void)
{
    rig_run_ms(7000);
    rig_heard[rig_heard_count] = '\0';
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(HOST_LINE_TO_SEND_MAX, rig_heard_count);
    return &rig_heard[HOST_LINE_TO_SEND_MAX];
}

void test_an_answer_that_finds_no_room_in_the_line_goes_out_when_there_is_some(void)
{
    rig_expect("0L1000", "0");
    rig_run_ms(300);
    rig_send("!0H\r");
    fill_line();
    rig_run_ms(70);
    TEST_ASSERT_TRUE(gve_queue_inta(&unit.queue));
    TEST_ASSERT_FALSE(gve134_is_idle(&unit));
    rig_send("!0V77\r");
    TEST_ASSERT_EQUAL_STRING("8\r8\r", heard_after_what_filled_it());
}

void test_a_reset_waits_for_its_answer_to_go_out(void)
{
    rig_expect("0L1000", "0");
    rig_run_ms(300);
    rig_send("!0H\r");
    fill_line();
    rig_send("!0J\r");
    TEST_ASSERT_EQUAL_STRING("0\r", heard_after_what_filled_it());
    host_machine_set_byte_ticks(&machine, RIG_BYTE_TICKS);
    rig_expect("0@", "0,0");
}

void test_a_reset_switches_outputs_off_before_its_answer_is_out(void)
{
    rig_expect("0O0,F0", "0");
    rig_expect("7V300", "0");
    rig_expect("0L1000", "0");
    rig_run_ms(300);
    rig_send("!0H\r");
    TEST_ASSERT_EQUAL_HEX8(0xF1, rig_outputs);
    fill_line();
    rig_send("!0J\r");
    TEST_ASSERT_EQUAL_HEX8(0, rig_outputs);
    TEST_ASSERT_EQUAL_UINT32(0, rig_pwm);
    TEST_ASSERT_EQUAL_STRING("0\r", heard_after_what_filled_it());
}

void test_256_bytes_that_come_while_h_waits_are_kept(void)
{
    static char burst[300];
    for (unsigned i = 0; i < 64; i++) {
        memcpy(&burst[i * 4U], "!0N\r", 4);
    }
    rig_expect("0V20000", "0");
    rig_expect("0L60000", "0");
    rig_run_ms(1200);
    expect_sent("!0H\r", "");
    rig_send(burst);
    rig_run_ms(3000);
    TEST_ASSERT_EQUAL_UINT32(2 + 64 * 2, rig_heard_count);
}

void test_the_last_answer_is_sent_again(void)
{
    rig_expect("0>", "0");
    rig_expect("0NX-1000", "0");
    rig_expect("0PF", "0,-1000,0,0");
    rig_expect("0>", "0,-1000,0,0");
    rig_expect("7>", "0,-1000,0,0");
    rig_expect("0@", "0,2");
    rig_expect("0>", "0,-1000,0,0");
    rig_expect("7@", "0,2");
    rig_expect("0H", "8");
    rig_expect("0D", "0");
    rig_expect("0>", "0");
}

void test_damage_is_answered_once_after_silence(void)
{
    rig_heard_count = 0;
    rig_send("!0V50!0V60\r");
    TEST_ASSERT_EQUAL_STRING("2", rig_answer_within(150));
    TEST_ASSERT_EQUAL_UINT32(1000, unit.queue.modal.speed);
    rig_heard_count = 0;
    rig_send("!0V5");
    TEST_ASSERT_EQUAL_STRING("", rig_answer_within(900));
    TEST_ASSERT_EQUAL_STRING("2", rig_answer_within(200));
}

void test_what_is_for_others_has_no_answer(void)
{
    expect_sent("!3P\r!1L100\r!6J\r", "");
    rig_expect("0SR6", "0,00");
}

void test_the_spindle_knows_its_own_commands_only(void)
{
    rig_expect("7P", "3");
    rig_expect("7L100", "3");
    rig_expect("7V1001", "5");
    rig_expect("7V", "4");
    rig_expect("7Q", "0,FFFFFFFF");
    rig_expect("7EW10,7", "0");
    rig_expect("0ER10", "0,07");
}

void test_a_unit_is_idle_when_nothing_moves_waits_or_is_to_be_sent(void)
{
    TEST_ASSERT_TRUE(gve134_is_idle(&unit));
    rig_send("!0L1000\r");
    TEST_ASSERT_FALSE(gve134_is_idle(&unit)); /* it moves */
    rig_run_ms(300);
    rig_heard_count = 0;
    rig_send("!0H\r");
    TEST_ASSERT_FALSE(gve134_is_idle(&unit));
    TEST_ASSERT_EQUAL_STRING("8", rig_answer_within(1000));
    TEST_ASSERT_TRUE(gve134_is_idle(&unit));
    rig_send("!0?\r!0?\r!0?\r!0?\r!0?\r");
    for (unsigned bytes = 0; bytes < 40; bytes++) {
        TEST_ASSERT_FALSE(gve134_is_idle(&unit)); /* it sends: more than the line takes at once */
        rig_run_ticks(RIG_BYTE_TICKS);
    }
    rig_run_ms(20);
    TEST_ASSERT_TRUE(gve134_is_idle(&unit));
}

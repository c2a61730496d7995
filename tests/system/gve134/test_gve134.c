#include "gve_rig.h"

#include "hal_line.h"
#include "hal_time.h"

void setUp(void)
{
    rig_set_up();
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        TEST_ASSERT_EQUAL_INT64(rig_position[motor], step_channel_position(&unit.queue.channel[motor]));
    }
}

void test_it_tells_its_version(void)
{
    rig_expect("0?", "0,IP134/200 v1 22.11.2026");
    rig_expect("7?", "0,IP134/200 v1 22.11.2026");
}

void test_a_vector_moves_its_axes_and_they_arrive(void)
{
    rig_expect("0L1000,-200,3", "0");
    rig_run_ms(3000);
    rig_expect("0P4", "0,1000,-200,3,0");
    TEST_ASSERT_EQUAL_INT64(1000, rig_position[0]);
    TEST_ASSERT_EQUAL_INT64(-200, rig_position[1]);
}

void test_a_halt_is_answered_when_the_axes_stand_and_what_is_left_goes_on(void)
{
    rig_expect("0V20000", "0");
    rig_expect("0L20000,10000", "0");
    rig_run_ms(500);
    rig_expect("0H", "8");
    TEST_ASSERT_LESS_THAN(20000, rig_position[0]);
    int64_t stood = rig_position[0];
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_INT64(stood, rig_position[0]);
    rig_expect("0SR6", "8,D0");
    rig_expect("0G", "0");
    rig_run_ms(3000);
    rig_expect("0PF", "0,20000,10000,0");
}

/* The example of the data sheet: stop, lift the tool, go on slower. */
void test_the_tool_is_lifted_beside_the_kept_path(void)
{
    rig_expect("0V10000", "0");
    rig_expect("0L30000,20000", "0");
    rig_expect("0C30000,0", "0");
    rig_run_ms(1000);
    rig_expect("0H", "8");
    rig_expect("0SR4", "8,00");
    rig_expect("0SR5", "8,00");
    rig_expect("0SR6", "8,D0");
    rig_expect("0SW0,1A", "8");
    rig_expect("0SW1,3F", "8");
    rig_expect("0K", "0");
    rig_expect("0L0,0,-1000", "0");
    rig_expect("0L0,0,1000", "1");
    rig_run_ms(1000);
    rig_expect("0L0,0,1000", "0");
    rig_expect("0R", "7");
    rig_run_ms(1000);
    rig_expect("0R", "8");
    rig_expect("0V500", "8");
    rig_expect("0XA", "8");
    rig_expect("0SW0,A2", "8");
    rig_expect("0SW1,78", "8");
    rig_expect("0G", "0");
    rig_expect("0SR6", "0,40");
    rig_run_ms(150000);
    rig_expect("0PF", "0,60000,20000,0");
}

void test_an_input_that_is_enabled_stops_the_axes_and_is_told(void)
{
    rig_input(8, true);
    rig_expect("0SW3,00", "0");
    rig_expect("0SW1,80", "0");
    rig_expect("0V5000", "0");
    rig_expect("0L100000", "0");
    rig_run_ms(2000);
    rig_input(8, false);
    int64_t latched = rig_position[0];
    rig_run_ms(1000);
    rig_expect("0SR5", "8,80");
    rig_expect("0SR6", "8,C0");
    char text[100];
    (void)snprintf(text, sizeof text, "8,%d,0,0,0", (int)latched);
    rig_expect("0PL", text);
    TEST_ASSERT_LESS_OR_EQUAL(latched + 650, rig_position[0]);
    rig_expect("0G", "0");
    rig_run_ms(100);
    rig_expect("0SR5", "8,80");
    rig_input(8, true);
    rig_expect("0G", "0");
    rig_run_ms(30000);
    rig_expect("0P", "0,100000,0");
}

static uint64_t be_late(void *context)
{
    (void)context;
    return TICK_NEVER;
}

/* From 5000 steps/s it takes 625 steps. */
void test_an_input_stops_the_axes_though_main_is_late(void)
{
    rig_input(8, true);
    rig_expect("0SW3,00", "0");
    rig_expect("0SW1,80", "0");
    rig_expect("0V5000", "0");
    rig_expect("0L100000", "0");
    rig_run_ms(2000);
    rig_input(8, false);
    int64_t latched = rig_position[0];
    host_machine_run(&machine, machine.now + 5U * TICKS_PER_MS, be_late, NULL, NULL);
    rig_run_ms(1000);
    TEST_ASSERT_INT64_WITHIN(10, latched + 625, rig_position[0]);
}

static unsigned begun; /* answers that H has waited for, in the pass that has seen the stand */

static uint64_t watch_halt(void *context)
{
    bool waited = unit.waiting == (uint8_t)GVE134_WAITS_FOR_HALT;
    uint64_t wake = rig_poll(context);
    begun += waited && unit.waiting == (uint8_t)GVE134_WAITS_NOT && !hal_line_is_idle();
    return wake;
}

void test_the_answer_to_a_halt_begins_in_the_pass_that_sees_the_stand(void)
{
    rig_expect("0V5000", "0");
    rig_expect("0L100000", "0");
    rig_run_ms(500);
    rig_send("!0H\r");
    begun = 0;
    host_machine_run(&machine, machine.now + 1000U * TICKS_PER_MS, watch_halt, NULL, NULL);
    TEST_ASSERT_EQUAL_UINT(1, begun);
}

void test_a_reference_run_finds_the_place_where_the_switch_lets_go(void)
{
    rig_expect("0SW2,00", "0");
    rig_send("!0WX-20000,1000,5000,500\r");
    rig_heard_count = 0;
    rig_run_ms(2000);
    rig_input(1, false);
    int64_t closed = rig_position[0];
    rig_run_ms(60);
    TEST_ASSERT_LESS_THAN(closed, rig_position[0]);
    rig_run_ms(200);
    rig_input(1, true);
    int64_t opened = rig_position[0];
    TEST_ASSERT_EQUAL_STRING("0", rig_answer_within(3000));
    TEST_ASSERT_EQUAL_INT64(opened + 1, rig_position[0]);
}

void test_a_switch_that_never_closes_ends_a_reference_run_with_an_error(void)
{
    rig_expect("0WX-2000,1000,5000,500", "D");
    rig_expect("0SR6", "8,80");
    TEST_ASSERT_EQUAL_INT64(-2000, rig_position[0]);
}

void test_a_halt_ends_a_reference_run_and_is_answered_after_it(void)
{
    rig_send("!0WX-20000,1000,5000,500\r");
    rig_run_ms(500);
    rig_heard_count = 0;
    rig_send("!0H\r");
    rig_run_ms(1000);
    rig_heard[rig_heard_count] = '\0';
    TEST_ASSERT_EQUAL_STRING("8\r8\r", rig_heard);
    rig_expect("0SR6", "8,90");
}

void test_a_packet_is_taken_whole(void)
{
    rig_send("!0*S\r!0C697,30,0\r!0B500\r!0C692,92,0\r");
    rig_expect("0*E3", "0,3");
    rig_run_ms(3000);
    rig_expect("0P", "0,1389,122");
}

/* What waits in the line when main comes late. */
void test_a_pass_takes_as_much_of_a_packet_as_has_come_and_other_requests_one_by_one(void)
{
    static const char *const texts[] = {"!0*S\r!0C697,30,0\r!0B500\r!0C692,92,0\r", "!0V1000\r!0V2000\r"};
    for (unsigned i = 0; i < 2; i++) {
        uint32_t count = (uint32_t)strlen(texts[i]);
        for (uint32_t place = 0; place < count; place++) {
            rig_script[place] = (struct host_line_byte){.tick = machine.now + (place + 1U) * (uint64_t)RIG_BYTE_TICKS,
                                                        .value = (uint8_t)texts[i][place]};
        }
        host_machine_set_line(&machine, rig_script, count);
        host_machine_run(&machine, machine.now + (count + 1U) * (uint64_t)RIG_BYTE_TICKS, be_late, NULL, NULL);
        TEST_ASSERT_EQUAL_UINT64(hal_time_now(), gve134_poll(&unit));
        TEST_ASSERT_EQUAL_UINT32(3, unit.packet.commands);
        rig_run_ms(10);
        TEST_ASSERT_TRUE(gve134_poll(&unit) > hal_time_now());
        unit.packet.open = false;
    }
}

void test_of_a_packet_with_a_wrong_line_nothing_is_taken(void)
{
    rig_send("!0*S\r!0B500\r!0C692,92,0,0,0\r");
    rig_expect("0*E2", "4,0");
    rig_run_ms(1000);
    rig_expect("0P", "0,0,0");
    TEST_ASSERT_EQUAL_UINT32(200000, unit.queue.modal.brake);
}

void test_a_full_queue_refuses_vectors_until_one_is_done(void)
{
    for (unsigned i = 0; i < GVE_QUEUE_VECTORS; i++) {
        rig_expect("0C1000", "0");
    }
    rig_expect("0C1000", "1");
    rig_expect("0F", "0,60");
    rig_run_ms(1000);
    rig_expect("0C1000", "0");
    rig_run_ms(140000);
    rig_expect("0P", "0,129000,0");
}

void test_a_reset_ends_pulses_at_once_and_forgets(void)
{
    rig_expect("0%+", "0,5C");
    rig_expect("0L20000,10000,0,0,90", "0,5C");
    rig_run_ms(300);
    unsigned made = rig_pulses[0];
    TEST_ASSERT_NOT_EQUAL(0, made);
    rig_heard_count = 0;
    rig_send("!0J,C7\r");
    TEST_ASSERT_EQUAL_STRING("0,5C", rig_answer_within(10));
    made = rig_pulses[0];
    rig_run_ms(300);
    TEST_ASSERT_EQUAL_UINT(made, rig_pulses[0]);
    rig_expect("0@", "0,0");
    rig_expect("0P4", "0,0,0,0,0");
    rig_expect("0SR6", "0,00");
    memset(rig_position, 0, sizeof rig_position);
}

void test_an_input_that_comes_after_a_reset_means_nothing(void)
{
    rig_expect("0SW0,01", "0");
    rig_expect("0V100000", "0");
    rig_expect("0L20000", "0");
    rig_run_ms(200);
    rig_send("!0J\r");
    rig_input(1, false);
    rig_run_ms(100);
    rig_input(1, true);
    rig_expect("0SR6", "0,00");
    memset(rig_position, 0, sizeof rig_position);
}

void test_speeds_change_while_axes_move(void)
{
    rig_expect("0V1000", "0");
    rig_expect("0L10000", "0");
    rig_run_ms(1000);
    rig_expect("0XM1000", "0");
    rig_run_ms(2500);
    rig_expect("0P", "0,10000,0");
}

void test_a_coupled_axis_makes_the_pulses_of_its_own(void)
{
    rig_expect("0EW0C,02", "0");
    rig_expect("0L10,20,30,1", "5");
    rig_expect("0L10,20,30", "0");
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL_INT64(20, rig_position[3]);
    TEST_ASSERT_EQUAL_UINT64(rig_pulse_tick[1], rig_pulse_tick[3]);
    rig_expect("0P4", "0,10,20,30,20");
}

void test_outputs_follow_the_port(void)
{
    rig_expect("0O0,FB", "0");
    TEST_ASSERT_EQUAL_HEX8(0x20, rig_outputs);
    rig_expect("7V300", "0");
    TEST_ASSERT_EQUAL_HEX8(0x31, rig_outputs);
    TEST_ASSERT_EQUAL_UINT32(300, rig_pwm);
    rig_expect("7V0", "0");
    TEST_ASSERT_EQUAL_HEX8(0x20, rig_outputs);
    rig_expect("0EW01,09", "0");
    rig_expect("0H", "8");
    TEST_ASSERT_EQUAL_HEX8(0x21, rig_outputs);
}

void test_bytes_are_kept_through_a_restart(void)
{
    rig_expect("0EFW10,1.5", "0");
    host_machine_restart(&machine);
    rig_begin();
    rig_expect("0EUR10", "0,3FC00000");
    rig_expect("0EFR10", "0,1.5");
}

void test_after_a_fault_nothing_moves_until_the_queue_is_deleted(void)
{
    host_machine_restart(&machine);
    machine.faults.start_cause = HAL_BOARD_CAUSE_WATCHDOG;
    rig_begin();
    rig_expect("0?", "8,IP134/200 v1 22.11.2026");
    rig_expect("0SR6", "8,88");
    rig_expect("0L100", "F");
    rig_expect("0G", "E");
    rig_expect("0D", "0");
    rig_expect("0L100", "0");
    rig_run_ms(1000);
    rig_expect("0P", "0,100,0");
}

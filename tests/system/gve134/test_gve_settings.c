/* Settings of speeds in a running unit, X in every state, EEPROM, polarities, coupling, LEDs. */
#include "gve_rig.h"

static uint8_t falling;
static uint8_t turned;

static void polarity_seen(void *context, uint64_t tick, unsigned motor, bool falls, bool turns)
{
    (void)context;
    (void)tick;
    falling = (uint8_t)(falls ? falling | 1U << motor : falling & ~(1U << motor));
    turned = (uint8_t)(turns ? turned | 1U << motor : turned & ~(1U << motor));
}

void setUp(void)
{
    rig_set_up();
    machine.listener.polarity = polarity_seen;
    falling = 0;
    turned = 0;
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT64(0, machine.late_steps);
    for (unsigned motor = 0; motor < UNIT_MOTORS; motor++) {
        TEST_ASSERT_EQUAL_INT64(rig_position[motor], step_channel_position(&unit.queue.channel[motor]));
    }
}

/* Runs until the axes stand, a minute at most; returns how long that was. */
static uint64_t run_to_the_end_ms(void)
{
    uint64_t began = machine.now;
    for (unsigned i = 0; i < 60000 && gve_queue_moves(&unit.queue); i++) {
        rig_run_ms(1);
    }
    return (machine.now - began) / TICKS_PER_MS;
}

void test_v_and_a_give_a_vector_its_time(void)
{
    rig_expect("0V5000", "0");
    rig_expect("0A50", "0");
    rig_expect("0L10000", "0");
    TEST_ASSERT_UINT64_WITHIN(3, 2100, run_to_the_end_ms());
}

void test_vl_and_vk_slow_a_vector(void)
{
    rig_expect("0VL500,200000,200000,200000", "0");
    rig_expect("0L1000", "0");
    TEST_ASSERT_UINT64_WITHIN(3, 2025, run_to_the_end_ms());
    rig_expect("0VL200000,200000,200000,200000", "0");
    rig_expect("0VK", "0");
    rig_expect("0L800,600", "0");
    TEST_ASSERT_UINT64_WITHIN(3, 1040, run_to_the_end_ms());
    rig_expect("0VN", "0");
    rig_expect("0L800,600", "0");
    TEST_ASSERT_UINT64_WITHIN(3, 850, run_to_the_end_ms());
}

void test_short_vectors_go_at_b(void)
{
    rig_expect("0$2000", "0");
    rig_expect("0B500", "0");
    rig_expect("0L1999", "0");
    TEST_ASSERT_UINT64_WITHIN(3, 4023, run_to_the_end_ms());
    rig_expect("0L2000", "0");
    TEST_ASSERT_UINT64_WITHIN(3, 2050, run_to_the_end_ms());
}

void test_vj_slows_a_corner(void)
{
    rig_expect("0V10000", "0");
    rig_expect("0L5000", "0");
    rig_expect("0C0,5000", "0");
    uint64_t fast = run_to_the_end_ms();
    rig_expect("0VJ100,100,0,0", "0");
    rig_expect("0L5000", "0");
    rig_expect("0C0,5000", "0");
    TEST_ASSERT_GREATER_THAN_UINT64(fast + 400U, run_to_the_end_ms());
}

void test_a_corner_that_vj_allows_no_speed_is_passed_at_a_stand(void)
{
    rig_expect("0VK", "0");
    rig_expect("0VJ0,0,0,1", "0");
    rig_expect("0L1,0,0,1000", "0");
    rig_expect("0C1,0,0,-1000", "0");
    rig_run_ms(20000);
    rig_expect("0P4", "0,2,0,0,0");
}

void test_x_commands_act_while_axes_move(void)
{
    rig_expect("0L10000", "0");
    rig_run_ms(1000);
    rig_expect("0XM50", "0");
    TEST_ASSERT_EQUAL_UINT32(GVE_FACTOR_ONE / 2U, unit.queue.factor);
    rig_run_ms(1000);
    TEST_ASSERT_INT64_WITHIN(30, 1500, rig_position[0]);
    rig_expect("0V2000", "0");
    rig_expect("0XA", "0");
    rig_run_ms(1000);
    TEST_ASSERT_INT64_WITHIN(100, 3500, rig_position[0]);
    rig_expect("0XU", "0");
    rig_expect("0XU", "0");
    rig_expect("0XD", "0");
    TEST_ASSERT_EQUAL_UINT32(6936000, unit.queue.factor);
    rig_run_ms(8000);
    rig_expect("0P", "0,10000,0");
}

void test_x_gives_the_queue_the_vl_in_force(void)
{
    rig_expect("0L10000", "0");
    rig_run_ms(1000);
    rig_expect("0VL100,200000,200000,200000", "0");
    rig_run_ms(1000);
    TEST_ASSERT_GREATER_THAN_INT64(1900, rig_position[0]);
    rig_expect("0XU", "0");
    rig_run_ms(100);
    int64_t slow = rig_position[0];
    rig_run_ms(1000);
    TEST_ASSERT_INT64_WITHIN(2, slow + 100, rig_position[0]);
}

void test_x_in_the_states_at_rest_counts_for_what_goes_on(void)
{
    rig_expect("0L2000", "0");
    rig_run_ms(500);
    rig_expect("0H", "8");
    int64_t left = 2000 - rig_position[0];
    rig_expect("0XM50", "8");
    rig_expect("0G", "0");
    TEST_ASSERT_UINT64_WITHIN(40, (uint64_t)left * 2U, run_to_the_end_ms());
    rig_expect("0L1000", "0"); /* the factor stays for vectors entered later */
    TEST_ASSERT_UINT64_WITHIN(40, 2000, run_to_the_end_ms());
    rig_expect("0XA", "0");
    rig_expect("0L1000", "0");
    TEST_ASSERT_UINT64_WITHIN(60, 1000, run_to_the_end_ms());
}

void test_x_in_a_pause_and_while_the_path_brakes_keeps_the_path(void)
{
    rig_expect("0V20000", "0");
    rig_expect("0L40000,-9", "0");
    rig_expect("0XM30", "0");
    rig_run_ms(1000);
    rig_expect("0SW6,01", "0");
    rig_expect("0XM200", "0");
    rig_expect("0XM100", "0");
    rig_run_ms(2000);
    rig_expect("0XD", "8");
    rig_expect("0G", "0");
    rig_expect("0XU", "0");
    rig_run_ms(10000);
    rig_expect("0P", "0,40000,-9");
}

void test_each_bit_of_the_polarity_is_of_one_motor(void)
{
    for (unsigned bit = 0; bit < 8; bit++) {
        char command[20];
        (void)snprintf(command, sizeof command, "0EW05,%02X", 0xFFU & ~(1U << bit));
        rig_expect(command, "0");
        TEST_ASSERT_EQUAL_HEX8(1U << bit, falling | turned << 4U);
    }
}

void test_the_polarity_of_the_data_sheet_s_example(void)
{
    rig_expect("0EW05,AC", "0");
    TEST_ASSERT_EQUAL_HEX8(0x3, falling);
    TEST_ASSERT_EQUAL_HEX8(0x5, turned);
    rig_expect("0J", "0");
    TEST_ASSERT_EQUAL_HEX8(0x3, falling);
    host_machine_restart(&machine);
    rig_begin();
    TEST_ASSERT_TRUE(machine.falling[0] && machine.falling[1] && !machine.falling[2] && !machine.falling[3]);
}

void test_each_coupling_makes_a_follow_its_axis(void)
{
    static const struct {
        const char *byte;
        unsigned axis;
    } couplings[] = {{"0EW0C,01", 0}, {"0EW0C,02", 1}, {"0EW0C,03", 2}};
    for (unsigned i = 0; i < 3; i++) {
        rig_set_up();
        rig_expect(couplings[i].byte, "0");
        rig_expect("0C1,0,0,1", "5");
        rig_expect("0L1,0,0,-1", "5");
        rig_expect("0NA5", "5");
        rig_expect("0WA5,100,100,100", "5");
        rig_expect("0L10,-20,30,0", "0");
        rig_expect("0C5,5,5", "0");
        rig_run_ms(1000);
        TEST_ASSERT_EQUAL_INT64(rig_position[couplings[i].axis], rig_position[3]);
        TEST_ASSERT_EQUAL_UINT64(rig_pulse_tick[couplings[i].axis], rig_pulse_tick[3]);
        char answer[60];
        (void)snprintf(answer, sizeof answer, "0,15,-15,35,%d", (int)rig_position[3]);
        rig_expect("0P4", answer);
        rig_expect("0NX9", "0");
    }
    rig_position[0] = 9;
}

void test_a_parameter_of_a_coupled_axis_is_wrong_before_the_state_refuses_it(void)
{
    rig_expect("0EW0C,01", "0");
    rig_expect("0L1000", "0");
    rig_expect("0L0,0,0,5", "5");
    rig_expect("0NA5", "5");
    rig_expect("0WA5,100,100,100", "5");
    rig_expect("0WY5,100,100,100", "7");
    rig_run_ms(2000);
}

void test_a_that_is_not_coupled_is_independent(void)
{
    static const char *const bytes[] = {"0EW0C,00", "0EW0C,04", "0EW0C,FF"};
    for (unsigned i = 0; i < 3; i++) {
        rig_expect(bytes[i], "0");
        rig_expect("0L0,0,0,7", "0");
        rig_run_ms(500);
        TEST_ASSERT_EQUAL_INT64(7 * (int64_t)(i + 1U), rig_position[3]);
    }
}

void test_vl_and_vj_of_a_coupled_axis_do_not_count(void)
{
    rig_expect("0EW0C,01", "0");
    rig_expect("0VL200000,200000,200000,10", "0");
    rig_expect("0L1000", "0");
    TEST_ASSERT_UINT64_WITHIN(60, 1050, run_to_the_end_ms());
}

void test_what_is_set_in_the_eeprom_can_be_read_in_each_form(void)
{
    rig_expect("0Q", "0,FFFFFFFF");
    rig_expect("0EUWF8,4220525", "0");
    rig_expect("0Q", "0,25052204");
    rig_expect("0EFW10,-1.5E-7", "0");
    rig_expect("0EFR10", "0,-1.50000005E-07");
    rig_expect("0EUR10", "0,B4210FB0");
    rig_expect("7ER13", "0,B4");
    rig_expect("0EUWFD,1", "5");
    rig_expect("0EFW10,1E39", "5");
}

void test_positions_wrap_as_numbers_of_32_bits(void)
{
    rig_expect("0NX2147483647", "0");
    rig_expect("0NY-2147483647", "0");
    rig_expect("0NZ,5", "0");
    rig_expect("0L1,-2", "0");
    rig_run_ms(500);
    rig_expect("0PF", "0,-2147483648,2147483647,5");
    rig_expect("0NA-2147483648", "5");
    rig_expect("0N", "0");
    rig_expect("0P4", "0,0,0,0,0");
    memset(rig_position, 0, sizeof rig_position);
}

static bool shows_data(void)
{
    return (rig_leds & 0x04U) != 0;
}

void test_the_data_led_shows_bytes_that_come_without_an_answer(void)
{
    rig_run_ms(30);
    TEST_ASSERT_FALSE(shows_data());
    rig_send("!3P\r");
    TEST_ASSERT_TRUE(shows_data());
    rig_run_ms(19);
    TEST_ASSERT_TRUE(shows_data());
    rig_run_ms(2);
    TEST_ASSERT_FALSE(shows_data());
    TEST_ASSERT_EQUAL_UINT32(0, rig_heard_count);
}

void test_the_data_led_shows_an_answer_that_goes_out_late(void)
{
    rig_expect("0V20000", "0");
    rig_expect("0L60000", "0");
    rig_run_ms(1200);
    rig_heard_count = 0;
    rig_send("!0H\r");
    rig_run_ms(100);
    TEST_ASSERT_FALSE(shows_data());
    TEST_ASSERT_EQUAL_STRING("8", rig_answer_within(2000));
    TEST_ASSERT_TRUE(shows_data());
    rig_run_ms(30);
    TEST_ASSERT_FALSE(shows_data());
}

void test_a_switch_that_is_closed_at_power_on_is_known_in_the_first_pass(void)
{
    host_machine_restart(&machine);
    rig_input(3, false);
    rig_begin();
    (void)gve134_poll(&unit);
    TEST_ASSERT_EQUAL_HEX8(0x41, rig_leds);
}

void test_leds_show_run_data_relay_and_reference_switches(void)
{
    rig_run_ms(30);
    TEST_ASSERT_EQUAL_HEX8(0x01, rig_leds);
    rig_expect("0O0,FE", "0");
    TEST_ASSERT_EQUAL_HEX8(0x0D, rig_leds);
    rig_run_ms(30);
    TEST_ASSERT_EQUAL_HEX8(0x09, rig_leds);
    rig_input(2, false);
    rig_input(4, false);
    rig_run_ms(1);
    TEST_ASSERT_EQUAL_HEX8(0xA9, rig_leds);
    rig_expect("0L1000", "0");
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_HEX8(0xAB, rig_leds);
}

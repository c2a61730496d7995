/* Packets: all or nothing, with one answer. */
#include "gve_rig.h"

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

static void expect_sent(const char *bytes, const char *heard)
{
    rig_heard_count = 0;
    rig_send(bytes);
    rig_run_ms(5);
    rig_heard[rig_heard_count] = '\0';
    TEST_ASSERT_EQUAL_STRING_MESSAGE(heard, rig_heard, bytes);
}

static void lock(void)
{
    host_machine_restart(&machine);
    machine.faults.start_cause = HAL_BOARD_CAUSE_FAULT;
    rig_begin();
}

void test_each_kind_of_packet_has_its_answer_and_is_taken_whole_or_not_at_all(void)
{
    static const struct {
        const char *bytes;
        const char *answer;
        int64_t x; /* where it leads */
    } packets[] = {
        {"!0*S\r!0C100\r!0C50,1\r!0*E2\r", "0,2\r", 150},
        {"!0*S\r!0*E0\r", "0,0\r", 0},
        {"!0*S\r!0B500\r!0*E1\r", "0,1\r", 0},
        {"!0*S\r!0C0,0,0\r!0C7\r!0*E2\r", "0,2\r", 7},
        {"!0*S\r!0C100\r!0C50,1\r!0*E3\r", "2,0\r", 0},
        {"!0*S\r!0C100\r!0C50,1\r!0*E1\r", "2,0\r", 0},
        {"!0*S\r!0C100\r!0C50,,1\r!0*E2\r", "4,0\r", 0},
        {"!0*S\r!0C100\r!0C2147483648\r!0*E2\r", "5,0\r", 0},
        {"!0*S\r!0C100\r!0B9\r!0*E2\r", "5,0\r", 0},
        {"!0*S\r!0C100\r!0V5000\r!0*E1\r", "4,0\r", 0},
        {"!0*S\r!0C100\r!0L5000\r!0*E1\r", "4,0\r", 0},
        {"!0*S\r!0C100\r!0@\r!0*E1\r", "4,0\r", 0},
        {"!0*S\r!0C100\r!7V5\r!0*E1\r", "4,0\r", 0},
        {"!0*S\r!0C100\r!0Y\r!0*E1\r", "3,0\r", 0},
        {"!0*S\r!0Y\r!0C1,2,3,4,5\r!0*E9\r", "3,0\r", 0},
        {"!0*S\r!0C1,2,3,4,5\r!0Y\r!0*E9\r", "4,0\r", 0},
        {"!0*S\r!0C100\r!0C1!0C7\r!0*E2\r", "2,0\r", 0},
        {"!0*S\r!0C100\r!0*E\r", "4,0\r", 0},
        {"!0*S\r!0C100\r!0*E129\r", "5,0\r", 0},
        {"!0*S\r!0C100\r!0*S\r!0C30\r!0*E1\r", "0,1\r", 30},
        {"!0*S\r!0Y\r!0*S\r!0C30\r!0*E1\r", "0,1\r", 30},
        {"!0*S\r!0C100\r!0*S1\r!0C30\r!0*E2\r", "4,0\r", 0},
        {"!0*S\r!0C100\r!3C30\r!0*E1\r", "0,1\r", 100},
        {"!0*E1\r", "4\r", 0},
        {"!0*S\r!0C100\r!0*E1\r!0*E1\r", "0,1\r4\r", 100},
        {"!0*S\r!0C100\r!0H\r!0*E1\r", "8\rC\r", 0},
        {"!0*S\r!0C100\r!0J\r!0P\r", "0\r0,0,0\r", 0},
        {"!0*S\r!0C100\r!7J\r!0P\r", "0\r0,0,0\r", 0},
    };
    for (size_t i = 0; i < sizeof packets / sizeof packets[0]; i++) {
        rig_set_up();
        expect_sent(packets[i].bytes, packets[i].answer);
        rig_run_ms(1000);
        TEST_ASSERT_EQUAL_INT64_MESSAGE(packets[i].x, rig_position[0], packets[i].bytes);
        TEST_ASSERT_EQUAL_UINT32(0, machine.pwm_permille);
        TEST_ASSERT_EQUAL_UINT32(1000, unit.queue.modal.speed);
    }
}

void test_b_counts_for_the_vectors_after_it_and_stays(void)
{
    expect_sent("!0B700\r", "0\r");
    expect_sent("!0*S\r!0C1000\r!0B500\r!0C1000\r!0C1000\r!0B300\r!0*E5\r", "0,5\r");
    TEST_ASSERT_EQUAL_UINT32(700, unit.queue.vectors[0].brake);
    TEST_ASSERT_EQUAL_UINT32(500, unit.queue.vectors[1].brake);
    TEST_ASSERT_EQUAL_UINT32(500, unit.queue.vectors[2].brake);
    rig_expect("0C1000", "0");
    TEST_ASSERT_EQUAL_UINT32(300, unit.queue.vectors[3].brake);
    rig_run_ms(10000);
}

void test_of_a_refused_packet_b_is_as_before(void)
{
    expect_sent("!0B700\r", "0\r");
    expect_sent("!0*S\r!0B500\r!0C1000\r!0*E3\r", "2,0\r");
    TEST_ASSERT_EQUAL_UINT32(700, unit.queue.modal.brake);
}

void test_nothing_moves_before_the_end_of_a_packet(void)
{
    rig_send("!0*S\r!0C1000\r!0C1000\r");
    rig_run_ms(500);
    TEST_ASSERT_EQUAL_UINT(0, rig_pulses[0]);
    expect_sent("!0*E2\r", "0,2\r");
    rig_run_ms(3000);
    TEST_ASSERT_EQUAL_INT64(2000, rig_position[0]);
}

void test_silence_ends_a_packet(void)
{
    rig_heard_count = 0;
    rig_send("!0*S\r!0C1000\r");
    rig_run_ms(990);
    TEST_ASSERT_EQUAL_UINT32(0, rig_heard_count);
    TEST_ASSERT_EQUAL_STRING("2,0", rig_answer_within(30));
    expect_sent("!0*E1\r", "4\r");
    expect_sent("!0P\r", "0,0,0\r");
}

static void fill(unsigned vectors)
{
    for (unsigned i = 0; i < vectors; i++) {
        rig_expect("0C1000", "0");
    }
}

void test_a_packet_that_does_not_fit_leaves_the_queue_as_it_is(void)
{
    fill(GVE_QUEUE_VECTORS - 2);
    expect_sent("!0*S\r!0C1\r!0C1\r!0C1\r!0*E3\r", "1,0\r");
    expect_sent("!0*S\r!0C1\r!0C1\r!0C0,0\r!0*E3\r", "0,3\r");
    expect_sent("!0*S\r!0C1\r!0*E1\r", "1,0\r");
    expect_sent("!0*S\r!0C0,0\r!0*E1\r", "0,1\r");
    expect_sent("!0*S\r!0B50\r!0*E1\r", "0,1\r");
}

static void send_packet_of(unsigned commands, unsigned told)
{
    static char bytes[RIG_BYTES];
    int length = snprintf(bytes, sizeof bytes, "!0*S\r");
    for (unsigned i = 0; i < commands; i++) {
        length += snprintf(&bytes[length], sizeof bytes - (size_t)length, "!0C2\r");
    }
    (void)snprintf(&bytes[length], sizeof bytes - (size_t)length, "!0*E%u\r", told);
    rig_heard_count = 0;
    rig_send(bytes);
}

void test_a_packet_can_fill_the_queue(void)
{
    send_packet_of(128, 128);
    TEST_ASSERT_EQUAL_STRING("0,128", rig_answer_within(5));
    rig_expect("0F", "0,60");
    rig_run_ms(3000);
    rig_expect("0P", "0,256,0");
}

void test_a_packet_of_more_than_128_commands_is_out_of_bounds(void)
{
    send_packet_of(129, 128);
    TEST_ASSERT_EQUAL_STRING("5,0", rig_answer_within(5));
    rig_expect("0P", "0,0,0");
}

void test_vectors_of_a_packet_join_what_runs(void)
{
    rig_expect("0L1000", "0");
    expect_sent("!0*S\r!0C500\r!0*E1\r", "0,1\r");
    rig_run_ms(3000);
    rig_expect("0P", "0,1500,0");
}

void test_vectors_of_a_packet_wait_for_g(void)
{
    rig_expect("0H", "8");
    expect_sent("!0*S\r!0C500\r!0*E1\r", "8,1\r");
    rig_run_ms(1000);
    rig_expect("0P", "8,0,0");
    rig_expect("0G", "0");
    rig_run_ms(1000);
    rig_expect("0P", "0,500,0");
}

void test_a_packet_with_vectors_is_refused_after_a_fault(void)
{
    lock();
    expect_sent("!0*S\r!0C500\r!0*E1\r", "F,0\r");
    expect_sent("!0*S\r!0C500\r!0*E2\r", "A,0\r");
    expect_sent("!0*S\r!0B500\r!0*E1\r", "8,1\r");
    rig_expect("0D", "0");
    expect_sent("!0*S\r!0C500\r!0*E1\r", "0,1\r");
    rig_run_ms(1000);
}

void test_a_packet_has_no_parameter_of_a_coupled_axis(void)
{
    rig_expect("0EW0C,01", "0");
    expect_sent("!0*S\r!0C500,0,0,1\r!0*E1\r", "5,0\r");
    expect_sent("!0*S\r!0C500,0,0,0\r!0*E1\r", "0,1\r");
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL_INT64(500, rig_position[3]);
}

void test_the_packet_of_the_data_sheet_is_taken_with_its_sums(void)
{
    rig_expect("0%+", "0,5C");
    expect_sent("!0*S,FA\r!0C697,30,0,51\r!0C692,92,0,54\r!0C682,151,0,7F\r!0C665,209,0,84\r!0C645,268,0,87\r"
                "!0C619,322,0,7F\r!0C589,375,0,8D\r!0C553,425,0,80\r!0C515,471,0,7F\r!0C471,515,0,7F\r!0*E10,4D\r",
                "0,10,E9\r");
    rig_run_ms(10000);
    TEST_ASSERT_EQUAL_INT64(6128, rig_position[0]);
    TEST_ASSERT_EQUAL_INT64(2858, rig_position[1]);
}

void test_a_damaged_line_of_a_packet_with_sums_is_told_at_its_end(void)
{
    rig_expect("0%+", "0,5C");
    expect_sent("!0*S,FA\r!0C697,30,0,52\r!0C692,92,0,54\r!0*E2,1E\r", "2,0,BA\r");
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL_INT64(0, rig_position[0]);
}

/* Puts all bytes on the line at once, as they lie in the ring of a board after a long pass. */
static void send_at_once(const char *bytes)
{
    uint32_t count = (uint32_t)strlen(bytes);
    for (uint32_t i = 0; i < count; i++) {
        rig_script[i] = (struct host_line_byte){.tick = machine.now + 1U, .value = (uint8_t)bytes[i]};
    }
    host_machine_set_line(&machine, rig_script, count);
    rig_run_ms(20);
}

void test_commands_of_a_packet_that_lie_in_the_line_are_taken_together(void)
{
    char bytes[250] = "!0*S\r";
    rig_heard_count = 0;
    for (unsigned i = 0; i < 25; i++) {
        (void)strcat(bytes, "!0C1\r");
    }
    send_at_once(bytes);
    send_at_once("!0C2\r!0*E26\r!0P1\r");
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL_STRING_LEN("0,26\r", rig_heard, 5);
    TEST_ASSERT_EQUAL_INT64(27, rig_position[0]);
}

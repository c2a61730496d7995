#include "unity.h"

#include "modbus_rig.h"

static const uint16_t values[MODBUS_READ_MAX] = {0x1234, 0xABCD, 0x0001, 0xFF00};

void setUp(void)
{
    memset(&server, 0xA5, sizeof server);
    rig_set_up();
}

void tearDown(void)
{
    TEST_ASSERT_FALSE(modbus_is_sending(&server));
    TEST_ASSERT_NULL(modbus_next(&server));
}

static void answer(const uint16_t *read)
{
    modbus_answer(&server, read);
}

/* A request has come that writes and reads so. */
static const struct modbus_request *assert_next(unsigned write_first, unsigned write_count, unsigned read_first,
                                                unsigned read_count)
{
    const struct modbus_request *request = modbus_next(&server);
    TEST_ASSERT_NOT_NULL(request);
    TEST_ASSERT_EQUAL_UINT16(write_first, request->write_first);
    TEST_ASSERT_EQUAL_UINT16(write_count, request->write_count);
    TEST_ASSERT_EQUAL_UINT16(read_first, request->read_first);
    TEST_ASSERT_EQUAL_UINT16(read_count, request->read_count);
    TEST_ASSERT_NULL(modbus_next(&server));
    return request;
}

static void assert_refused(const char *request, const char *answered)
{
    rig_take_sealed(request);
    TEST_ASSERT_NULL(modbus_next(&server));
    assert_sent_sealed(answered);
}

/* ---- requests -------------------------------------------------------------------------------------------------- */

void test_a_register_is_written(void)
{
    rig_take_text("01 06 00 64 01 01 08 45");
    const struct modbus_request *request = assert_next(100, 1, 0, 0);
    TEST_ASSERT_EQUAL_UINT8(MODBUS_WRITE_ONE, request->function);
    TEST_ASSERT_EQUAL_HEX16(0x0101, request->values[0]);
    TEST_ASSERT_FALSE(request->broadcast);
    TEST_ASSERT_EQUAL_UINT64(rig_tick - RIG_SILENCE_TICKS - RIG_CHARACTER_TICKS, request->end_tick);
    answer(NULL);
    assert_sent("01 06 00 64 01 01 08 45");
    assert_only(1, MODBUS_COUNT_FRAMES, 0, MODBUS_COUNTS_TOTAL);
}

void test_registers_are_written(void)
{
    rig_take_text("01 10 00 64 00 08 10 02 02 00 00 00 00 27 10 01 F4 00 01 03 E8 00 00 D6 42");
    static const uint16_t expected[] = {0x0202, 0, 0, 0x2710, 0x01F4, 1, 0x03E8, 0};
    const struct modbus_request *request = assert_next(100, 8, 0, 0);
    TEST_ASSERT_EQUAL_UINT8(MODBUS_WRITE, request->function);
    TEST_ASSERT_EQUAL_HEX16_ARRAY(expected, request->values, 8);
    answer(NULL);
    assert_sent("01 10 00 64 00 08 80 10");
}

void test_registers_are_read(void)
{
    rig_take_text("01 04 00 6E 00 08 90 11");
    TEST_ASSERT_EQUAL_UINT8(MODBUS_READ_INPUTS, assert_next(0, 0, 110, 8)->function);
    static const uint16_t status[] = {0x0103, 0, 0x0202, 0, 0, 0, 0, 4720};
    answer(status);
    assert_sent("01 04 10 01 03 00 00 02 02 00 00 00 00 00 00 00 00 12 70 28 86");

    rig_take_sealed("01 03 FF FF 00 01");
    TEST_ASSERT_EQUAL_UINT8(MODBUS_READ, assert_next(0, 0, 65535, 1)->function);
    answer(values);
    assert_sent_sealed("01 03 02 12 34");
}

void test_registers_are_written_and_read(void)
{
    rig_take_text("01 17 02 08 00 10 01 F4 00 0C 18 00 00 01 F4 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
                  "00 00 0E 5B");
    static const uint16_t written[12] = {0, 0x01F4};
    const struct modbus_request *request = assert_next(500, 12, 520, 16);
    TEST_ASSERT_EQUAL_UINT8(MODBUS_WRITE_AND_READ, request->function);
    TEST_ASSERT_EQUAL_HEX16_ARRAY(written, request->values, 12);
    static const uint16_t read[16] = {0x0103, 0, 0, 6380};
    answer(read);
    assert_sent("01 17 20 01 03 00 00 00 00 18 EC 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
                "00 00 D6 89");
}

void test_the_owner_refuses_what_registers_do_not_allow(void)
{
    rig_take_text("01 06 00 66 00 00 69 D5");
    (void)assert_next(102, 1, 0, 0);
    modbus_refuse(&server, MODBUS_EXCEPTION_ADDRESS);
    assert_sent("01 86 02 C3 A1");
    rig_take_text("01 06 00 64 03 09 08 E3");
    (void)assert_next(100, 1, 0, 0);
    modbus_refuse(&server, MODBUS_EXCEPTION_VALUE);
    assert_sent("01 86 03 02 61");
    rig_take_text("01 10 00 82 00 04 08 00 00 0C 80 00 00 9C 40 24 21");
    (void)assert_next(130, 4, 0, 0);
    modbus_refuse(&server, MODBUS_EXCEPTION_BUSY);
    assert_sent("01 90 06 CC 02");
    assert_only(3, MODBUS_COUNT_FRAMES, 3, MODBUS_COUNT_EXCEPTIONS);
}

/* ---- form ------------------------------------------------------------------------------------------------------ */

void test_functions_that_are_not_known_are_refused_with_1(void)
{
    rig_take_text("01 01 00 00 00 08 3D CC");
    assert_sent("01 81 01 81 90");
    unsigned refused = 1;
    for (unsigned function = 0; function <= 255U; function++) {
        char request[RIG_TEXT_ROOM];
        char answered[RIG_TEXT_ROOM];
        if (function == 3U || function == 4U || function == 6U || function == 16U || function == 23U ||
            function == 43U) {
            continue;
        }
        (void)snprintf(request, sizeof request, "01 %02X", function);
        (void)snprintf(answered, sizeof answered, "01 %02X 01", function | 0x80U);
        assert_refused(request, answered);
        refused++;
    }
    assert_only(refused, MODBUS_COUNT_FRAMES, refused, MODBUS_COUNT_EXCEPTIONS);
}

void test_numbers_and_lengths_that_are_wrong_are_refused_with_3(void)
{
    assert_refused("01 03", "01 83 03");
    assert_refused("01 03 00 00 00 01 00", "01 83 03");
    assert_refused("01 03 00 00 00 00", "01 83 03");
    assert_refused("01 03 00 00 00 7E", "01 83 03");
    assert_refused("01 04 00 00 01 01", "01 84 03");
    assert_refused("01 04 00 00 00", "01 84 03");
    assert_refused("01 06 00 64 01", "01 86 03");
    assert_refused("01 06 00 64 01 01 00", "01 86 03");
    assert_refused("01 10 00 64 00 01", "01 90 03");
    assert_refused("01 10 00 64 00 00 00", "01 90 03");
    assert_refused("01 10 00 64 00 01 02", "01 90 03");
    assert_refused("01 10 00 64 00 01 02 00", "01 90 03");
    assert_refused("01 10 00 64 00 01 02 00 00 00", "01 90 03");
    assert_refused("01 10 00 64 00 01 01 00 00", "01 90 03");
    assert_refused("01 10 00 64 00 02 02 00 00", "01 90 03");
    assert_refused("01 10 00 64 00 81 02 00 00", "01 90 03");
    assert_refused("01 17 00 00 00 01 00 64 00 01", "01 97 03");
    assert_refused("01 17 00 00 00 01 00 64 00 00 00", "01 97 03");
    assert_refused("01 17 00 00 00 00 00 64 00 01 02 00 00", "01 97 03");
    assert_refused("01 17 00 00 00 7E 00 64 00 01 02 00 00", "01 97 03");
    assert_refused("01 17 00 00 00 01 00 64 00 01 02 00", "01 97 03");
    assert_refused("01 17 00 00 00 01 00 64 00 01 03 00 00", "01 97 03");
    assert_refused("01 17 00 00 00 01 00 64 00 02 02 00 00", "01 97 03");
}

/* A request of `head` and so many registers of zeros. */
static void take_zeros(const char *head, uint32_t count)
{
    char text[RIG_TEXT_ROOM];
    size_t length = (size_t)snprintf(text, sizeof text, "%s", head);
    for (uint32_t i = 0; i < count; i++) {
        length += (size_t)snprintf(&text[length], sizeof text - length, " 00 00");
    }
    rig_take_sealed(text);
}

void test_the_most_registers_are_123_to_write_125_to_read_and_121_to_write_and_read(void)
{
    take_zeros("01 10 00 00 00 7B F6", 123);
    (void)assert_next(0, 123, 0, 0);
    answer(NULL);
    assert_sent_sealed("01 10 00 00 00 7B");
    take_zeros("01 10 00 00 00 7C F8", 123);
    assert_sent_sealed("01 90 03");
    take_zeros("01 17 00 00 00 7D 00 00 00 79 F2", 121);
    (void)assert_next(0, 121, 0, 125);
    answer(values);
    (void)rig_poll_in(0);
    TEST_ASSERT_EQUAL_UINT32(255 * 3 - 1, strlen(rig_sent()));
    take_zeros("01 17 00 00 00 7D 00 00 00 7A F4", 121);
    assert_sent_sealed("01 97 03");
}

/* ---- identification -------------------------------------------------------------------------------------------- */

void test_the_unit_tells_what_it_is(void)
{
    rig_take_text("01 2B 0E 01 00 70 77");
    TEST_ASSERT_NULL(modbus_next(&server));
    assert_sent("01 2B 0E 01 81 00 00 03 00 0D 6F 70 65 6E 20 66 69 72 6D 77 61 72 65 01 04 50 4F 53 34 02 05 30 31 "
                "2E 30 30 BE 9B");
    assert_refused("01 2B 0E 03 01", "01 2B 0E 03 81 00 00 02 01 04 50 4F 53 34 02 05 30 31 2E 30 30");
    assert_refused("01 2B 0E 02 02", "01 2B 0E 02 81 00 00 01 02 05 30 31 2E 30 30");
    assert_refused("01 2B 0E 04 01", "01 2B 0E 04 81 00 00 01 01 04 50 4F 53 34");
    assert_only(4, MODBUS_COUNT_FRAMES, 0, MODBUS_COUNTS_TOTAL);
}

void test_an_identification_keeps_nothing_of_the_answer_before(void)
{
    rig_take_sealed("01 03 00 00 00 04");
    (void)assert_next(0, 0, 0, 4);
    answer((const uint16_t[]){0xA5A5, 0xA5A5, 0xA5A5, 0xA5A5});
    assert_sent_sealed("01 03 08 A5 A5 A5 A5 A5 A5 A5 A5");
    assert_refused("01 2B 0E 04 01", "01 2B 0E 04 81 00 00 01 01 04 50 4F 53 34");
}

void test_from_an_object_that_is_not_known_all_are_told(void)
{
    const char *all = "01 2B 0E 02 81 00 00 03 00 0D 6F 70 65 6E 20 66 69 72 6D 77 61 72 65 01 04 50 4F 53 34 02 05 "
                      "30 31 2E 30 30";
    assert_refused("01 2B 0E 02 03", all);
    assert_refused("01 2B 0E 02 FF", all);
}

void test_identifications_that_are_wrong_are_refused_in_the_order_1_3_2(void)
{
    assert_refused("01 2B", "01 AB 03");
    assert_refused("01 2B 0D", "01 AB 01");
    assert_refused("01 2B 0D 01 00 00", "01 AB 01");
    assert_refused("01 2B 0E 01", "01 AB 03");
    assert_refused("01 2B 0E 01 00 00", "01 AB 03");
    assert_refused("01 2B 0E 00 00", "01 AB 03");
    assert_refused("01 2B 0E 05 09", "01 AB 03");
    assert_refused("01 2B 0E 04 03", "01 AB 02");
    assert_only(8, MODBUS_COUNT_FRAMES, 8, MODBUS_COUNT_EXCEPTIONS);
}

/* ---- addresses ------------------------------------------------------------------------------------------------- */

void test_frames_for_others_are_counted_and_nothing_else(void)
{
    char request[RIG_TEXT_ROOM];
    for (unsigned address = 2; address <= 255U; address++) {
        (void)snprintf(request, sizeof request, "%02X 06 00 64 01 01", address);
        rig_take_sealed(request);
        TEST_ASSERT_NULL(modbus_next(&server));
        assert_nothing_sent();
    }
    assert_only(254, MODBUS_COUNT_FOREIGN, 0, MODBUS_COUNTS_TOTAL);
    TEST_ASSERT_EQUAL_UINT64(0, server.heard_tick);
}

void test_a_broadcast_is_executed_and_not_answered(void)
{
    rig_take_text("00 06 00 64 03 03 89 35");
    const struct modbus_request *request = assert_next(100, 1, 0, 0);
    TEST_ASSERT_TRUE(request->broadcast);
    TEST_ASSERT_EQUAL_HEX16(0x0303, request->values[0]);
    answer(NULL);
    assert_nothing_sent();
    rig_take_sealed("00 10 00 64 00 01 02 03 03");
    TEST_ASSERT_TRUE(assert_next(100, 1, 0, 0)->broadcast);
    modbus_refuse(&server, MODBUS_EXCEPTION_VALUE);
    assert_nothing_sent();
    assert_only(2, MODBUS_COUNT_FRAMES, 1, MODBUS_COUNT_EXCEPTIONS);
    TEST_ASSERT_EQUAL_UINT64(0, server.heard_tick);
}

void test_broadcasts_of_other_functions_are_ignored(void)
{
    rig_take_sealed("00 03 00 00 00 01");
    assert_nothing_sent();
    rig_take_sealed("00 17 00 00 00 01 00 64 00 01 02 00 00");
    assert_nothing_sent();
    rig_take_sealed("00 2B 0E 01 00");
    assert_nothing_sent();
    rig_take_sealed("00 55");
    assert_nothing_sent();
    assert_only(4, MODBUS_COUNT_FRAMES, 0, MODBUS_COUNTS_TOTAL);
}

void test_a_broadcast_that_is_wrong_is_counted_and_not_answered(void)
{
    rig_take_sealed("00 06 00 64 03 03 00");
    TEST_ASSERT_NULL(modbus_next(&server));
    assert_nothing_sent();
    assert_only(1, MODBUS_COUNT_FRAMES, 1, MODBUS_COUNT_EXCEPTIONS);
}

void test_the_last_good_frame_to_this_unit_is_known(void)
{
    rig_take_sealed("01 03 00 00 00 01");
    uint64_t heard = rig_tick - RIG_SILENCE_TICKS - RIG_CHARACTER_TICKS;
    (void)assert_next(0, 0, 0, 1);
    TEST_ASSERT_EQUAL_UINT64(heard, server.heard_tick);
    answer(values);
    assert_sent_sealed("01 03 02 12 34");
    rig_take_sealed("00 06 00 64 03 03");
    (void)assert_next(100, 1, 0, 0);
    answer(NULL);
    TEST_ASSERT_EQUAL_UINT64(heard, server.heard_tick);
    assert_refused("01 55", "01 D5 01");
    TEST_ASSERT_EQUAL_UINT64(rig_tick - RIG_SILENCE_TICKS - RIG_CHARACTER_TICKS, server.heard_tick);
}

/* Also what is refused, and what the server answers by itself. */
void test_a_good_frame_of_any_function_is_heard(void)
{
    static const char *const requests[] = {
        "01 03 00 00 00 01",       "01 04 00 00 00 01",
        "01 06 00 64 01 01",       "01 10 00 64 00 01 02 01 01",
        "01 2B 0E 01 00",          "01 17 00 00 00 01 00 64 00 01 02 01 01",
        "01 10 00 64 00 01 03 01", "01 55",
    };
    for (unsigned i = 0; i < sizeof requests / sizeof requests[0]; i++) {
        rig_take_sealed(requests[i]);
        TEST_ASSERT_EQUAL_UINT64_MESSAGE(rig_tick - RIG_SILENCE_TICKS - RIG_CHARACTER_TICKS, server.heard_tick,
                                         requests[i]);
        (void)modbus_next(&server);
        modbus_refuse(&server, MODBUS_EXCEPTION_VALUE);
        (void)rig_poll_in(0);
        (void)rig_sent();
    }
}

void test_every_address_that_the_switch_can_say_is_taken(void)
{
    char text[RIG_TEXT_ROOM];
    for (unsigned node = 1; node <= (unsigned)MODBUS_NODE_MAX; node++) {
        rig_set_up();
        server.node = (uint8_t)node;
        (void)snprintf(text, sizeof text, "%02X 06 00 64 01 01", node);
        rig_take_sealed(text);
        (void)assert_next(100, 1, 0, 0);
        answer(NULL);
        assert_sent_sealed(text);
    }
}

/* ---- time ------------------------------------------------------------------------------------------------------ */

void test_an_answer_begins_up_to_20_ms_after_the_request(void)
{
    for (uint64_t late = 0; late < 2; late++) {
        rig_set_up();
        rig_take_text("01 06 00 64 01 01 08 45");
        uint64_t end = assert_next(100, 1, 0, 0)->end_tick;
        answer(NULL);
        rig_tick = end + (uint64_t)20 * TICKS_PER_MS + late;
        assert_sent(late == 0 ? "01 06 00 64 01 01 08 45" : "");
        assert_only(1, MODBUS_COUNT_FRAMES, (uint32_t)late, MODBUS_COUNT_UNSENT);
    }
}

void test_the_owner_may_take_longer_where_it_says_so_for_one_request(void)
{
    rig_take_text("01 06 00 64 01 01 08 45");
    (void)assert_next(100, 1, 0, 0);
    modbus_allow(&server, (uint64_t)2000 * TICKS_PER_MS);
    (void)rig_poll_in((uint64_t)1900 * TICKS_PER_MS);
    answer(NULL);
    assert_sent("01 06 00 64 01 01 08 45");
    rig_take_text("01 06 00 64 01 01 08 45");
    (void)assert_next(100, 1, 0, 0);
    (void)rig_poll_in((uint64_t)1900 * TICKS_PER_MS);
    answer(NULL);
    assert_nothing_sent();
    assert_count(1, MODBUS_COUNT_UNSENT);
}

void test_an_answer_is_not_sent_if_a_byte_comes_before(void)
{
    rig_take_text("01 06 00 64 01 01 08 45");
    (void)assert_next(100, 1, 0, 0);
    answer(NULL);
    rig_take_after(RIG_CHARACTER_TICKS, 0x55, false);
    assert_nothing_sent();
    rig_wait();
    assert_nothing_sent();
    assert_count(1, MODBUS_COUNT_UNSENT);
    assert_count(1, MODBUS_COUNT_LENGTH);
}

void test_a_byte_before_the_owner_has_answered_takes_the_answer_too(void)
{
    rig_take_text("01 06 00 64 01 01 08 45");
    (void)assert_next(100, 1, 0, 0);
    rig_take_after(RIG_CHARACTER_TICKS, 0x55, false);
    rig_take_after(RIG_CHARACTER_TICKS, 0x55, false);
    answer(NULL);
    assert_nothing_sent();
    answer(NULL);
    modbus_refuse(&server, MODBUS_EXCEPTION_VALUE);
    assert_only(1, MODBUS_COUNT_FRAMES, 1, MODBUS_COUNT_UNSENT);
    rig_wait();
    assert_nothing_sent();
}

void test_a_request_that_is_seen_with_the_byte_after_it_is_executed_and_not_answered(void)
{
    struct rig_frame frame = rig_sealed("01 06 00 64 01 01");
    rig_take(frame.bytes, frame.length);
    rig_take_after(RIG_SILENCE_TICKS + RIG_CHARACTER_TICKS, 0x01, false);
    (void)assert_next(100, 1, 0, 0);
    answer(NULL);
    assert_nothing_sent();
    rig_take(&frame.bytes[1], frame.length - 1U);
    rig_wait();
    (void)assert_next(100, 1, 0, 0);
    answer(NULL);
    assert_sent("01 06 00 64 01 01 08 45");
    assert_only(2, MODBUS_COUNT_FRAMES, 1, MODBUS_COUNT_UNSENT);
}

void test_a_refusal_of_the_server_is_not_sent_if_a_byte_has_come(void)
{
    struct rig_frame frame = rig_sealed("01 55");
    rig_take(frame.bytes, frame.length);
    rig_take_after(RIG_SILENCE_TICKS + RIG_CHARACTER_TICKS, 0x01, false);
    assert_nothing_sent();
    assert_count(1, MODBUS_COUNT_EXCEPTIONS);
    assert_count(1, MODBUS_COUNT_UNSENT);
    rig_wait();
}

void test_the_next_request_takes_the_place_of_one_that_is_still_being_executed(void)
{
    rig_take_text("01 06 00 64 01 01 08 45");
    (void)assert_next(100, 1, 0, 0);
    rig_take_sealed("01 2B 0E 04 01");
    answer(NULL);
    assert_sent_sealed("01 2B 0E 04 81 00 00 01 01 04 50 4F 53 34");
    rig_take_text("01 06 00 64 01 01 08 45");
    (void)assert_next(100, 1, 0, 0);
    rig_take_sealed("01 03 00 00 00 01");
    (void)assert_next(0, 0, 0, 1);
    answer(values);
    assert_sent_sealed("01 03 02 12 34");
    assert_count(2, MODBUS_COUNT_UNSENT);
}

void test_after_an_answer_of_its_own_a_frame_needs_no_silence(void)
{
    rig_take_text("01 06 00 64 01 01 08 45");
    (void)assert_next(100, 1, 0, 0);
    answer(NULL);
    assert_sent("01 06 00 64 01 01 08 45");
    rig_take_text("01 06 00 64 01 01 08 45");
    (void)assert_next(100, 1, 0, 0);
    answer(NULL);
    assert_sent("01 06 00 64 01 01 08 45");
}

void test_main_is_called_when_silence_means_something(void)
{
    struct rig_frame frame = rig_sealed("01 06 00 64 01 01");
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, rig_poll_in(0));
    rig_take(frame.bytes, frame.length);
    uint64_t end = rig_tick + RIG_SILENCE_TICKS;
    TEST_ASSERT_EQUAL_UINT64(end, rig_poll_in(0));
    TEST_ASSERT_EQUAL_UINT64(end + RIG_CHARACTER_TICKS, rig_poll_in(RIG_SILENCE_TICKS));
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, rig_poll_in(RIG_CHARACTER_TICKS));
    (void)assert_next(100, 1, 0, 0);
    answer(NULL);
    TEST_ASSERT_EQUAL_UINT64(TICK_NEVER, rig_poll_in(0));
    (void)rig_sent();
}

void test_an_answer_goes_out_byte_by_byte_as_often_as_asked(void)
{
    rig_take_text("01 06 00 64 01 01 08 45");
    (void)assert_next(100, 1, 0, 0);
    answer(NULL);
    (void)rig_poll_in(0);
    TEST_ASSERT_EQUAL_HEX8(0x01, modbus_byte(&server));
    TEST_ASSERT_EQUAL_HEX8(0x01, modbus_byte(&server));
    modbus_advance(&server);
    TEST_ASSERT_EQUAL_HEX8(0x06, modbus_byte(&server));
    (void)rig_poll_in((uint64_t)1000 * TICKS_PER_MS);
    TEST_ASSERT_EQUAL_STRING("06 00 64 01 01 08 45", rig_sent());
}

void test_every_count_has_a_text(void)
{
    for (unsigned i = 0; i < (unsigned)MODBUS_COUNTS_TOTAL; i++) {
        TEST_ASSERT_NOT_NULL(modbus_count_text((enum modbus_count)i));
    }
}

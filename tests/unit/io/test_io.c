#include "io.h"
#include "mock_hal_io.h"
#include "mock_hal_trace.h"
#include "unity.h"

static const uint64_t now_ticks = UINT64_C(0x123456789A);

static struct io io;

void setUp(void)
{
    hal_io_write_outputs_Ignore();
    hal_trace_Ignore();
    io_init(&io);
    hal_io_write_outputs_StopIgnore();
}

void tearDown(void)
{
}

static void sample(uint8_t inputs)
{
    hal_io_read_inputs_ExpectAndReturn(inputs);
    (void)io_sample(&io);
}

static void set_output(unsigned output, bool level, uint8_t pins)
{
    hal_io_write_outputs_Expect(pins);
    io_set(&io, output, level, 1, now_ticks);
}

static void disconnect(void)
{
    hal_io_write_outputs_Expect(0);
    io_connect(&io, false);
}

void test_init_clears_the_pins(void)
{
    hal_io_write_outputs_Expect(0);
    io_init(&io);
}

void test_init_makes_everything_0(void)
{
    sample(0xFF);
    set_output(2, true, 0x04);
    io.connected = false;

    hal_io_write_outputs_Expect(0);
    io_init(&io);

    TEST_ASSERT_EQUAL_HEX8(0, io_inputs(&io));
    TEST_ASSERT_EQUAL_HEX8(0, io.outputs);
    TEST_ASSERT_TRUE(io.connected);
}

void test_inputs_are_those_sampled_last(void)
{
    sample(0xA5);
    sample(0x5A);
    TEST_ASSERT_EQUAL_HEX8(0x5A, io_inputs(&io));
}

void test_a_sample_tells_whether_an_input_has_changed(void)
{
    hal_io_read_inputs_ExpectAndReturn(0x10);
    TEST_ASSERT_TRUE(io_sample(&io));
    hal_io_read_inputs_ExpectAndReturn(0x10);
    TEST_ASSERT_FALSE(io_sample(&io));
    hal_io_read_inputs_ExpectAndReturn(0x00);
    TEST_ASSERT_TRUE(io_sample(&io));
}

void test_each_output_has_its_own_pin(void)
{
    for (unsigned output = 0; output < UNIT_OUTPUTS; output++) {
        set_output(output, true, (uint8_t)(1U << output));
        set_output(output, false, 0);
    }
}

void test_outputs_keep_their_levels_until_they_are_cleared(void)
{
    set_output(0, true, 0x01);
    set_output(7, true, 0x81);
    set_output(0, false, 0x80);
    TEST_ASSERT_EQUAL_HEX8(0x80, io.outputs);
}

void test_setting_an_output_is_traced_with_its_number(void)
{
    hal_trace_StopIgnore();
    hal_trace_Expect(now_ticks, 3, HAL_TRACE_OUT, 5);
    hal_io_write_outputs_Expect(0x10);
    io_set(&io, 4, true, 3, now_ticks);
}

void test_clearing_an_output_is_traced_with_a_negative_number(void)
{
    hal_trace_StopIgnore();
    hal_trace_Expect(now_ticks, 0, HAL_TRACE_OUT, -5);
    hal_io_write_outputs_Expect(0);
    io_set(&io, 4, false, 0, now_ticks);
}

void test_every_write_of_an_output_is_traced(void)
{
    hal_trace_StopIgnore();
    hal_trace_Expect(now_ticks, 1, HAL_TRACE_OUT, 2);
    hal_trace_Expect(now_ticks + 1U, 1, HAL_TRACE_OUT, 2);
    hal_io_write_outputs_Ignore();
    io_set(&io, 1, true, 1, now_ticks);
    io_set(&io, 1, true, 1, now_ticks + 1U);
}

void test_disconnected_outputs_are_0_at_their_pins(void)
{
    set_output(3, true, 0x08);
    hal_io_write_outputs_Expect(0);
    io_connect(&io, false);
}

void test_outputs_set_while_disconnected_reach_no_pin(void)
{
    disconnect();
    io_set(&io, 3, true, 1, now_ticks);
    TEST_ASSERT_EQUAL_HEX8(0x08, io.outputs);
}

void test_outputs_set_while_disconnected_are_traced(void)
{
    disconnect();
    hal_trace_StopIgnore();
    hal_trace_Expect(now_ticks, 1, HAL_TRACE_OUT, 4);
    io_set(&io, 3, true, 1, now_ticks);
}

void test_connected_again_the_pins_show_the_outputs(void)
{
    set_output(0, true, 0x01);
    disconnect();
    io_set(&io, 3, true, 1, now_ticks);
    hal_io_write_outputs_Expect(0x09);
    io_connect(&io, true);
}

void test_inputs_are_sampled_while_outputs_are_disconnected(void)
{
    disconnect();
    sample(0x40);
    TEST_ASSERT_EQUAL_HEX8(0x40, io_inputs(&io));
}

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
    (void)io_sample_isr(&io);
}

static void set_output(unsigned number, bool level, uint8_t pins)
{
    hal_io_write_outputs_Expect(pins);
    io_set(&io, number, level, 1, now_ticks);
}

static void simulate(bool on, uint8_t pins)
{
    hal_io_write_outputs_Expect(pins);
    io_simulate(&io, on);
}

void test_init_clears_the_pins(void)
{
    hal_io_write_outputs_Expect(0);
    io_init(&io);
}

void test_init_makes_everything_0(void)
{
    sample(0xFF);
    set_output(3, true, 0x04);
    io_set(&io, 80, true, 1, now_ticks);
    io.memory_locked = true;
    io.simulating = true;

    hal_io_write_outputs_Expect(0);
    io_init(&io);

    TEST_ASSERT_EQUAL_HEX8(0, io_inputs(&io));
    TEST_ASSERT_EQUAL_HEX8(0, io.outputs);
    TEST_ASSERT_EQUAL_HEX16(0, io.variables);
    TEST_ASSERT_FALSE(io.memory_locked);
    TEST_ASSERT_FALSE(io.simulating);
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
    TEST_ASSERT_TRUE(io_sample_isr(&io));
    hal_io_read_inputs_ExpectAndReturn(0x10);
    TEST_ASSERT_FALSE(io_sample_isr(&io));
    hal_io_read_inputs_ExpectAndReturn(0x00);
    TEST_ASSERT_TRUE(io_sample_isr(&io));
}

void test_each_input_has_its_own_level(void)
{
    for (unsigned set = 1; set <= UNIT_INPUTS; set++) {
        sample((uint8_t)(1U << (set - 1U)));
        for (unsigned number = 1; number <= UNIT_INPUTS; number++) {
            TEST_ASSERT_EQUAL(number == set, io_level(&io, number));
        }
    }
}

void test_a_level_stays_until_the_next_sample(void)
{
    sample(0x01);
    TEST_ASSERT_TRUE(io_level(&io, 1));
    TEST_ASSERT_TRUE(io_level(&io, 1));
}

void test_each_variable_has_its_own_level(void)
{
    for (unsigned set = UNIT_VARIABLE_FIRST; set < UNIT_VARIABLE_FIRST + UNIT_VARIABLES; set++) {
        io_set(&io, set, true, 1, now_ticks);
        for (unsigned number = UNIT_VARIABLE_FIRST; number < UNIT_VARIABLE_FIRST + UNIT_VARIABLES; number++) {
            TEST_ASSERT_EQUAL(number == set, io_level(&io, number));
        }
        io_set(&io, set, false, 1, now_ticks);
    }
}

void test_clearing_a_variable_leaves_the_others(void)
{
    io_set(&io, 80, true, 1, now_ticks);
    io_set(&io, 95, true, 1, now_ticks);
    io_set(&io, 80, false, 1, now_ticks);
    TEST_ASSERT_EQUAL_HEX16(0x8000, io.variables);
}

void test_variables_do_not_touch_inputs_or_outputs(void)
{
    sample(0x0F);
    io_set(&io, 81, true, 1, now_ticks);
    TEST_ASSERT_EQUAL_HEX8(0x0F, io_inputs(&io));
    TEST_ASSERT_EQUAL_HEX8(0, io.outputs);
}

void test_each_output_has_its_own_pin(void)
{
    for (unsigned number = 1; number <= UNIT_OUTPUTS; number++) {
        set_output(number, true, (uint8_t)(1U << (number - 1U)));
        set_output(number, false, 0);
    }
}

void test_outputs_keep_their_levels_until_they_are_cleared(void)
{
    set_output(1, true, 0x01);
    set_output(8, true, 0x81);
    set_output(1, false, 0x80);
    TEST_ASSERT_EQUAL_HEX8(0x80, io.outputs);
}

void test_setting_an_output_is_traced_with_its_number(void)
{
    hal_trace_StopIgnore();
    hal_trace_Expect(now_ticks, 3, HAL_TRACE_OUT, 5);
    hal_io_write_outputs_Expect(0x10);
    io_set(&io, 5, true, 3, now_ticks);
}

void test_clearing_an_output_is_traced_with_a_negative_number(void)
{
    hal_trace_StopIgnore();
    hal_trace_Expect(now_ticks, 0, HAL_TRACE_OUT, -5);
    hal_io_write_outputs_Expect(0);
    io_set(&io, 5, false, 0, now_ticks);
}

void test_every_write_of_an_output_is_traced(void)
{
    hal_trace_StopIgnore();
    hal_trace_Expect(now_ticks, 1, HAL_TRACE_OUT, 2);
    hal_trace_Expect(now_ticks + 1U, 1, HAL_TRACE_OUT, 2);
    hal_io_write_outputs_Ignore();
    io_set(&io, 2, true, 1, now_ticks);
    io_set(&io, 2, true, 1, now_ticks + 1U);
}

void test_setting_a_variable_is_traced_with_its_number(void)
{
    hal_trace_StopIgnore();
    hal_trace_Expect(now_ticks, 4, HAL_TRACE_VAR, 95);
    io_set(&io, 95, true, 4, now_ticks);
}

void test_clearing_a_variable_is_traced_with_a_negative_number(void)
{
    hal_trace_StopIgnore();
    hal_trace_Expect(now_ticks, 4, HAL_TRACE_VAR, -80);
    io_set(&io, 80, false, 4, now_ticks);
}

void test_simulation_clears_the_output_pins(void)
{
    set_output(4, true, 0x08);
    hal_io_write_outputs_Expect(0);
    io_simulate(&io, true);
    TEST_ASSERT_TRUE(io.simulating);
}

void test_outputs_set_while_simulating_reach_no_pin(void)
{
    simulate(true, 0);
    io_set(&io, 4, true, 1, now_ticks);
    TEST_ASSERT_EQUAL_HEX8(0x08, io.outputs);
}

void test_outputs_set_while_simulating_are_traced(void)
{
    simulate(true, 0);
    hal_trace_StopIgnore();
    hal_trace_Expect(now_ticks, 1, HAL_TRACE_OUT, 4);
    io_set(&io, 4, true, 1, now_ticks);
}

void test_the_end_of_simulation_shows_the_outputs(void)
{
    set_output(1, true, 0x01);
    simulate(true, 0);
    io_set(&io, 4, true, 1, now_ticks);
    hal_io_write_outputs_Expect(0x09);
    io_simulate(&io, false);
    TEST_ASSERT_FALSE(io.simulating);
}

void test_inputs_are_sampled_while_simulating(void)
{
    simulate(true, 0);
    sample(0x40);
    TEST_ASSERT_TRUE(io_level(&io, 7));
}

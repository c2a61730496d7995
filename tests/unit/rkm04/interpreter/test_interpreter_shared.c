/* What the interpreters share, by the numbers of programs: inputs, outputs, variables, simulation. */
#include "interpreter_shared.h"
#include "mock_hal_io.h"
#include "mock_hal_trace.h"
#include "unity.h"

static const uint64_t now_ticks = UINT64_C(0x123456789A);

static struct io io;
static struct interpreter_shared shared;

void setUp(void)
{
    hal_trace_Ignore();
    hal_io_write_outputs_Expect(0);
    io_init(&io);
    interpreter_shared_init(&shared, &io);
}

void tearDown(void)
{
}

static void sample(uint8_t inputs)
{
    hal_io_read_inputs_ExpectAndReturn(inputs);
    (void)io_sample(&io);
}

static void set(unsigned number, bool level)
{
    interpreter_shared_set(&shared, number, level, 1, now_ticks);
}

void test_init_makes_everything_0(void)
{
    set(80, true);
    shared.memory_locked = true;

    interpreter_shared_init(&shared, &io);

    TEST_ASSERT_EQUAL_HEX16(0, shared.variables);
    TEST_ASSERT_FALSE(shared.memory_locked);
    TEST_ASSERT_FALSE(interpreter_shared_is_simulating(&shared));
}

void test_each_input_has_its_own_level(void)
{
    for (unsigned input = 1; input <= UNIT_INPUTS; input++) {
        sample((uint8_t)(1U << (input - 1U)));
        for (unsigned number = 1; number <= UNIT_INPUTS; number++) {
            TEST_ASSERT_EQUAL(number == input, interpreter_shared_level(&shared, number));
        }
    }
}

void test_each_variable_has_its_own_level(void)
{
    for (unsigned variable = 80; variable <= 95; variable++) {
        set(variable, true);
        for (unsigned number = 80; number <= 95; number++) {
            TEST_ASSERT_EQUAL(number == variable, interpreter_shared_level(&shared, number));
        }
        set(variable, false);
    }
}

void test_clearing_a_variable_leaves_the_others(void)
{
    set(80, true);
    set(95, true);
    set(80, false);
    TEST_ASSERT_EQUAL_HEX16(0x8000, shared.variables);
}

void test_variables_do_not_touch_inputs_or_outputs(void)
{
    sample(0x0F);
    set(81, true);
    TEST_ASSERT_EQUAL_HEX8(0x0F, io_inputs(&io));
    TEST_ASSERT_EQUAL_HEX8(0, io.outputs);
}

void test_each_output_has_its_own_pin(void)
{
    for (unsigned number = 1; number <= UNIT_OUTPUTS; number++) {
        hal_io_write_outputs_Expect((uint8_t)(1U << (number - 1U)));
        set(number, true);
        hal_io_write_outputs_Expect(0);
        set(number, false);
    }
    TEST_ASSERT_EQUAL_HEX16(0, shared.variables);
}

void test_every_write_is_traced_with_its_number_negative_when_cleared(void)
{
    hal_io_write_outputs_Ignore();
    hal_trace_StopIgnore();
    hal_trace_Expect(now_ticks, 1, HAL_TRACE_OUT, 8);
    hal_trace_Expect(now_ticks, 1, HAL_TRACE_OUT, -8);
    hal_trace_Expect(now_ticks, 1, HAL_TRACE_VAR, 95);
    hal_trace_Expect(now_ticks, 1, HAL_TRACE_VAR, -80);
    set(8, true);
    set(8, false);
    set(95, true);
    set(80, false);
}

void test_simulation_disconnects_the_outputs_and_its_end_connects_them(void)
{
    hal_io_write_outputs_Expect(0x04);
    set(3, true);
    hal_io_write_outputs_Expect(0);
    interpreter_shared_simulate(&shared, true);
    TEST_ASSERT_TRUE(interpreter_shared_is_simulating(&shared));
    hal_io_write_outputs_Expect(0x04);
    interpreter_shared_simulate(&shared, false);
    TEST_ASSERT_FALSE(interpreter_shared_is_simulating(&shared));
}

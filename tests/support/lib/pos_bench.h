/*
 * The server and the registers of a positioning unit, and as little of an owner as they need: what is written stands in
 * the registers, and nothing moves. For tests, fuzzers and probes.
 */
#ifndef POS_BENCH_H
#define POS_BENCH_H

#include <stddef.h>
#include <string.h>

#include "modbus.h"
#include "pos_write.h"

struct pos_bench {
    struct modbus server;
    struct pos_registers registers;
    struct pos_write write; /* the last one */
    uint32_t busy_axes;     /* have DISP = 1 or move; bit 0 is axis 1 */
    uint32_t executed;      /* requests */
};

static inline void pos_bench_init(struct pos_bench *bench, uint8_t node, uint64_t start_tick)
{
    struct modbus_setup setup = {
        .start_tick = start_tick,
        .rate_bd = 19200,
        .character_bits = 11,
        .identity = {.objects = {"open firmware", "POS4", "01.00"}},
        .node = node,
    };
    memset(bench, 0, sizeof *bench);
    modbus_init(&bench->server, &setup);
    pos_registers_init(&bench->registers);
}

/* In the order of the exceptions 2, 3, 6. */
static inline enum modbus_exception pos_bench_check(struct pos_bench *bench, const struct modbus_request *request)
{
    bool inputs = request->function == (uint8_t)MODBUS_READ_INPUTS;
    if (!pos_registers_may_write(request->write_first, request->write_count) ||
        !pos_registers_may_read(request->read_first, request->read_count, inputs)) {
        return MODBUS_EXCEPTION_ADDRESS;
    }
    if (!pos_write_init(&bench->write, &bench->registers, request->write_first, request->write_count,
                        request->values)) {
        return MODBUS_EXCEPTION_VALUE;
    }
    return (pos_write_axes(&bench->write) & bench->busy_axes) != 0U ? MODBUS_EXCEPTION_BUSY : MODBUS_EXCEPTION_NONE;
}

/* Executes the request that has come, if there is one. */
static inline void pos_bench_serve(struct pos_bench *bench)
{
    uint16_t values[MODBUS_READ_MAX];
    const struct modbus_request *request = modbus_next(&bench->server);
    if (request == NULL) {
        return;
    }
    enum modbus_exception exception = pos_bench_check(bench, request);
    if (exception != MODBUS_EXCEPTION_NONE) {
        modbus_refuse(&bench->server, exception);
        return;
    }
    bench->executed++;
    pos_write_apply(&bench->write, &bench->registers);
    pos_registers_read(&bench->registers, request->read_first, request->read_count, values);
    modbus_answer(&bench->server, values);
}

static inline void pos_bench_take(struct pos_bench *bench, const struct hal_line_byte *byte)
{
    modbus_take(&bench->server, byte);
    pos_bench_serve(bench);
}

/* What is due begins to be sent. */
static inline void pos_bench_poll(struct pos_bench *bench, uint64_t now_ticks)
{
    (void)modbus_poll(&bench->server, now_ticks, true);
    pos_bench_serve(bench);
    (void)modbus_poll(&bench->server, now_ticks, true);
}

#endif

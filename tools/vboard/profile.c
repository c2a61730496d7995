#include "profile.h"

#include <stdlib.h>
#include <string.h>

#include "complain.h"
#include "line.h"

enum {
    LINE_BYTES_MAX = 128,
    REGION_MASK = 0xFFFFF, /* of an address in its region */
    HEX_DIGITS = 8,
};

static const uint32_t region_base[COST_REGIONS] = {0, MEMORY_FLASH_BASE, MEMORY_SRAM_BASE};

static struct profile_table *present_table(struct profile *profile)
{
    const struct stats *stats = profile->wires.stats;
    return &profile->table[stats->depth == 0 ? 0 : stats->frame[stats->depth - 1U].exception];
}

/* The row of an instruction, in memory that is taken when it is first wanted. Null if there is none. */
static struct profile_row *find_row(struct profile_table *table, uint32_t address)
{
    struct profile_row **rows = &table->code[cost_region(address)];
    if (*rows == NULL) {
        *rows = calloc(COST_REGION_HALFWORDS, sizeof **rows);
    }
    return *rows == NULL ? NULL : &(*rows)[(address & REGION_MASK) >> 1];
}

static void begin(struct profile *profile, struct profile_row *row)
{
    profile->row->cycles += profile->wires.clock->now - profile->mark;
    profile->mark = profile->wires.clock->now;
    profile->row = row;
}

bool profile_open(struct profile *profile, const char *path)
{
    profile->on = path != NULL;
    profile->row = &profile->table[0].place[PROFILE_OTHER];
    return outfile_open(&profile->file, path);
}

void profile_reset(struct profile *profile)
{
    for (unsigned i = 0; i < NVIC_EXCEPTIONS; i++) {
        struct profile_table *table = &profile->table[i];
        memset(table->place, 0, sizeof table->place);
        for (unsigned region = 0; region < COST_REGIONS; region++) {
            if (table->code[region] != NULL) {
                memset(table->code[region], 0, COST_REGION_HALFWORDS * sizeof *table->code[region]);
            }
        }
    }
    profile->mark = profile->wires.clock->now;
}

void profile_at(struct profile *profile, uint32_t address)
{
    struct profile_table *table = present_table(profile);
    struct profile_row *row = find_row(table, address);
    if (row == NULL) {
        report_fail(profile->wires.report, "there is not memory enough for --profile");
    }
    begin(profile, row != NULL ? row : &table->place[PROFILE_OTHER]);
}

void profile_pause(struct profile *profile)
{
    begin(profile, &present_table(profile)->place[PROFILE_OTHER]);
}

void profile_place(struct profile *profile, enum profile_place place)
{
    struct profile_row *row = &present_table(profile)->place[place];
    row->cycles += profile->wires.clock->now - profile->mark;
    row->count++;
    profile->mark = profile->wires.clock->now;
}

void profile_bus(struct profile *profile, uint32_t address, uint64_t cycles)
{
    struct profile_row *row = profile->row;
    row->bus_cycles += cycles;
    row->peripheral = address;
}

static char *put_hex(char *at, uint32_t value)
{
    for (unsigned i = HEX_DIGITS; i > 0; i--) {
        *at++ = "0123456789abcdef"[value >> 4U * (i - 1U) & 0xFU];
    }
    return at;
}

static void put_row(struct profile *profile, unsigned exception, const char *place, uint32_t address,
                    const struct profile_row *row)
{
    if (row->cycles == 0 && row->count == 0) {
        return;
    }
    struct outfile *file = &profile->file;
    char *at = line_put_unsigned(outfile_reserve(file, LINE_BYTES_MAX), exception);
    *at++ = ',';
    at = place != NULL ? line_put_string(at, place) : put_hex(at, address);
    *at++ = ',';
    at = line_put_unsigned(at, row->count);
    *at++ = ',';
    at = line_put_unsigned(at, row->cycles);
    *at++ = ',';
    at = line_put_unsigned(at, row->bus_cycles);
    *at++ = ',';
    at = row->peripheral != 0 ? put_hex(at, row->peripheral) : at;
    *at++ = '\n';
    outfile_commit(file, at);
}

static void put_table(struct profile *profile, unsigned exception)
{
    static const char *const places[PROFILE_PLACES] = {"other", "entry", "exit"};
    const struct profile_table *table = &profile->table[exception];
    for (unsigned i = 0; i < PROFILE_PLACES; i++) {
        put_row(profile, exception, places[i], 0, &table->place[i]);
    }
    for (unsigned region = 0; region < COST_REGIONS; region++) {
        for (uint32_t i = 0; table->code[region] != NULL && i < COST_REGION_HALFWORDS; i++) {
            put_row(profile, exception, NULL, region_base[region] + 2U * i, &table->code[region][i]);
        }
    }
}

bool profile_close(struct profile *profile)
{
    if (!profile->on) {
        return true;
    }
    begin(profile, profile->row);
    struct outfile *file = &profile->file;
    static const char head[] = "exception,address,count,cycles,bus_cycles,register\n";
    outfile_commit(file, line_put_string(outfile_reserve(file, LINE_BYTES_MAX), head));
    for (unsigned i = 0; i < NVIC_EXCEPTIONS; i++) {
        put_table(profile, i);
    }
    return outfile_close(file) && outfile_publish(file);
}

void profile_discard(struct profile *profile)
{
    outfile_discard(&profile->file);
    for (unsigned i = 0; i < NVIC_EXCEPTIONS; i++) {
        for (unsigned region = 0; region < COST_REGIONS; region++) {
            free(profile->table[i].code[region]);
        }
    }
}

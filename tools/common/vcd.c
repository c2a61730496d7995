#include "vcd.h"

#include "line.h"

enum {
    LINE_BYTES_MAX = 128,
    MILLI_DECIMALS = 3,
};

static char *reserve(struct vcd *vcd)
{
    return outfile_reserve(vcd->file, LINE_BYTES_MAX);
}

static void put_text(struct vcd *vcd, const char *text)
{
    outfile_commit(vcd->file, line_put_string(reserve(vcd), text));
}

static char *put_code(char *at, unsigned signal)
{
    *at++ = (char)('!' + (char)signal);
    return at;
}

/* Ends the line of a value. */
static void end_value(struct vcd *vcd, char *at, unsigned signal)
{
    at = put_code(at, signal);
    *at++ = '\n';
    outfile_commit(vcd->file, at);
}

void vcd_begin(struct vcd *vcd, struct outfile *file, const char *program)
{
    *vcd = (struct vcd){.file = file};
    put_text(vcd, "$version ");
    put_text(vcd, program);
    put_text(vcd, " $end\n$timescale 1 ns $end\n$scope module ");
    char *at = reserve(vcd);
    while (*program != '\0' && *program != '-') {
        *at++ = *program++;
    }
    outfile_commit(vcd->file, line_put_string(at, " $end\n"));
}

void vcd_declare(struct vcd *vcd, enum vcd_type type, unsigned signal, struct vcd_name name)
{
    char *at = line_put_string(reserve(vcd), type == VCD_WIRE ? "$var wire 1 " : "$var real 64 ");
    at = put_code(at, signal);
    *at++ = ' ';
    at = line_put_string(at, name.before);
    at = name.number == 0 ? at : line_put_unsigned(at, name.number);
    at = line_put_string(at, name.after);
    outfile_commit(vcd->file, line_put_string(at, " $end\n"));
}

void vcd_begin_values(struct vcd *vcd)
{
    put_text(vcd, "$upscope $end\n$enddefinitions $end\n#0\n$dumpvars\n");
}

void vcd_end_values(struct vcd *vcd)
{
    put_text(vcd, "$end\n");
}

void vcd_put_time(struct vcd *vcd, uint64_t ns)
{
    if (ns <= vcd->written_ns) {
        return;
    }
    char *at = reserve(vcd);
    vcd->written_ns = ns;
    *at++ = '#';
    at = line_put_unsigned(at, ns);
    *at++ = '\n';
    outfile_commit(vcd->file, at);
}

void vcd_put_wire(struct vcd *vcd, unsigned signal, bool level)
{
    char *at = reserve(vcd);
    *at++ = level ? '1' : '0';
    end_value(vcd, at, signal);
}

void vcd_put_whole(struct vcd *vcd, unsigned signal, int64_t value)
{
    char *at = reserve(vcd);
    *at++ = 'r';
    at = line_put_signed(at, value);
    *at++ = ' ';
    end_value(vcd, at, signal);
}

void vcd_put_milli(struct vcd *vcd, unsigned signal, uint64_t milli)
{
    char *at = reserve(vcd);
    *at++ = 'r';
    at = line_put_fixed(at, milli, MILLI_DECIMALS);
    *at++ = ' ';
    end_value(vcd, at, signal);
}

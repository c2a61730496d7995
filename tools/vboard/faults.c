#include "faults.h"

#include <string.h>

#include "complain.h"
#include "line.h"

enum {
    MS_DECIMALS = 9,
    NAME_BYTES_MAX = 64,
    NO_ADDRESS = 1
};

#define MS_MAX UINT64_C(1000000000)
#define LOSE_MS_MAX UINT64_C(1000000)
#define SLOW_CYCLES_MAX UINT64_C(1000000000)

/* A hexadecimal number, or a symbol, or a symbol + a hexadecimal number. */
static bool read_address(struct faults *faults, const char *at, const char *end, uint32_t *address)
{
    char name[NAME_BYTES_MAX];
    uint32_t bytes = 0;
    uint32_t more = 0;
    const char *plus = memchr(at, '+', (size_t)(end - at));
    const char *name_end = plus == NULL ? end : plus;
    size_t length = (size_t)(name_end - at);
    if (plus == NULL && line_read_hex(at, end, address)) {
        return true;
    }
    if (length >= sizeof name || (plus != NULL && !line_read_hex(plus + 1, end, &more))) {
        return false;
    }
    memcpy(name, at, length);
    name[length] = '\0';
    bool known = image_find_symbol(faults->wires.image, name, address, &bytes);
    *address += more;
    return known;
}

static void insert(struct faults *faults, struct fault fault)
{
    unsigned place = faults->count++;
    for (; place > 0 && faults->fault[place - 1U].ps > fault.ps; place--) {
        faults->fault[place] = faults->fault[place - 1U];
    }
    faults->fault[place] = fault;
}

/* lose=EXCEPTION or lose=EXCEPTION,MS */
static bool read_loss(struct faults *faults, const char *at, const char *end, struct fault fault)
{
    uint64_t number = 0;
    uint64_t ps = 0;
    if (!line_read_fixed(&at, end, 0, NVIC_EXCEPTIONS - 1, &number) || number < NVIC_SVC) {
        return false;
    }
    fault.address = (uint32_t)number;
    insert(faults, fault);
    if (at == end) {
        return true;
    }
    at++;
    if (at[-1] != ',' || !line_read_fixed(&at, end, MS_DECIMALS, LOSE_MS_MAX * VTIME_PS_PER_MS, &ps) || at != end) {
        return false;
    }
    fault.kind = FAULT_FIND;
    fault.ps += ps;
    insert(faults, fault);
    return true;
}

/* slow=STREAM,CYCLES */
static bool read_slowness(struct faults *faults, const char *at, const char *end, struct fault fault)
{
    uint64_t number = 0;
    uint64_t cycles = 0;
    if (!line_read_fixed(&at, end, 0, DMA_CONTROLLERS * DMA_STREAMS - 1, &number) || at == end || *at != ',') {
        return false;
    }
    at++;
    if (!line_read_fixed(&at, end, 0, SLOW_CYCLES_MAX, &cycles) || at != end) {
        return false;
    }
    fault.address = (uint32_t)number;
    fault.value = (uint32_t)cycles;
    insert(faults, fault);
    return true;
}

/* dma=STREAM */
static bool read_stream(struct faults *faults, const char *at, const char *end, struct fault fault)
{
    uint64_t number = 0;
    if (!line_read_fixed(&at, end, 0, DMA_CONTROLLERS * DMA_STREAMS - 1, &number) || at != end) {
        return false;
    }
    fault.address = (uint32_t)number;
    insert(faults, fault);
    return true;
}

/* word=ADDRESS:VALUE */
static bool read_word(struct faults *faults, const char *at, const char *end, struct fault fault)
{
    const char *colon = memchr(at, ':', (size_t)(end - at));
    if (colon == NULL || !read_address(faults, at, colon, &fault.address) || fault.address % 4U != 0 ||
        !line_read_hex(colon + 1, end, &fault.value)) {
        return false;
    }
    insert(faults, fault);
    return true;
}

static bool read_place(struct faults *faults, const char *at, const char *end, struct fault fault)
{
    bool placeless = fault.kind == FAULT_POWER || fault.kind == FAULT_RESET;
    bool good = placeless ? at == end : read_address(faults, at, end, &fault.address);
    fault.address &= ~UINT32_C(1);
    insert(faults, fault);
    return good;
}

static bool read_fault(struct faults *faults, const char *at)
{
    static const struct {
        const char *name;
        enum fault_kind kind;
        bool (*read)(struct faults *faults, const char *at, const char *end, struct fault fault);
    } kinds[] = {
        {"jump=", FAULT_JUMP, read_place},  {"sp=", FAULT_STACK, read_place},   {"word=", FAULT_WORD, read_word},
        {"hold=", FAULT_HOLD, read_place},  {"lose=", FAULT_LOSE, read_loss},   {"dma=", FAULT_DMA, read_stream},
        {"power", FAULT_POWER, read_place}, {"reset", FAULT_RESET, read_place}, {"slow=", FAULT_SLOW, read_slowness},
    };
    const char *end = at + strlen(at);
    uint64_t ps = 0;
    if (!line_read_fixed(&at, end, MS_DECIMALS, MS_MAX * VTIME_PS_PER_MS, &ps) || *at != ':') {
        return false;
    }
    at++;
    for (unsigned i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        size_t length = strlen(kinds[i].name);
        if (strncmp(at, kinds[i].name, length) == 0) {
            return kinds[i].read(faults, at + length, end, (struct fault){.ps = ps, .kind = kinds[i].kind});
        }
    }
    return false;
}

static void plan(struct faults *faults)
{
    if (faults->next < faults->count) {
        clock_set_ps(faults->wires.clock, EVENT_FAULT, faults->fault[faults->next].ps);
    }
}

bool faults_open(struct faults *faults, const char *const texts[], unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        if (!read_fault(faults, texts[i])) {
            complain("--fault %s: not a time and a fault, or no such place; see --help", texts[i]);
            return false;
        }
    }
    plan(faults);
    return true;
}

static void on_faults_event(void *model, uint64_t cycle)
{
    struct faults *faults = model;
    (void)cycle;
    faults->due++;
    faults->next++;
    plan(faults);
    clock_poke(faults->wires.clock);
}

static void hold(struct faults *faults, uint32_t address)
{
    faults->wires.cpu->cost.hold_address = address;
    cost_forget(&faults->wires.cpu->cost);
}

static void apply(struct faults *faults, const struct fault *fault)
{
    uint8_t *word = NULL;
    switch (fault->kind) {
    case FAULT_JUMP:
        faults->wires.cpu->next = fault->address;
        break;
    case FAULT_STACK:
        cpu_write(faults->wires.cpu, UC_ARM_REG_SP, fault->address);
        break;
    case FAULT_WORD:
        word = memory_find(faults->wires.memory, fault->address, 4);
        for (unsigned i = 0; word != NULL && i < 4U; i++) {
            word[i] = (uint8_t)(fault->value >> 8U * i);
        }
        break;
    case FAULT_HOLD:
        hold(faults, fault->address);
        break;
    case FAULT_LOSE:
    case FAULT_FIND:
        nvic_lose(faults->wires.nvic, fault->address, fault->kind == FAULT_LOSE);
        break;
    case FAULT_DMA:
        dma_lead_astray(&faults->wires.dma[fault->address / DMA_STREAMS], fault->address % DMA_STREAMS);
        break;
    case FAULT_SLOW:
        dma_slow_down(&faults->wires.dma[fault->address / DMA_STREAMS], fault->address % DMA_STREAMS, fault->value);
        break;
    case FAULT_RESET:
        reset_request(faults->wires.reset, RESET_PIN);
        break;
    case FAULT_POWER:
        flash_cut(faults->wires.flash);
        reset_request(faults->wires.reset, RESET_POWER);
        break;
    }
}

void faults_apply(struct faults *faults)
{
    while (faults->due > 0) {
        apply(faults, &faults->fault[faults->next - faults->due]);
        faults->due--;
    }
}

void faults_reset(struct faults *faults)
{
    if (faults->wires.cpu->cost.hold_address != NO_ADDRESS) {
        hold(faults, NO_ADDRESS);
    }
}

void faults_init(struct faults *faults, struct faults_wires wires)
{
    faults->wires = wires;
    clock_attach(wires.clock, EVENT_FAULT, on_faults_event, faults);
}

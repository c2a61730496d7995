#include "faults.h"

#include <string.h>

#include "board.h"
#include "complain.h"
#include "line.h"

enum {
    MS_DECIMALS = 9,
    NAME_BYTES_MAX = 64,
    NO_ADDRESS = 1
};

#define MS_MAX UINT64_C(1000000000)
#define LOSE_MS_MAX UINT64_C(1000000)

bool faults_read_hex(const char *at, const char *end, uint32_t *value)
{
    static const char digits[] = "0123456789abcdef";
    uint64_t number = 0;
    bool good = at != end && end - at <= 8;
    for (; good && at != end; at++) {
        const char *digit = *at == '\0' ? NULL : strchr(digits, *at | 0x20);
        good = digit != NULL;
        number = number << 4 | (good ? (unsigned)(digit - digits) : 0U);
    }
    *value = (uint32_t)number;
    return good;
}

/* A hexadecimal number, or a symbol, or a symbol + a hexadecimal number. */
static bool read_address(struct board *board, const char *at, const char *end, uint32_t *address)
{
    char name[NAME_BYTES_MAX];
    uint32_t bytes = 0;
    uint32_t more = 0;
    const char *plus = memchr(at, '+', (size_t)(end - at));
    const char *name_end = plus == NULL ? end : plus;
    size_t length = (size_t)(name_end - at);
    if (plus == NULL && faults_read_hex(at, end, address)) {
        return true;
    }
    if (length >= sizeof name || (plus != NULL && !faults_read_hex(plus + 1, end, &more))) {
        return false;
    }
    memcpy(name, at, length);
    name[length] = '\0';
    bool known = image_find_symbol(&board->image, name, address, &bytes);
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
static bool read_loss(struct board *board, const char *at, const char *end, struct fault fault)
{
    uint64_t number = 0;
    uint64_t ps = 0;
    if (!line_read_fixed(&at, end, 0, NVIC_EXCEPTIONS - 1, &number) || number < NVIC_SVC) {
        return false;
    }
    fault.address = (uint32_t)number;
    insert(&board->faults, fault);
    if (at == end) {
        return true;
    }
    at++;
    if (at[-1] != ',' || !line_read_fixed(&at, end, MS_DECIMALS, LOSE_MS_MAX * VTIME_PS_PER_MS, &ps) || at != end) {
        return false;
    }
    fault.kind = FAULT_FIND;
    fault.ps += ps;
    insert(&board->faults, fault);
    return true;
}

/* word=ADDRESS:VALUE */
static bool read_word(struct board *board, const char *at, const char *end, struct fault fault)
{
    const char *colon = memchr(at, ':', (size_t)(end - at));
    if (colon == NULL || !read_address(board, at, colon, &fault.address) || fault.address % 4U != 0 ||
        !faults_read_hex(colon + 1, end, &fault.value)) {
        return false;
    }
    insert(&board->faults, fault);
    return true;
}

static bool read_place(struct board *board, const char *at, const char *end, struct fault fault)
{
    bool placeless = fault.kind == FAULT_POWER || fault.kind == FAULT_RESET;
    bool good = placeless ? at == end : read_address(board, at, end, &fault.address);
    fault.address &= ~UINT32_C(1);
    insert(&board->faults, fault);
    return good;
}

static bool read_fault(struct board *board, const char *at)
{
    static const struct {
        const char *name;
        enum fault_kind kind;
        bool (*read)(struct board *board, const char *at, const char *end, struct fault fault);
    } kinds[] = {
        {"jump=", FAULT_JUMP, read_place},  {"sp=", FAULT_STACK, read_place}, {"word=", FAULT_WORD, read_word},
        {"hold=", FAULT_HOLD, read_place},  {"lose=", FAULT_LOSE, read_loss}, {"power", FAULT_POWER, read_place},
        {"reset", FAULT_RESET, read_place},
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
            return kinds[i].read(board, at + length, end, (struct fault){.ps = ps, .kind = kinds[i].kind});
        }
    }
    return false;
}

static void plan(struct board *board)
{
    const struct faults *faults = &board->faults;
    if (faults->next < faults->count) {
        events_set_ps(board, EVENT_FAULT, faults->fault[faults->next].ps);
    }
}

bool faults_open(struct board *board)
{
    for (unsigned i = 0; i < board->options->faults; i++) {
        if (!read_fault(board, board->options->fault[i])) {
            complain("--fault %s: not a time and a fault, or no such place; see --help", board->options->fault[i]);
            return false;
        }
    }
    plan(board);
    return true;
}

void faults_event(struct board *board, uint64_t cycle)
{
    (void)cycle;
    board->faults.due++;
    board->faults.next++;
    plan(board);
    cpu_poke(&board->cpu);
}

static void hold(struct board *board, uint32_t address)
{
    board->cpu.cost.hold_address = address;
    cost_forget(&board->cpu.cost);
}

static void apply(struct board *board, const struct fault *fault)
{
    uint8_t *word = NULL;
    switch (fault->kind) {
    case FAULT_JUMP:
        board->cpu.next = fault->address;
        break;
    case FAULT_STACK:
        cpu_write(&board->cpu, UC_ARM_REG_SP, fault->address);
        break;
    case FAULT_WORD:
        word = memory_find(&board->memory, fault->address, 4);
        for (unsigned i = 0; word != NULL && i < 4U; i++) {
            word[i] = (uint8_t)(fault->value >> 8U * i);
        }
        break;
    case FAULT_HOLD:
        hold(board, fault->address);
        break;
    case FAULT_LOSE:
    case FAULT_FIND:
        nvic_lose(board, fault->address, fault->kind == FAULT_LOSE);
        break;
    case FAULT_RESET:
        board_request_reset(board, RESET_PIN);
        break;
    case FAULT_POWER:
        flash_cut(board);
        board_request_reset(board, RESET_POWER);
        break;
    }
}

void faults_apply(struct board *board)
{
    struct faults *faults = &board->faults;
    while (faults->due > 0) {
        apply(board, &faults->fault[faults->next - faults->due]);
        faults->due--;
    }
}

void faults_reset(struct board *board)
{
    if (board->cpu.cost.hold_address != NO_ADDRESS) {
        hold(board, NO_ADDRESS);
    }
}

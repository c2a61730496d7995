#include "image.h"

#include <elf.h>
#include <string.h>

#include "complain.h"

enum {
    VECTORS_BYTES = 8 /* what the processor starts with */
};

/* A header at an offset of the file, copied out as it may lie unaligned. False: it is not all in the file. */
static bool copy_out(const struct image *image, uint64_t offset, void *header, size_t bytes)
{
    if (offset > image->file.length || bytes > image->file.length - offset) {
        return false;
    }
    memcpy(header, image->file.bytes + offset, bytes);
    return true;
}

static bool is_arm_elf(const Elf32_Ehdr *header)
{
    return memcmp(header->e_ident, ELFMAG, SELFMAG) == 0 && header->e_ident[EI_CLASS] == ELFCLASS32 &&
           header->e_ident[EI_DATA] == ELFDATA2LSB && header->e_machine == EM_ARM && header->e_type == ET_EXEC;
}

static void note_ram_end(struct image *image, uint32_t end)
{
    if (end - MEMORY_SRAM_BASE <= MEMORY_SRAM_BYTES && end > image->ram_end[0]) {
        image->ram_end[0] = end;
    } else if (end - MEMORY_CCM_BASE <= MEMORY_CCM_BYTES && end > image->ram_end[1]) {
        image->ram_end[1] = end;
    }
}

static bool load_segment(const struct image *image, struct memory *memory, const Elf32_Phdr *segment)
{
    if (segment->p_type != PT_LOAD) {
        return true;
    }
    if (segment->p_filesz > 0) {
        uint8_t *to = memory_find(memory, segment->p_paddr, segment->p_filesz);
        if (to == NULL || !copy_out(image, segment->p_offset, to, segment->p_filesz)) {
            complain("%s: the segment for %08x fits into no memory of the part; link it for an STM32F405",
                     image->file.path, (unsigned)segment->p_paddr);
            return false;
        }
    }
    return true;
}

/* The data of the program ends where its sections do: segments may be padded to take in the stack. */
static void note_sections(struct image *image, const Elf32_Ehdr *header)
{
    for (unsigned i = 0; i < header->e_shnum; i++) {
        Elf32_Shdr section;
        if (copy_out(image, header->e_shoff + (uint64_t)i * header->e_shentsize, &section, sizeof section) &&
            (section.sh_flags & SHF_ALLOC) != 0 && section.sh_size > 0) {
            note_ram_end(image, section.sh_addr + section.sh_size);
        }
    }
}

/* Where the flash holds something of the program first; 0: nowhere. */
static uint32_t find_begin(const struct image *image, const struct memory *memory, const Elf32_Ehdr *header)
{
    uint32_t begin = 0;
    for (unsigned i = 0; i < header->e_phnum; i++) {
        Elf32_Phdr segment;
        bool there = copy_out(image, header->e_phoff + (uint64_t)i * header->e_phentsize, &segment, sizeof segment) &&
                     segment.p_type == PT_LOAD && segment.p_filesz > 0 && memory_is_flash(memory, segment.p_paddr);
        if (there && (begin == 0 || segment.p_paddr < begin)) {
            begin = segment.p_paddr;
        }
    }
    return begin;
}

/* A program that does not begin where the flash does is started by a loader there, which does nothing else: stack and
 * first instruction are those of the program. */
static void put_loader(const struct image *image, struct memory *memory, const Elf32_Ehdr *header)
{
    uint32_t begin = find_begin(image, memory, header);
    if (begin > MEMORY_FLASH_BASE) {
        memcpy(memory_find(memory, MEMORY_FLASH_BASE, VECTORS_BYTES), memory_find(memory, begin, VECTORS_BYTES),
               VECTORS_BYTES);
    }
}

bool image_load(struct image *image, struct memory *memory, const char *path)
{
    Elf32_Ehdr header;
    if (!infile_read(&image->file, path)) {
        return false;
    }
    if (!copy_out(image, 0, &header, sizeof header) || !is_arm_elf(&header)) {
        complain("%s: not an ELF program for ARM; give the .elf of the firmware", path);
        return false;
    }
    for (unsigned i = 0; i < header.e_phnum; i++) {
        Elf32_Phdr segment;
        if (!copy_out(image, header.e_phoff + (uint64_t)i * header.e_phentsize, &segment, sizeof segment) ||
            !load_segment(image, memory, &segment)) {
            return false;
        }
    }
    put_loader(image, memory, &header);
    note_sections(image, &header);
    return true;
}

void image_discard(struct image *image)
{
    infile_discard(&image->file);
}

/* The symbol table and its strings. */
static bool find_table(const struct image *image, Elf32_Shdr *symbols, Elf32_Shdr *strings)
{
    Elf32_Ehdr header;
    if (!copy_out(image, 0, &header, sizeof header)) {
        return false;
    }
    for (unsigned i = 0; i < header.e_shnum; i++) {
        if (copy_out(image, header.e_shoff + (uint64_t)i * header.e_shentsize, symbols, sizeof *symbols) &&
            symbols->sh_type == SHT_SYMTAB) {
            return copy_out(image, header.e_shoff + (uint64_t)symbols->sh_link * header.e_shentsize, strings,
                            sizeof *strings);
        }
    }
    return false;
}

static const char *symbol_name(const struct image *image, const Elf32_Shdr *strings, const Elf32_Sym *symbol)
{
    uint64_t offset = (uint64_t)strings->sh_offset + symbol->st_name;
    return offset < image->file.length ? (const char *)image->file.bytes + offset : "";
}

bool image_find_symbol(const struct image *image, const char *name, uint32_t *value, uint32_t *bytes)
{
    Elf32_Shdr symbols;
    Elf32_Shdr strings;
    if (!find_table(image, &symbols, &strings)) {
        return false;
    }
    for (uint32_t at = 0; at + sizeof(Elf32_Sym) <= symbols.sh_size; at += (uint32_t)sizeof(Elf32_Sym)) {
        Elf32_Sym symbol;
        if (copy_out(image, (uint64_t)symbols.sh_offset + at, &symbol, sizeof symbol) && symbol.st_shndx != SHN_UNDEF &&
            strcmp(symbol_name(image, &strings, &symbol), name) == 0) {
            *value = symbol.st_value;
            *bytes = symbol.st_size;
            return true;
        }
    }
    return false;
}

static int hex_digit(char digit)
{
    static const char digits[] = "0123456789abcdef";
    const char *found = digit == '\0' ? NULL : strchr(digits, digit);
    return found == NULL ? -1 : (int)(found - digits);
}

/* False if the text is not exactly so many bytes. */
static bool put_hex(uint8_t *to, size_t bytes, const char *text)
{
    if (strlen(text) != bytes * 2U) {
        return false;
    }
    for (size_t i = 0; i < bytes; i++) {
        int high = hex_digit(text[2U * i]);
        int low = hex_digit(text[2U * i + 1U]);
        if (high < 0 || low < 0) {
            return false;
        }
        to[i] = (uint8_t)(high << 4 | low);
    }
    return true;
}

bool image_set(const struct image *image, struct memory *memory, const char *text)
{
    enum {
        NAME_BYTES_MAX = 64
    };
    char name[NAME_BYTES_MAX] = "";
    const char *equals = strchr(text, '=');
    size_t length = equals == NULL ? 0 : (size_t)(equals - text);
    uint32_t address = 0;
    uint32_t bytes = 0;
    if (length == 0 || length >= NAME_BYTES_MAX) {
        complain("--set %s: write SYMBOL=HEXBYTES", text);
        return false;
    }
    memcpy(name, text, length);
    bool known = image_find_symbol(image, name, &address, &bytes);
    uint8_t *to = known && memory_is_flash(memory, address) ? memory_find(memory, address, bytes) : NULL;
    if (to == NULL) {
        complain("--set %s: the program has no such constant", name);
        return false;
    }
    if (!put_hex(to, bytes, equals + 1)) {
        complain("--set %s: not %u bytes in lower-case hexadecimal digits", name, (unsigned)bytes);
        return false;
    }
    return true;
}

const char *image_function_at(const struct image *image, uint32_t address)
{
    Elf32_Shdr symbols;
    Elf32_Shdr strings;
    const char *found = "?";
    uint32_t nearest = 0;
    if (!find_table(image, &symbols, &strings)) {
        return found;
    }
    for (uint32_t at = 0; at + sizeof(Elf32_Sym) <= symbols.sh_size; at += (uint32_t)sizeof(Elf32_Sym)) {
        Elf32_Sym symbol;
        if (!copy_out(image, (uint64_t)symbols.sh_offset + at, &symbol, sizeof symbol) ||
            ELF32_ST_TYPE(symbol.st_info) != STT_FUNC) {
            continue;
        }
        uint32_t start = symbol.st_value & ~UINT32_C(1);
        bool inside = address >= start && (symbol.st_size == 0 || address - start < symbol.st_size);
        if (inside && start >= nearest) {
            nearest = start;
            found = symbol_name(image, &strings, &symbol);
        }
    }
    return found;
}

#include "infile.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "complain.h"

enum {
    CHUNK_BYTES = 1 << 16,
    FILE_BYTES_MAX = 1 << 26,
};

/* Makes room for one more chunk and the final 0. */
static bool infile_grow(struct infile *file)
{
    uint8_t *bytes = realloc(file->bytes, (size_t)file->length + CHUNK_BYTES + 1U);
    if (bytes == NULL) {
        return false;
    }
    file->bytes = bytes;
    return true;
}

/* Reads to the end; 0 or an errno. */
static int infile_read_stream(struct infile *file, FILE *stream)
{
    size_t got = 0;
    do {
        if (file->length > FILE_BYTES_MAX) {
            return EFBIG;
        }
        if (!infile_grow(file)) {
            return ENOMEM;
        }
        got = fread(file->bytes + file->length, 1, CHUNK_BYTES, stream);
        file->length += (uint32_t)got;
        file->bytes[file->length] = 0;
    } while (got > 0);
    return ferror(stream) != 0 ? errno : 0;
}

bool infile_read(struct infile *file, const char *path)
{
    bool standard = strcmp(path, "-") == 0;
    *file = (struct infile){.path = path};
    FILE *stream = standard ? stdin : fopen(path, "rb");
    int error = stream != NULL ? infile_read_stream(file, stream) : errno;
    if (stream != NULL && !standard) {
        (void)fclose(stream);
    }
    if (error != 0) {
        complain("%s: cannot be read (%s); name a file that exists and may be read", path, strerror(error));
        infile_discard(file);
    }
    return error == 0;
}

/* What may stand after the last line: blanks, and the end that DOS editors write. */
static bool is_end(uint8_t byte)
{
    return byte == 0x1AU || byte == ' ' || byte == '\t' || byte == '\r' || byte == '\n';
}

bool infile_read_text(struct infile *file, const char *path)
{
    static const uint8_t mark[] = {0xEF, 0xBB, 0xBF};
    if (!infile_read(file, path)) {
        return false;
    }
    if (file->length >= sizeof mark && memcmp(file->bytes, mark, sizeof mark) == 0) {
        file->length -= (uint32_t)sizeof mark;
        memmove(file->bytes, file->bytes + sizeof mark, file->length + 1U);
    }
    while (file->length > 0 && is_end(file->bytes[file->length - 1U])) {
        file->length--;
        file->bytes[file->length] = 0;
    }
    return true;
}

uint32_t infile_line(const struct infile *file, uint32_t offset)
{
    uint32_t line = 1;
    for (uint32_t i = 0; i < offset && i < file->length; i++) {
        line += file->bytes[i] == '\n' ? 1U : 0U;
    }
    return line;
}

uint32_t infile_column(const struct infile *file, uint32_t offset)
{
    uint32_t column = 1;
    while (column <= offset && file->bytes[offset - column] != '\n') {
        column++;
    }
    return column;
}

void infile_discard(struct infile *file)
{
    free(file->bytes);
    *file = (struct infile){.path = NULL};
}

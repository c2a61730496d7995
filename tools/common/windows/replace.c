/* `rename` of Windows replaces nothing. */
#include "replace.h"

#include <errno.h>
#include <windows.h>

int replace_file(const char *from, const char *to)
{
    if (MoveFileExA(from, to, MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) != 0) {
        return 0;
    }
    errno = EACCES;
    return -1;
}

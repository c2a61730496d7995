#include "replace.h"

#include <stdio.h>

int replace_file(const char *from, const char *to)
{
    return rename(from, to);
}

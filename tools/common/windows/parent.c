/* Windows does not end a program with its parent, and changes the ends of lines unless it is told not to. */
#include "parent.h"

#include <fcntl.h>
#include <io.h>
#include <stdio.h>

void parent_bind(void)
{
    (void)_setmode(_fileno(stdin), _O_BINARY);
    (void)_setmode(_fileno(stdout), _O_BINARY);
    (void)_setmode(_fileno(stderr), _O_BINARY);
}

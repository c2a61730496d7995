/* Where the system does not end a program with its parent: macOS, WebAssembly. */
#include "parent.h"

void parent_bind(void)
{
}

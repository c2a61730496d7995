#ifndef REPLACE_H
#define REPLACE_H

/* Gives a file another name, in place of the file that has it, in one step: 0, or -1 with errno. */
int replace_file(const char *from, const char *to);

#endif

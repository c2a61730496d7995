/*
 * How the program ends and how it says what is wrong: always one line on standard error, "PROGRAM: ...", with what is
 * wrong and what to do about it.
 */
#ifndef COMPLAIN_H
#define COMPLAIN_H

enum exit_status {
    EXIT_DONE = 0,
    EXIT_REFUSED = 1,    /* a file cannot be read or written or its content is wrong, or the unit has refused it */
    EXIT_USAGE = 2,      /* the command line is wrong */
    EXIT_CONNECTION = 3, /* a port cannot be had */
};

/* Takes the name of the program from its path, which must outlive the program's work. */
void complain_as(const char *path);

/* Prints the line; the format is printf's, without the line's end. */
__attribute__((format(printf, 1, 2))) void complain(const char *format, ...);

/* Flushes standard output. EXIT_DONE, or EXIT_REFUSED after a complaint if not all of it could be written. */
enum exit_status finish_output(void);

#endif

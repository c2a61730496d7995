/*
 * `rkm04-host check`: a program through the firmware's parser, as one JSON object on standard output.
 *
 * {"commands":[{"offset":0,"line":1,"column":1,"ordinal":1,"opcode":"MOVE","io":0,"value":0,"text":"R"}],
 *  "stored":1,
 *  "problems":[{"offset":1,"line":1,"column":2,"end_column":4,"severity":"error","rule":"value","flag":1,
 *               "message":"F (steps forward) takes a number from 1 to 16000000, found 0"}],
 *  "more":0}
 * The file is UTF-8; an offset is the number of a character from 0, of the command letter or of the unknown character.
 * Texts of commands are canonical. The ordinal is that in program memory, 0 for what is not stored; `stored` counts
 * those that are. Problems are the errors, of which the first thousand are listed and `more` tells how many there are
 * besides, or in a program without errors the warnings, with flag 0. They are an answer, not a failure.
 */
#ifndef CHECK_H
#define CHECK_H

#include "complain.h"

enum exit_status check_file(const char *path);

#endif

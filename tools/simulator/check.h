/*
 * `rkm04-host check`: a program through the firmware's parser, as one JSON object on standard output.
 *
 * {"commands":[{"offset":0,"opcode":"MOVE","io":0,"value":0,"text":"R"}],
 *  "errors":[{"offset":1,"flag":1,"character":70}],"more":0}
 * Of the errors the first thousand are listed; more tells how many there are besides.
 * Offsets are of the command letter, or of the unknown character; the text is canonical. Errors in the text are an
 * answer, not a failure.
 */
#ifndef CHECK_H
#define CHECK_H

#include "complain.h"

enum exit_status check_file(const char *path);

#endif

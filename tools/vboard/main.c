/*
 * rkm04-vboard: runs the program of an STM32F405/407 on a virtual board (README.md).
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "board.h"
#include "complain.h"
#include "parent.h"
#include "run.h"
#include "summary.h"

static enum exit_status run_board(const struct options *options)
{
    struct board *board = malloc(sizeof *board);
    enum exit_status status = EXIT_REFUSED;
    if (board == NULL) {
        complain("there is not memory enough");
        return status;
    }
    if (board_init(board, options) && run(board)) {
        summary_print(board);
        bool good = board_close(board) && board->report.end != REPORT_FAILED;
        status = good ? finish_output() : EXIT_REFUSED;
    }
    board_discard(board);
    free(board);
    return status;
}

int main(int argc, char *argv[])
{
    struct options options;
    parent_bind();
    complain_as("rkm04-vboard");
    if (argc == 2 && (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0)) {
        (void)fputs(options_usage, stdout);
        (void)fputs(options_usage_more, stdout);
        return (int)finish_output();
    }
    enum exit_status status = options_read(&options, argc - 1, argv + 1);
    return (int)(status == EXIT_DONE ? run_board(&options) : status);
}

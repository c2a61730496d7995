/*
 * Signals that end `serve`, as something to poll.
 */
#ifndef SERVE_SIGNAL_H
#define SERVE_SIGNAL_H

/* From now on SIGINT, SIGTERM and SIGHUP, or on Windows Ctrl-C and the end of the session, make the returned descriptor
 * readable; writing to who has gone and reading in the background of a terminal are errors of those calls. After
 * socket_start. -1 after a complaint. */
int serve_signal_catch(void);

#endif

#include "serve_signal.h"

#include <winsock2.h>

#include "complain.h"
#include "serve_pair.h"

enum {
    LONGER_THAN_WINDOWS_WAITS_MS = 60000
};

/* The one thing that the handler can know. */
static volatile LONG wake;

/* Where the console closes or the session ends, the process ends when this returns. */
static BOOL WINAPI on_event(DWORD event)
{
    (void)send((SOCKET)wake, "", 1, 0);
    if (event != CTRL_C_EVENT && event != CTRL_BREAK_EVENT) {
        Sleep(LONGER_THAN_WINDOWS_WAITS_MS);
    }
    return TRUE;
}

int serve_signal_catch(void)
{
    struct serve_pair pair;
    if (!serve_pair_make(&pair)) {
        complain("no sockets can be made; close other programs");
        return -1;
    }
    wake = pair.writes;
    (void)SetConsoleCtrlHandler(on_event, TRUE);
    return pair.reads;
}

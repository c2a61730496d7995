"""Programs that are started by the tools: none of them goes on when the tool that started it ends.

That is kept by Linux, not by Python: an interruption can come when the child is there and Python
does not know of it yet, and SIGKILL is told to nobody.
"""

from __future__ import annotations

import ctypes
import os
import signal
import sys
from collections.abc import Callable

PARENT_VARIABLE = "RKM04_PARENT"
PR_SET_PDEATHSIG = 1


def bound() -> dict[str, str]:
    """The environment in which our C programs die with this one.

    More exactly with the thread that starts them, so that must not end before them.
    """
    return {**os.environ, PARENT_VARIABLE: str(os.getpid())}


def binder() -> Callable[[], None] | None:
    """The same for other programs, as `preexec_fn`; only where no other thread runs."""
    if sys.platform != "linux":
        return None
    parent, prctl = os.getpid(), ctypes.CDLL(None).prctl

    def bind() -> None:
        prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != parent:
            os._exit(1)

    return bind

"""Who has a line: a command notes it while it runs, so that another one can name it.

A line over TCP, unlike a serial device, can be opened twice, and two programs that talk to one unit
disturb each other. The note is a file that the system unlocks when the process ends, however it
does. Where there are no such locks, as on Windows, nothing is known.
"""

from __future__ import annotations

import hashlib
import ipaddress
import os
import socket
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rkm04_tools.line_errors import PortBusy
from rkm04_tools.transport import ADDRESS

SHOWN_MAX = 60
UNKNOWN = "another program"
HERE = "127.0.0.1"

if sys.platform != "win32":
    import fcntl


@contextmanager
def held(port: str, tool: str, advice: str) -> Iterator[None]:
    """Have a line to oneself; PortBusy names who has it. `tool`: the name of the command."""
    number = _open(port)
    try:
        if number is not None and not _lock(number, tool):
            raise PortBusy(f"{port}: {_who(number)} has this line; {advice}")
        yield
    finally:
        if number is not None:
            os.close(number)


def holder_of(port: str) -> str:
    """Who has noted that it has a line."""
    number = _open(port)
    if number is None:
        return UNKNOWN
    try:
        return _who(number) if _is_locked(number) else UNKNOWN
    finally:
        os.close(number)


def place_of(port: str) -> str:
    """Where a line is, the same however its port is spelt."""
    scheme, is_url, rest = port.partition("://")
    if not is_url:
        return os.path.realpath(port)
    match = ADDRESS.fullmatch(rest)
    return f"{scheme.lower()}://{_address_of(match[1])}:{int(match[2])}" if match else port


def _address_of(name: str) -> str:
    """The address of a host. All that mean this machine without naming an interface are one."""
    try:
        told = socket.getaddrinfo(name.strip("[]"), None, type=socket.SOCK_STREAM)
    except (OSError, UnicodeError):
        return name.lower()
    found = [ipaddress.ip_address(str(each[4][0]).partition("%")[0]) for each in told]
    plain = [getattr(each, "ipv4_mapped", None) or each for each in found]
    first = min(plain, key=lambda each: (each.version, int(each)))
    is_here = first.is_unspecified or (first.version == 6 and first.is_loopback)
    return HERE if is_here else str(first)


def _is_locked(number: int) -> bool:
    """Whether another one has it; if not it is locked from then on."""
    if sys.platform == "win32":
        return False
    try:
        fcntl.flock(number, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return True
    return False


def _open(port: str) -> int | None:
    """The file of the note; None: there can be none."""
    if sys.platform == "win32":
        return None
    folder = Path(tempfile.gettempdir()) / f"rkm04-lines-{os.getuid()}"
    name = hashlib.sha256(place_of(port).encode(errors="surrogateescape")).hexdigest()[:32]
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        if folder.is_symlink() or folder.stat().st_uid != os.getuid():
            return None
        return os.open(folder / name, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o600)
    except OSError:
        return None


def _lock(number: int, tool: str) -> bool:
    """Lock and write the note; False: another one has it."""
    if _is_locked(number):
        return False
    words = " ".join([tool, *map(_brief, sys.argv[1:])])
    os.ftruncate(number, 0)
    os.pwrite(number, f"{_short(words)} (process {os.getpid()})".encode(errors="replace"), 0)
    return True


def _who(number: int) -> str:
    text = os.pread(number, 4 * SHOWN_MAX, 0).decode(errors="replace")
    return text if text.isprintable() and text else UNKNOWN


def _brief(argument: str) -> str:
    """Of a path its last part."""
    return argument if "://" in argument else Path(argument).name or argument


def _short(words: str) -> str:
    plain = "".join(c if c.isprintable() else "?" for c in words)
    return plain if len(plain) <= SHOWN_MAX else f"{plain[:SHOWN_MAX]}..."

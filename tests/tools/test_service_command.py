"""The command `service`: how it starts and how it ends."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest
from service_client import ROOT, Service, build_with_page


@pytest.fixture
def build(tmp_path, monkeypatch):
    build = build_with_page(tmp_path)
    monkeypatch.setenv("RKM04_BUILD", str(build))
    return build


def descendants(pid: int) -> list[int]:
    found = []
    for task in Path(f"/proc/{pid}/task").iterdir():
        for child in map(int, (task / "children").read_text().split()):
            found += [child, *descendants(child)]
    return found


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_it_with_its_virtual_unit(build, number):
    service = Service(build)
    browser = service.browser()
    browser.connected()
    browser.request("send", text="\\ S100 F16000000 R")
    units = descendants(service.process.pid)

    ended = service.wait(number)

    assert ended == (0, "")
    assert units
    end = time.monotonic() + 5
    while any(Path(f"/proc/{pid}").exists() for pid in units):
        assert time.monotonic() < end
        time.sleep(0.02)
    browser.close()


def test_it_ends_at_once_while_a_long_program_is_sent(build):
    service = Service(build)
    browser = service.browser()
    browser.connected()
    browser.begin("request", message="send", motor=1, text="\\ " + "W16000000 " * 690)
    browser.next("progress")

    started = time.monotonic()
    assert service.wait() == (0, "")
    assert time.monotonic() - started < 10
    browser.close()


def test_it_leaves_no_files_after(build, tmp_path, monkeypatch):
    place = tmp_path / "temporary"
    place.mkdir()
    monkeypatch.setenv("TMPDIR", str(place))
    service = Service(build)
    service.browser().connected()
    service.call("/api/curve", {"programs": {"1": "F1 R"}})
    assert list(place.iterdir())

    service.end()

    assert list(place.iterdir()) == []


def test_it_listens_on_this_machine_only(build):
    service = Service(build)
    lines = Path("/proc/net/tcp").read_text().splitlines()
    others = Path("/proc/net/tcp6").read_text().splitlines()
    listening = [line.split()[1] for line in lines + others if line.split()[3] == "0A"]

    assert f"0100007F:{service.port:04X}" in listening
    assert [place for place in listening if place.endswith(f":{service.port:04X}")] == [
        f"0100007F:{service.port:04X}"
    ]
    service.end()


def test_every_start_has_a_token_of_its_own(build):
    one, other = Service(build), Service(build)

    assert one.token != other.token
    assert len(one.token) >= 32
    assert one.call("/", token=other.token).status == 403
    one.end()
    other.end()


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as found:
        return int(found.getsockname()[1])


def test_a_start_on_the_same_port_is_known_to_the_pages_of_the_last_one(build):
    port = str(free_port())
    one = Service(build, "--listen", port)
    one.end(signal.SIGKILL)

    other = Service(build, "--listen", port)

    kept = build.parent / f"service-{port}.token"
    assert one.token == other.token == kept.read_text()
    assert kept.stat().st_mode & 0o777 == 0o600
    other.end()


@pytest.mark.parametrize("spoil", ["others", "short", "link"])
def test_a_token_that_somebody_else_may_know_is_not_taken(build, tmp_path, spoil):
    port = str(free_port())
    kept = build.parent / f"service-{port}.token"
    known = tmp_path / "known"
    known.write_text("k" * 32)
    known.chmod(0o600)
    if spoil == "link":
        kept.symlink_to(known)
    else:
        kept.write_text("k" * (32 if spoil == "others" else 31))
        kept.chmod(0o640 if spoil == "others" else 0o600)

    service = Service(build, "--listen", port)

    assert service.token == kept.read_text() != "k" * 32
    assert not kept.is_symlink()
    assert known.read_text() == "k" * 32
    service.end()


def test_a_port_that_is_taken_is_an_error_in_one_line(build, tool):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        result = tool("service", "--no-browser", "--listen", str(port))

    assert result.status == 3
    assert f"port {port} of 127.0.0.1 cannot be used" in result.complaint
    assert "--listen" in result.complaint


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (["--listen", "70000"], "1 to 65535"),
        (["--listen", "x"], "--help"),
        (["--node", "0"], "name one, 1 to 16"),
        (["--node", "17"], "1 to 16"),
        (["--static", "x", "--listen", "0"], "leave out the other options"),
        (["--static", ""], "name a file"),
        (["--static", "x"], "start the command as tools/rkm04"),
    ],
)
def test_a_wrong_option_is_an_error_in_one_line(build, tool, arguments, part):
    result = tool("service", "--no-browser", *arguments)

    assert result.status == 2
    assert part in result.complaint


def test_without_its_page_it_says_how_to_start_it(build, tool):
    (build.parent / "service" / "index.html").unlink()

    result = tool("service", "--no-browser")

    assert result.status == 2
    assert "start the command as tools/rkm04" in result.complaint


def test_a_port_that_is_not_there_leaves_the_page_usable(build):
    service = Service(build, "--port", "/dev/there-is-none", "--node", "4")
    browser = service.browser()
    state = browser.until(lambda m: m["type"] == "state" and m["error"] and not m["busy"])

    assert (state["connected"], state["node"]) == (False, 4)
    assert state["error"]["kind"] == "PortMissing"
    assert browser.ask("connect", port="virtual", node=4)["error"] is None
    assert service.end() == (0, "")


def test_the_help_has_an_example(tool):
    result = tool("service", "--help")

    assert result.status == 0
    assert "rkm04 service --port COM5" in result.out


def test_other_commands_do_not_load_the_server(build):
    code = (
        "import sys; from rkm04_tools.cli import main; main(['check', sys.argv[1]]); "
        "print(sorted({'starlette', 'uvicorn', 'websockets'} & set(sys.modules)))"
    )
    done = subprocess.run(
        [sys.executable, "-P", "-c", code, str(ROOT / "tools/examples/4-loop.rks")],
        capture_output=True, text=True, check=True,
        env={**os.environ, "PYTHONPATH": str(ROOT / "tools")},
    )  # fmt: skip

    assert done.stdout.splitlines()[-1] == "[]"

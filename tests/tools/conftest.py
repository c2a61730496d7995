"""Runs the command-line tools inside the test, or as a process of their own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from fake_gve134 import FakeGve
from fake_unit import FakeLine, FakeUnit
from gve134_ports import FakeGveLine
from rkm04_tools.cli import main, run_tool
from rkm04_tools.gve134.cli import make_parser as make_gve134_parser
from rkm04_tools.positioning.cli import make_parser as make_positioning_parser
from served import POSITIONING_COMMAND, Served
from service_client import Service, build_with_page

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Result:
    """What a command printed, and its exit status."""

    status: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        return json.loads(self.out)

    @property
    def complaint(self) -> str:
        """The one line on standard error; a command that complains prints nothing else."""
        assert self.out == ""
        assert self.err.count("\n") == 1, self.err
        return self.err.rstrip("\n")


Tool = Callable[..., Result]


@pytest.fixture(autouse=True, scope="session")
def build_folder() -> Iterator[None]:
    """Tell the tools where the simulator is, if the caller has not."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("RKM04_BUILD", os.environ.get("RKM04_BUILD", str(ROOT / "build" / "host")))
        yield


@pytest.fixture
def tool(capsys: pytest.CaptureFixture[str]) -> Tool:
    """Run a command inside this process."""
    return _tool(main, capsys)


@pytest.fixture
def gve134(capsys: pytest.CaptureFixture[str]) -> Tool:
    """The same of the tool for the GVE134."""
    return _tool(partial(run_tool, make_gve134_parser()), capsys)


def _tool(main: Callable[[Sequence[str]], int], capsys: pytest.CaptureFixture[str]) -> Tool:
    def run(*arguments: str | Path) -> Result:
        capsys.readouterr()
        try:
            status = main([str(argument) for argument in arguments])
        except SystemExit as end:
            status = int(end.code or 0)
        printed = capsys.readouterr()
        return Result(status, printed.out, printed.err)

    return run


@pytest.fixture
def gve(capsys: pytest.CaptureFixture[str]) -> Tool:
    """Run a command of `gve134` inside this process."""

    def run(*arguments: str | Path) -> Result:
        capsys.readouterr()
        status = run_tool(make_gve134_parser(), [str(argument) for argument in arguments])
        printed = capsys.readouterr()
        return Result(status, printed.out, printed.err)

    return run


@pytest.fixture
def positioning(capsys: pytest.CaptureFixture[str]) -> Tool:
    """Run a command of `positioning` inside this process."""

    def run(*arguments: str | Path) -> Result:
        capsys.readouterr()
        status = run_tool(make_positioning_parser(), [str(argument) for argument in arguments])
        printed = capsys.readouterr()
        return Result(status, printed.out, printed.err)

    return run


@pytest.fixture
def pos_serve(tmp_path: Path) -> Iterator[Callable[..., Served]]:
    """Start units that end with the test, ten times as fast as real ones unless told otherwise."""
    started: list[Served] = []

    def start(
        *arguments: str | Path, speed: str = "10", place: str = "--tcp", at: str = "0"
    ) -> Served:
        more = ("--speed", speed, "--control", "0", *arguments)
        served = Served(place, at, *more, cwd=tmp_path, command=POSITIONING_COMMAND)
        started.append(served)
        return served

    yield start
    for served in started:
        served.end()


@pytest.fixture
def pos_call(
    positioning: Tool, pos_serve: Callable[..., Served], monkeypatch: pytest.MonkeyPatch
) -> Callable[..., str]:
    """Run a command that must not complain; returns what it printed."""
    monkeypatch.setenv("POSITIONING_PORT", pos_serve().place)

    def run(*arguments: str | Path) -> str:
        result = positioning(*arguments)
        assert (result.status, result.err) == (0, ""), (arguments, result)
        return str(result.out)

    return run


@pytest.fixture
def gve_line(gve_unit: FakeGve, monkeypatch: pytest.MonkeyPatch) -> Iterator[FakeGveLine]:
    """A line with the `gve_unit` of the test's file, where commands of `gve134` go."""
    line = FakeGveLine(gve_unit)
    monkeypatch.setenv("GVE134_PORT", line.port)
    yield line
    line.close()


@pytest.fixture
def start_gve(tmp_path: Path) -> Callable[..., subprocess.Popen[str]]:
    """Start a command of `gve134` as a process of its own."""

    def begin(*arguments: str | Path) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [sys.executable, "-P", "-m", "rkm04_tools.gve134", *map(str, arguments)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": str(ROOT / "tools")},
        )

    return begin


@pytest.fixture
def fake(unit: FakeUnit, monkeypatch: pytest.MonkeyPatch) -> Iterator[FakeLine]:
    """A line with the `unit` of the test's file, where commands go that name no other."""
    line = FakeLine(unit)
    monkeypatch.setenv("RKM04_PORT", line.port)
    monkeypatch.setenv("RKM04_NODE", str(unit.node))
    yield line
    line.close()


@pytest.fixture
def call(tool: Tool, fake: FakeLine) -> Callable[..., str]:
    """Run a command on the fake line; return what it printed, which must be no complaint."""

    def run(*arguments: str | Path) -> str:
        result = tool(*arguments)
        assert (result.status, result.err) == (0, "")
        return result.out

    return run


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """The service program, without a browser."""
    running = Service(build_with_page(tmp_path_factory.mktemp("service")))
    yield running
    assert running.end() == (0, "")


@pytest.fixture
def start(tmp_path: Path) -> Callable[..., subprocess.Popen[str]]:
    """Start a command as a process of its own."""

    def begin(*arguments: str | Path) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [sys.executable, "-P", "-m", "rkm04_tools", *map(str, arguments)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": str(ROOT / "tools")},
        )

    return begin


@pytest.fixture
def write(tmp_path: Path) -> Callable[..., Path]:
    """Write a file; text becomes UTF-8."""

    def put(content: str | bytes, name: str = "a.rks") -> Path:
        path = tmp_path / name
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return put


@pytest.fixture
def serve(tmp_path: Path) -> Iterator[Callable[..., Served]]:
    """Start `serve` on a free port, without pacing, unless told otherwise."""
    all_of_them: list[Served] = []

    def begin(*arguments: str | Path, paced: bool = False, on_pty: bool = False) -> Served:
        place = [] if on_pty else ["--tcp", "0"]
        served = Served(*place, *([] if paced else ["--unpaced"]), *arguments, cwd=tmp_path)
        all_of_them.append(served)
        return served

    yield begin
    for served in all_of_them:
        served.end()

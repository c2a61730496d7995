"""Session files of sigrok (.sr), version 1 and 2: a zip file with samples of all channels in parts.

`metadata` names the channels: probeN is bit N - 1 of a sample, which has `unitsize` bytes, the
lowest one first. The samples are in `logic-1`, or in `logic-1-1`, `logic-1-2` and so on.
"""

from __future__ import annotations

import re
import zlib
from collections.abc import Collection, Iterator
from configparser import ConfigParser
from configparser import Error as ConfigError
from pathlib import Path
from typing import Any
from zipfile import BadZipFile, ZipFile

import numpy as np
from numpy.typing import NDArray

from rkm04_tools.bar import Bar
from rkm04_tools.compare.recording import PART_BYTES, Edges, Recording, hertz, names_of
from rkm04_tools.failure import Failure

MAGIC = b"PK\x03\x04"
VERSIONS = ("1", "2")
UNIT_BYTES_MAX = 8
METADATA_BYTES_MAX = 1 << 16
PROBE = re.compile(r"probe(\d{1,3})")

Words = NDArray[np.unsignedinteger[Any]]


class SigrokReader:
    """A session file that was opened."""

    kind = "a session of sigrok"

    def __init__(self, path: Path, given_hz: float = 0.0) -> None:
        self._path = path
        self._given_hz = given_hz
        try:
            self._zip = ZipFile(path)
        except (BadZipFile, EOFError):
            raise Failure(
                f"{path}: its end is missing, so it was cut off; save or copy it once more"
            ) from None
        except NotImplementedError as error:
            raise _damaged(path, error) from None
        device = self._device()
        self._sample_hz = hertz(device.get("samplerate", ""))
        self._unit = _number(device.get("unitsize", "1"))
        self._parts = self._find_parts(device.get("capturefile", ""))
        found = [(PROBE.fullmatch(key), name) for key, name in device.items()]
        self._bits = {name: int(match[1]) - 1 for match, name in found if match}
        self.names = names_of(name for match, name in found if match)
        if not 1 <= self._unit <= UNIT_BYTES_MAX:
            raise Failure(f"{path}: has samples of {self._unit} bytes, and not of 1 to 8")
        for name, bit in self._bits.items():
            if not 0 <= bit < 8 * self._unit:
                raise Failure(f"{path}: has no bit for its channel {name}; record it once more")

    def read(self, wanted: Collection[str]) -> Recording:
        """Read all samples, and keep the edges."""
        hz = self._sample_hz or self._given_hz
        if not hz:
            raise Failure(f"{self._path}: does not tell its sample rate: --sample-rate tells it")
        edges = Edges(self._path, wanted)
        masks = [1 << self._bits[name] for name in wanted]
        done, before = 0, None
        try:
            for words in self._samples():
                kept = words & words.dtype.type(sum(masks))
                if before is None:
                    for name, mask in zip(wanted, masks, strict=True):
                        edges.begin(name, int(bool(int(kept[0]) & mask)))
                    before = kept[:1]
                _add(edges, dict(zip(wanted, masks, strict=True)), before, kept, done)
                edges.require_room()
                done, before = done + len(kept), kept[-1:]
        except (BadZipFile, zlib.error, EOFError, RuntimeError, NotImplementedError) as error:
            raise _damaged(self._path, error) from None
        if done == 0:
            raise Failure(f"{self._path}: has no samples; record it once more")
        return Recording(0.0, done / hz, self._sample_hz, 0.0, edges.traces(1 / hz))

    def _device(self) -> dict[str, str]:
        """What the file says of the device whose channels it holds."""
        version = self._text("version").strip()
        if version not in VERSIONS:
            raise Failure(
                f"{self._path}: is of version {version[:9]} of sigrok's files, not 1 or 2"
            )
        parser = ConfigParser(interpolation=None, strict=False, delimiters=("=",))
        parser.optionxform = str  # type: ignore[assignment,method-assign]
        try:
            parser.read_string(self._text("metadata"))
        except ConfigError:
            raise Failure(f"{self._path}: its metadata cannot be read; save it once more") from None
        for section in parser.sections():
            if section.startswith("device") and "capturefile" in parser[section]:
                return dict(parser[section])
        raise Failure(f"{self._path}: has no logic channels; record STEP and DIR as digital ones")

    def _text(self, name: str) -> str:
        try:
            with self._zip.open(name) as file:
                return file.read(METADATA_BYTES_MAX).decode("utf-8", "replace")
        except KeyError:
            raise Failure(
                f"{self._path}: is a zip file without {name}, so no session of sigrok; name an .sr"
            ) from None
        except (BadZipFile, zlib.error, EOFError, RuntimeError, NotImplementedError) as error:
            raise _damaged(self._path, error) from None

    def _find_parts(self, capture: str) -> list[str]:
        """The names of the parts of the samples, in order; none may be missing."""
        names = self._zip.namelist()
        if capture in names:
            return [capture]
        part = re.compile(re.escape(capture) + r"-(\d{1,9})")
        found = sorted((int(m[1]), m[0]) for m in map(part.fullmatch, names) if m)
        for at, (number, _) in enumerate(found):
            if number != at + 1:
                raise Failure(f"{self._path}: part {at + 1} of its samples is missing")
        return [name for _, name in found]

    def _samples(self) -> Iterator[Words]:
        """All samples, as whole numbers."""
        size = sum(self._zip.getinfo(name).file_size for name in self._parts)
        done, rest = 0, b""
        with Bar("reading") as bar:
            for name in self._parts:
                with self._zip.open(name) as file:
                    while data := file.read(PART_BYTES):
                        done += len(data)
                        bar.show(done // 1_000_000, size // 1_000_000)
                        data = rest + data
                        whole = len(data) // self._unit * self._unit
                        rest = data[whole:]
                        if whole:
                            yield _words(data[:whole], self._unit)


def _words(data: bytes, unit: int) -> Words:
    """Samples of some bytes each as whole numbers."""
    if unit in (1, 2, 4, 8):
        return np.frombuffer(data, dtype=f"<u{unit}")
    wide = np.zeros((len(data) // unit, 8), dtype=np.uint8)
    wide[:, :unit] = np.frombuffer(data, dtype=np.uint8).reshape(-1, unit)
    return wide.view("<u8").reshape(-1)


def _add(edges: Edges, masks: dict[str, int], before: Words, words: Words, at: int) -> None:
    """Add the edges of a part whose first sample has this number."""
    where = np.flatnonzero(words[1:] != words[:-1]) + 1
    if words[0] != before[0]:
        where = np.insert(where, 0, 0)
    if not len(where):
        return
    changed = words[where] ^ np.concatenate((before, words))[where]
    for name, mask in masks.items():
        edges.extend(name, where[(changed & changed.dtype.type(mask)) != 0] + at)


def _damaged(path: Path, error: Exception) -> Failure:
    return Failure(f"{path}: is damaged ({error}); save or copy it once more")


def _number(text: str) -> int:
    return int(text) if text.isascii() and text.isdigit() and len(text) < 9 else 0

"""`board`: builds the image of a board, measures it, and writes it into the board's flash."""

from __future__ import annotations

import json
import re
import shlex
import shutil
import subprocess
from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path

from rkm04_tools import board_part, board_size
from rkm04_tools.board_form import form_errors
from rkm04_tools.board_header import Board, read_board
from rkm04_tools.failure import DONE, NO_CONNECTION, NOT_SO, Failure
from rkm04_tools.table import table, thousands
from rkm04_tools.tree import ROOT, require_checkout

PRESETS = ROOT / "CMakePresets.json"
BOARDS = ROOT / "hal" / "stm32" / "boards"
UNIT, BRINGUP = "rkm04", "bringup"
IMAGES = (UNIT, BRINGUP)
"""That of the unit, and the one that a new board is tried with."""
VERSIONS = {
    UNIT: ("firmware/rkm04/rkm04.h", r'RKM04_VERSION "([^"]+)"'),
    "gve134": ("firmware/gve134/command/gve_commands.def", r'"\?", "0,([^"]*)"'),
    "positioning": ("firmware/positioning/registers/registers.def", r'^U\(VERSION, .*, (\d+), ""'),
}
"""Of each unit that there is an image of, where its version stands."""
RATES = (38_400, 57_600, 115_200, 230_400, 460_800, 921_600)
"""Of a line of full duplex; hal/stm32 asserts that they fit."""
LINE_BD = re.compile(r"^#define IMAGE_LINE_BD (\d+)U$", re.MULTILINE)
DEFAULT_BOARD = "f405"
COMPILER = "arm-none-eabi-gcc"
FLASH_ADDRESS = 0x0800_0000
SECTOR_BYTES = 16 * 1024
USB_LOADER = "0483:df11"
"""How the chip's own loader shows up on USB."""

DFU_LEFT = 74
"""How dfu-util ends when it cannot ask the board for its state; so it is after `:leave`, too."""
DFU_WRITTEN = "File downloaded successfully"
SMALL_SIGN = "if it is less than 1 MB, all four LEDs blink at power-on"

SIZES_HEAD = ("", "bytes", "budget", "used")


@dataclass(frozen=True)
class Image:
    """The files of a built image."""

    board: str
    folder: Path
    what: str = UNIT

    @property
    def name(self) -> str:
        """Unit and board."""
        return f"{self.what}-{self.board}"

    @property
    def unit(self) -> str:
        """Whose it is; what a new board is tried with speaks as RKM04 does."""
        return UNIT if self.what == BRINGUP else self.what

    def file(self, suffix: str) -> Path:
        """The file of one kind: elf, hex, bin."""
        return self.folder / "bin" / f"{self.name}.{suffix}"


@dataclass(frozen=True)
class Flasher:
    """A program that writes flash: its Debian package, and what it says when nothing is there."""

    package: str
    missing: re.Pattern[str]
    advice: str


FLASHERS = {
    "openocd": Flasher(
        "openocd",
        re.compile(r"open failed|unable to find|no device found|init failed", re.IGNORECASE),
        "connect an ST-LINK to SWDIO, SWCLK, GND and NRST, and power the board",
    ),
    "dfu-util": Flasher(
        "dfu-util",
        re.compile(r"No DFU capable USB device", re.IGNORECASE),
        "connect the board's USB, and reset it with BOOT0 high (its README says where that is)",
    ),
    "stm32flash": Flasher(
        "stm32flash",
        re.compile(r"Failed to (open port|init device)|Cannot handle device", re.IGNORECASE),
        "connect a serial adapter to USART1, reset the board with BOOT0 high, and give --port",
    ),
}


def names(unit: str = UNIT) -> list[str]:
    """The boards that there are for a unit."""
    there = sorted(path.parent.name for path in BOARDS.glob("*/board.h"))
    return [name for name in there if not refusal(unit, name)]


def version(unit: str = UNIT) -> str:
    """The version that the image answers with."""
    file, pattern = VERSIONS[unit]
    match = re.search(pattern, (ROOT / file).read_text(), re.MULTILINE)
    if match and unit == "positioning":
        return f"{int(match[1]) >> 8:02}.{int(match[1]) & 0xFF:02}"
    return match[1] if match else ""


def image_header(unit: str) -> str:
    """What is fixed when an image of a unit is built."""
    return (ROOT / "firmware" / unit / "image/image.h").read_text()


def is_full_duplex(unit: str) -> bool:
    """Whether the line of a unit hears while it sends."""
    return "#define IMAGE_LINE_FULL_DUPLEX 1\n" in image_header(unit)


def line_bd(unit: str) -> int:
    """The rate that the line of a unit has as a rule."""
    (rate,) = LINE_BD.findall(image_header(unit))
    return int(rate)


def header_of(name: str) -> Board:
    """What the header of a board says, if the compiler reads it alike."""
    path = BOARDS / name / "board.h"
    for error in form_errors(text := path.read_text()):
        raise Failure(f"{path}: {error}", NOT_SO)
    return read_board(text)


def refusal(unit: str, board: str) -> str:
    """Why a board cannot have the image of a unit, or empty; as hal/stm32 asserts it."""
    if not is_full_duplex(unit):
        return ""
    values = read_board((BOARDS / board / "board.h").read_text()).values
    if values.get("BOARD_USART", "").rstrip("U") != "1":
        return "its line is not on USART1, which full duplex needs"
    if values.get("BOARD_STEP_CLASS", "1") != "1":
        return "an interrupt makes its steps, whose width cannot be kept then"
    return ""


def half_refusal(board: str, what: str) -> str:
    """Why an image cannot have pulses of half a period, or empty."""
    if what == BRINGUP:
        return "what a new board is tried with has pulses of one width"
    values = read_board((BOARDS / board / "board.h").read_text()).values
    if values.get("BOARD_STEP_CLASS", "1") != "1":
        return f"an interrupt makes the steps of {board}, each before it knows the next one"
    return ""


def image_of(
    board: str, what: str = UNIT, baud: int | None = None, half_period: bool = False
) -> Image:
    """Where a board's image is built: the default one where the preset builds it."""
    image = Image(board, ROOT / "build", what)
    if not (BOARDS / board / "board.h").exists():
        raise Failure(f"{board}: no such board; there are {', '.join(names(image.unit))}")
    if why := refusal(image.unit, board):
        raise Failure(f"{board} cannot be a unit {image.unit}: {why}")
    if half_period and (why := half_refusal(board, what)):
        raise Failure(f"--half-period: {why}")
    parts = ["stm32"]
    parts += [image.unit] if image.unit != UNIT else []
    parts += [board] if board != DEFAULT_BOARD else []
    parts += [str(baud)] if baud not in (None, line_bd(image.unit)) else []
    parts += ["half"] if half_period else []
    return Image(board, image.folder / "-".join(parts), what)


def build(
    board: str, target: str = "board_files", what: str = UNIT, baud: int | None = None,
    half_period: bool = False,
) -> Image:  # fmt: skip
    """Build all of a board, with the compiler installed if need be, or another target."""
    image = image_of(board, what, baud, half_period)
    require_checkout("building an image")
    if not shutil.which(COMPILER):
        _call([str(ROOT / "tools" / "setup"), "board"], "the compiler cannot be installed")
    configure = ["cmake", "--preset", "stm32", "-B", str(image.folder), f"-DFIRMWARE_BOARD={board}"]
    configure += [f"-DFIRMWARE_UNIT={image.unit}", f"-DFIRMWARE_LINE_BD={baud or ''}"]
    configure += [f"-DFIRMWARE_STEP_HALF={'ON' if half_period else 'OFF'}"]
    with _alone_in(image.folder) as lock:
        if not _is_set_up(image.folder):
            _call(configure, "the build cannot be set up", lock)
        building = ["cmake", "--build", str(image.folder), "--target", target]
        _call(building, "the image does not build", lock)
    return image


def _build_asked(options: Namespace) -> Image:
    return build(options.board, what=options.image, baud=options.baud,
                 half_period=options.half_period)  # fmt: skip


def _is_set_up(folder: Path) -> bool:
    """Whether a build knows the presets as they are; it looks after its other sources itself."""
    made = folder / "build.ninja"
    return made.exists() and made.stat().st_mtime > PRESETS.stat().st_mtime


@contextmanager
def _alone_in(folder: Path) -> Iterator[int]:
    """Hold off other builds in the same folder: two at once break each other.

    What builds gets the lock that is yielded, so that it lasts as long as that, whatever ends this.
    """
    import fcntl  # not on Windows

    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "build.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield lock.fileno()


def _call(command: list[str], complaint: str, *kept: int) -> None:
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, pass_fds=kept)
    if done.returncode != 0:
        print(done.stdout + done.stderr)
        raise Failure(f"{complaint}, see above", NOT_SO)


def run_build(options: Namespace) -> int:
    """`board build`: say where the files are."""
    image = _build_asked(options)
    files = [str(image.file(kind).relative_to(ROOT)) for kind in ("elf", "hex", "bin")]
    if options.json:
        told = {"board": image.board, "version": version(image.unit), "files": files}
        print(json.dumps(told))
    else:
        print(f"{image.name}, version {version(image.unit)}")
        print("\n".join(files))
    return DONE


def run_size(options: Namespace) -> int:
    """`board size`: the memory that the image needs, beside its budgets."""
    image = build(options.board, what=options.image)
    sizes = asdict(board_size.measure(image.file("elf"), image.folder, image.unit))
    budgets = asdict(board_size.budgets(image.unit))
    over = [name for name, size in sizes.items() if size > budgets[name]]
    if options.json:
        answer = {name: {"bytes": size, "budget": budgets[name]} for name, size in sizes.items()}
        print(json.dumps({"board": image.board, **answer, "over": over}))
    else:
        rows = [
            (name, thousands(size), thousands(budgets[name]), f"{100 * size / budgets[name]:.0f} %")
            for name, size in sizes.items()
        ]
        print(table([SIZES_HEAD, *rows], "lrrr"))
    if over:
        raise Failure(f"over the budget of hal/stm32/budgets.json: {', '.join(over)}", NOT_SO)
    return DONE


def loader_bytes(name: str) -> int:
    """What a loader of the board has of the flash, before the image."""
    values = header_of(name).values
    return int(values.get("BOARD_LOADER_BYTES", "0"), 0)


def require_tool(tool: str, name: str) -> None:
    """Refuse what does not get an image into a board."""
    values = header_of(name).values
    why = ""
    if tool == "stm32flash" and loader_bytes(name):
        why = "stm32flash would erase the loader of the board"
    if tool == "dfu-util" and values.get("BOARD_SLOW_CRYSTAL") == "1":
        why = (
            f"dfu-util is said not to work on {name}: its crystal starts too slowly for the chip's "
            "own loader by USB"
        )
    if why:
        raise Failure(f"{why}; take --tool openocd", NOT_SO)


def flash_command(tool: str, image: Image, probe: str, port: str) -> list[str]:
    """What writes an image, checks it and starts it; stored programs stay as they are."""
    if tool == "openocd":
        program = f"program {image.file('elf')} verify reset exit"
        scripts = ["-f", f"interface/{probe}.cfg", "-f", "target/stm32f4x.cfg"]
        return ["openocd", *scripts, "-c", program]
    if tool == "dfu-util":
        where = [
            "-a",
            "0",
            "-d",
            USB_LOADER,
            "-s",
            f"{FLASH_ADDRESS + loader_bytes(image.board):#010x}:leave",
        ]
        return ["dfu-util", *where, "-D", str(image.file("bin"))]
    sectors = -(-image.file("bin").stat().st_size // SECTOR_BYTES)
    return ["stm32flash", "-e", str(sectors), "-w", str(image.file("hex")), "-v", "-g", "0", port]


def run_flash(options: Namespace) -> int:
    """`board flash`: write the image into the board, or show how."""
    if options.tool == "stm32flash" and not options.port:
        raise Failure("stm32flash needs --port, the serial device that the board is connected to")
    image_of(options.board, options.image)
    require_tool(options.tool, options.board)
    image = _build_asked(options)
    command = flash_command(options.tool, image, options.probe, options.port or "")
    if options.dry_run:
        print(json.dumps({"command": command}) if options.json else shlex.join(command))
        return DONE
    kilobytes = _look(options)
    call_flasher(options.tool, command)
    if options.json:
        print(json.dumps({"flashed": image.board, "flash_kb": kilobytes}))
    else:
        print(f"{image.name} is flashed")
        if kilobytes is None:
            print(f"{options.tool} does not tell the size of the flash: {SMALL_SIGN}")
    return DONE


def _look(options: Namespace) -> int | None:
    """The size of the part's flash, which must do unless --small says otherwise."""
    look = board_part.look_command(options.tool, options.probe, USB_LOADER)
    if not look:
        return None
    kilobytes = board_part.flash_kb(options.tool, call_flasher(options.tool, look))
    if not options.small:
        board_part.require_room(kilobytes)
    return kilobytes


def has_left(tool: str, status: int, said: str) -> bool:
    """Whether dfu-util has written all, and only then lost the board, which has left its loader."""
    return tool == "dfu-util" and status == DFU_LEFT and DFU_WRITTEN in said


def call_flasher(tool: str, command: list[str]) -> str:
    """Run a program that speaks to the board; what it has said."""
    flasher = FLASHERS[tool]
    if not shutil.which(tool):
        hint = f"apt-get install {flasher.package}, or choose another --tool"
        raise Failure(f"{tool} is not installed: {hint}", NO_CONNECTION)
    # Left to its end if this is killed: half an image in the flash is worse than a late one.
    done = subprocess.run(command, capture_output=True, text=True, errors="replace")
    said = done.stdout + done.stderr
    if done.returncode == 0 or has_left(tool, done.returncode, said):
        return said
    if flasher.missing.search(said):
        raise Failure(f"{tool} finds no board: {flasher.advice}", NO_CONNECTION)
    print(said)
    raise Failure(f"{tool} failed, see above", NOT_SO)

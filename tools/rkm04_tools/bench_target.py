"""`bench --target stm32`: the figures of the image, modelled on the virtual board."""

from __future__ import annotations

import json
from argparse import Namespace
from pathlib import Path
from tempfile import TemporaryDirectory

from rkm04_tools import profile, target_run
from rkm04_tools.failure import DONE
from rkm04_tools.target_run import Model

RAMPS = b"S500 V16000 A60000 F8000 R"
AFTER_SECONDS = 0.85


def run(options: Namespace) -> int:
    """Measure what is asked for and print it."""
    with TemporaryDirectory() as folder:
        return _profile(Path(folder), Path(options.profile), options.json)


def _profile(folder: Path, listing: Path, as_json: bool) -> int:
    rig = target_run.rig(folder)
    listings, answer = [], {}
    for motors, title in ((1, "one motor"), (4, "four motors, due at the same tick")):
        line = target_run.programs(dict.fromkeys(range(1, motors + 1), RAMPS))
        seconds = line.released_ms / 1000 + AFTER_SECONDS
        ran = rig.run(seconds, line.lines, model=Model(3), profile=True)
        found = profile.of_run(ran.profile_file, rig.elf, ran.pulses)
        answer[title] = found.as_json()
        listings.append(f"{title}\n\n{found.text()}\n\n{found.listing()}\n")
        if not as_json:
            print(f"== {title}\n{found.text()}\n")
    listing.write_text("\n".join(listings))
    if as_json:
        print(json.dumps(answer, indent=2))
    return DONE

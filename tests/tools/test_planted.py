"""The planted bugs still fit the sources, and each names a test that there is."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from checks import planted

ROOT = Path(__file__).resolve().parents[2]
BUGS = planted.bugs()


@pytest.mark.parametrize("bug", BUGS, ids=lambda bug: str(bug.patch.stem))
def test_a_planted_bug_still_fits_the_sources(bug: planted.Bug) -> None:
    assert planted.apply(bug, ROOT, "--check") == ""


@pytest.mark.parametrize("bug", BUGS, ids=lambda bug: str(bug.patch.stem))
def test_a_planted_bug_names_a_test_that_there_is(bug: planted.Bug) -> None:
    if bug.runner == "ctest":
        stage, _, module = bug.test.partition(".")
        folders = [ROOT / "tests" / "unit" / stage, ROOT / "tests" / stage]
        assert any((folder / f"test_{module}.c").exists() for folder in folders)
    else:
        file, _, function = bug.test.partition("::")
        name = function.partition("[")[0]
        assert re.search(rf"^def {name}\b", (ROOT / file).read_text(), re.MULTILINE)


def test_there_are_planted_bugs_all_over_the_tree() -> None:
    touched = {
        line.split("/")[1]
        for bug in BUGS
        for line in bug.patch.read_text().splitlines()
        if line[:6] == "+++ b/"
    }

    assert len(BUGS) >= 24
    assert {"firmware", "hal"} <= touched


def test_the_documents_say_how_many_there_are() -> None:
    assert f"{len(BUGS)} planted bugs" in (ROOT / "README.md").read_text()
    assert f"{len(BUGS)} patches" in (ROOT / "firmware/docs/reliability.md").read_text()


def test_a_patch_that_does_not_fit_is_told(tmp_path: Path) -> None:
    shutil.copy(BUGS[0].patch, tmp_path)

    assert "No such file" in planted.apply(BUGS[0], tmp_path, "--check")


@pytest.mark.parametrize(
    "head", ["", "A bug.\n", "A bug.\nCaught by: luck\n", "a bug\nCaught by: ctest x.y\n"]
)
def test_a_patch_without_a_head_is_refused(tmp_path: Path, head: str) -> None:
    patch = tmp_path / "bug.patch"
    patch.write_text(head)

    with pytest.raises(planted.BadPatch):
        planted.read(patch)

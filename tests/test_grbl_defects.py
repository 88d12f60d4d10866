# SPDX-License-Identifier: MIT
"""Red before green: some of the defects of grbl_defects.toml, planted; `make grbl-defects` plants all."""

import random
from pathlib import Path

from passo import random_cases
from passo.toolchain import paths

from tests.helpers.grbl_defects import Copy, defects

PLANTED = 2


def test_every_defect_has_a_place_and_a_test() -> None:
    """Its text is there once, and so is its test."""
    for defect in defects():
        text = " ".join((paths.root / defect.file).read_text(encoding="utf-8").split())
        assert text.count(" ".join(defect.old.split())) == 1, defect.name
        file, name = defect.test.split("::")
        assert f"def {name}(" in (paths.tests / file).read_text(encoding="utf-8"), defect.name


def test_planted_defects_are_caught(tmp_path: Path) -> None:
    """The test of each fails in the copy of the sources that has it, for that reason alone."""
    copy = Copy(tmp_path)
    for defect in random.Random(random_cases.seed()).sample(defects(), PLANTED):
        assert copy.catches(defect), defect.name

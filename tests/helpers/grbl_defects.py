# SPDX-License-Identifier: MIT
"""Plants the defects of tests/grbl_defects.toml in a copy of the sources: the test of each must fail.

python -m tests.helpers.grbl_defects [NAME...]: those, or all.
"""

import os
import shutil
import subprocess
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

from passo.console import each
from passo.failure import BuildError
from passo.planted import plant
from passo.toolchain import BUILD_VARIABLE, paths

FOLDERS = ("rtl", "c_model", "sim", "spec", "stm32_bridge", "linux", "tests", "examples")
LEFT_OUT = shutil.ignore_patterns("__pycache__", "*.pyc")
PASSED, FAILED = 0, 1  # exit status of pytest
NOT_BUILT = -1  # no test has seen it


@dataclass(frozen=True)
class Defect:
    """A defect, and the test that sees it."""

    name: str
    says: str
    test: str
    file: str
    old: str
    new: str


def defects() -> list[Defect]:
    """Read grbl_defects.toml."""
    text = (paths.tests / "grbl_defects.toml").read_text(encoding="utf-8")
    return [Defect(**entry) for entry in tomllib.loads(text)["defect"]]


class Copy:
    """A copy of the sources, with its own libraries; those without a change are not built again."""

    def __init__(self, folder: Path):
        self.root = folder / "copy"
        shutil.rmtree(self.root, ignore_errors=True)
        for name in FOLDERS:
            shutil.copytree(paths.root / name, self.root / name, ignore=LEFT_OUT)
        shutil.copy(paths.root / "pyproject.toml", self.root)
        for library in (paths.build / "lib").glob("*-*"):
            if library.is_dir():
                shutil.copytree(library, self.root / "build" / "lib" / library.name)

    def status(self, test: str) -> int:
        """Run a test in the copy; the exit status of pytest, or NOT_BUILT."""
        packages = [self.root, self.root / "sim", self.root / "stm32_bridge"]
        environment = {
            **os.environ,
            "PYTHONPATH": os.pathsep.join(map(str, packages)),
            BUILD_VARIABLE: str(self.root / "build"),
        }
        command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", f"tests/{test}"]
        ran = subprocess.run(command, cwd=self.root, env=environment, capture_output=True)
        return NOT_BUILT if BuildError.__name__.encode() in ran.stdout else ran.returncode

    def catches(self, defect: Defect) -> bool:
        """Whether the test of a planted defect fails."""
        file = self.root / defect.file
        before = file.read_bytes()
        plant(file, defect.old, defect.new)
        try:
            return self.status(defect.test) == FAILED
        finally:
            file.write_bytes(before)


def main() -> int:
    """Plant them, one after the other."""
    chosen = [defect for defect in defects() if defect.name in sys.argv[1:] or not sys.argv[1:]]
    copy, missed = Copy(paths.build / "grbl_defects"), 0
    for defect in each("defects", chosen):
        green = copy.status(defect.test) == PASSED
        caught = green and copy.catches(defect)
        missed += not caught
        said = "caught by" if caught else "NOT CAUGHT by" if green else "fails without it:"
        print(f"{defect.name}: {said} {defect.test}", flush=True)
    print(f"{len(chosen) - missed} of {len(chosen)} defects of grbl are caught")
    return int(missed > 0)


if __name__ == "__main__":
    sys.exit(main())

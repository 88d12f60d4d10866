# SPDX-License-Identifier: MIT
"""The page docs/reference/paths.md, from the report of `make path`.

    python -m benchmarks.path_page

writes it again from build/path.json.
"""

import json
import sys
from collections.abc import Iterable, Mapping, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

from passo.axis_judge import BOUND, JERK_BOUND
from passo.ending import ended
from passo.output import write_text
from passo.path import LOOK_AHEAD
from passo.toolchain import paths

from benchmarks.path_measure import (
    LOOK_AHEAD_AIM,
    OFF_BOUND,
    PACED_AIM,
    SHAPED_AIM,
    SOFT_AIM,
    UNLIMITED_AIM,
)
from benchmarks.tables import markdown

REPORT = paths.build / "path.json"
PAGE = paths.reference / "paths.md"
TEMPLATE = Path(__file__).with_name("path_page.md")
TITLES = {
    "circle": "circle of 20 mm in 360 chords",
    "square": "square of 50 mm",
    "star": "star of 11 sharp corners",
    "spiral": "spiral in chords of 0.1 mm",
    "text": "engraved text",
    "trochoid": "trochoidal slot of 4 mm",
}
# What the search measures, with the bound.
SEARCHED = {
    "unlimited": ("duration, linear ramps, all lines known; 1: the fastest motion", UNLIMITED_AIM),
    "look_ahead": (f"the same with {LOOK_AHEAD} lines, where the braking distance fits", LOOK_AHEAD_AIM),
    "shaped": ("duration, cosine and sigmoid ramps; 1: the fastest motion with linear ones", SHAPED_AIM),
    "soft": ("duration, profile `jerk`; 1: a fast motion with that jerk", SOFT_AIM),
    "paced": ("duration with 500 to 8,000 polls a second; 1: any number, each line sent", PACED_AIM),
    "speed": ("speed of an axis at the pins; 1: its limit", BOUND),
    "acceleration": ("acceleration of an axis at the pins, all components; 1: its limit", BOUND),
    "jerk": ("jerk of an axis at the pins, profile `jerk`; 1: its limit", JERK_BOUND),
    "off": ("way off the path, beyond the tolerance of merging, in motor steps", OFF_BOUND),
}
COUNTED = {
    "underrun": "an underrun of the core",
    "fault": "any other fault, or an end that is not exact",
    "slow": "slower than its bound, all lines known",
    "slow48": f"slower than its bound, {LOOK_AHEAD} lines",
    "paced": "slower than its polls permit",
    "speed": "an axis too fast",
    "acceleration": "an acceleration too high",
    "jerk": "a jerk too high",
    "off": "off the path",
}


def page(report: Mapping[str, Any]) -> str:
    """docs/reference/paths.md."""
    found = report["adversarial"]
    rows = [
        [text, f"{found['worst'].get(name, 0.0):.4f}", f"{bound:g}"]
        for name, (text, bound) in SEARCHED.items()
    ]
    counts = [[text, f"{found['beyond'].get(kind, 0):,}"] for kind, text in COUNTED.items()]
    return TEMPLATE.read_text(encoding="utf-8").format(
        paths=f"{found['paths']:,}",
        worst=markdown(("the worst of all", "measured", "bound"), rows),
        beyond=markdown(("beyond a bound", "paths"), counts),
        look_ahead=LOOK_AHEAD,
        reference=markdown(PATHS, list(_paths(report["paths"]))),
        circle=f"{report['circle_seconds']:.3f}",
        profiles=markdown(("path", "", *PROFILES), list(_profiles(report["profiles"]))),
    )


PATHS = (
    *("path", "lines", "seconds", "ratio, all lines known", f"ratio, {LOOK_AHEAD} lines"),
    *("speed", "acceleration", "instructions per line, STM32F103"),
)
PROFILES = ("linear", "cosine", "sigmoid", "jerk")


def _paths(results: Iterable[Mapping[str, Any]]) -> Iterable[list[str]]:
    for one in results:
        title = TITLES.get(one["name"], f"the worst of {one['name'].replace(' poly', ' random poly')}")
        ratios = [f"{one[key]:.4f}" for key in ("unlimited", "look_ahead")]
        shares = [f"{one[key]:.3f}" for key in ("speed", "acceleration")]
        cost = f"{one['instructions']:,}" if one["instructions"] else ""
        yield [title, f"{one['lines']:,}", f"{one['seconds']:.3f}", *ratios, *shares, cost]


def _profiles(profiles: Sequence[Mapping[str, Any]]) -> Iterable[list[str]]:
    for name, group in groupby(profiles, lambda one: one["name"]):
        of = {one["profile"]: one for one in group}
        times = []
        for profile in PROFILES:
            known, ahead = (f"{of[profile][key]:.3f}" for key in ("time", "look_ahead"))
            times.append(known if known == ahead else f"{known} ({ahead})")
        yield [TITLES[name], "time", *times]
        yield ["", "jerk", *(f"{of[profile]['peak_jerk']:,.0f}" for profile in PROFILES)]


def write(report: Mapping[str, Any]) -> None:
    """Write the page."""
    write_text(PAGE, page(report))


if __name__ == "__main__":
    sys.exit(ended(lambda: write(json.loads(REPORT.read_text(encoding="utf-8")))))

# SPDX-License-Identifier: MIT
"""The order of the tests, and the short form of them that `make test` runs.

Of each test it has as many cases as take SECONDS by tests/times.txt, which lists the tests that take longer;
of one marked sample(n) it has n. They are evenly spread, and PASSO_SEED chooses them.
"""

from collections import defaultdict
from pathlib import Path

import pytest
from passo.random_cases import seed

SECONDS = 4
TIMES = Path(__file__).parent / "tests" / "times.txt"


def test_of(node: str) -> str:
    """The test that a case belongs to."""
    return node.partition("[")[0]


def listed() -> dict[str, float]:
    """Of tests that take more than SECONDS: the mean of a case, with three workers on two cores."""
    lines = (line.split() for line in TIMES.read_text().splitlines() if not line.startswith("#"))
    return {name: float(seconds) for seconds, name in lines}


def chosen(count: int, kept: int, seed: int) -> set[int]:
    """Which cases run if `kept` of `count` do: evenly spread; each has its turn while `seed` counts up."""
    kept = min(kept, count)
    return {(seed + count * place // kept) % count for place in range(kept)}


class Times:
    """Takes the time of each case and lists the tests that take long."""

    def __init__(self) -> None:
        self.cases: dict[str, float] = defaultdict(float)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Of its fixtures too."""
        self.cases[report.nodeid] += report.duration

    def pytest_sessionfinish(self) -> None:
        """A run of some of the files keeps the lines of the others."""
        tests = defaultdict(list)
        for node, seconds in self.cases.items():
            tests[test_of(node)].append(seconds)
        known = {name: mean for name, mean in listed().items() if name not in tests}
        known |= {name: sum(all_) / len(all_) for name, all_ in tests.items() if sum(all_) > SECONDS}
        lines = "".join(f"{mean:7.3f} {name}\n" for name, mean in sorted(known.items()))
        TIMES.write_text(f"# Seconds of a case, written by `make test-all TIMES=1`.\n{lines}")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Options of Passo."""
    parser.addoption("--short", action="store_true", help="the short form of the tests, as in make test")
    parser.addoption("--times", action="store_true", help="write tests/times.txt")


def pytest_configure(config: pytest.Config) -> None:
    """Workers of xdist report to their master."""
    if config.getoption("--times") and not hasattr(config, "workerinput"):
        config.pluginmanager.register(Times())


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Some tests start before the rest: at the end, the other workers would wait for them."""
    if config.getoption("--short"):
        tests, times = defaultdict(list), listed()
        for item in items:
            tests[test_of(item.nodeid)].append(item)
        short = set[pytest.Item]()
        for test, cases in tests.items():
            mark = cases[0].get_closest_marker("sample")
            kept = mark.args[0] if mark else int(SECONDS / times[test]) if test in times else len(cases)
            short |= {cases[place] for place in chosen(len(cases), kept, seed())}
        config.hook.pytest_deselected(items=[item for item in items if item not in short])
        items[:] = [item for item in items if item in short]
    items.sort(key=lambda item: item.get_closest_marker("first") is None)

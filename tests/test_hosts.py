# SPDX-License-Identifier: MIT
"""`make hosts` in short: timed points with late polls, bit errors and hosts that die."""

from benchmarks.hosts import good, measure


def test_promises() -> None:
    """Nothing is lost, late polls and bit errors change no edge, the wire has room."""
    found = measure(seed=7, seconds=3, deaths=3, hour=60)
    print(found)
    assert good(found), found
    assert found.flips > 10
    assert sum(found.causes.values()) == 3 and set(found.causes) <= {"RAMP_UNDERRUN", "WATCHDOG"}

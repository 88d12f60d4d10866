# SPDX-License-Identifier: MIT
"""The record of plans: a plan changes only together with its record (`python -m benchmarks.plan_record`)."""

import pytest

from benchmarks.plan_record import entries, read

ENTRIES, RECORD = entries(), read()


def test_the_record_is_complete() -> None:
    """It has what is planned, and no more."""
    assert RECORD.keys() == ENTRIES.keys()


@pytest.mark.parametrize("name", ENTRIES)
def test_a_plan_is_as_recorded(name: str) -> None:
    """If the change is wanted, the command above writes the record again."""
    assert ENTRIES[name]() == RECORD[name]

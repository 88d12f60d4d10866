# SPDX-License-Identifier: MIT
"""Inverted connections are seen; `make verify ONLY=wiring` inverts all of them."""

import pytest
from passo.failure import Failure
from passo.toolchain import paths

from verify.equal import wiring

SOME = (
    *("passo_core.u_link.bus_busy", "passo_profile.u_ramp.ramp_half", "passo_axes.u_axis.direction"),
    "passo_trackers.u_join.path_down",
)


def test_every_instance_is_found() -> None:
    """As many as there are named ports in the text, without outputs and parameters."""
    wires = wiring.cut_wires(paths.build / "tests" / "wiring")
    assert [wire.number for wire in wires] == list(range(1, len(wires) + 1))
    assert len({wire.name for wire in wires}) == len(wires) > 400
    assert {wire.name.partition(".")[0] for wire in wires} == set(wiring.MODULES)


def test_cuts_are_seen() -> None:
    """And the RTL with switches is as the model if none is thrown."""
    assert all(wiring.check(1, SOME).values())


def test_a_connection_that_does_not_exist() -> None:
    with pytest.raises(Failure, match=r"there is no connection passo_core\.u_link\.nothing"):
        wiring.check(1, ["passo_core.u_link.nothing"])

# SPDX-License-Identifier: MIT
"""passo_core_advance() of a core with inputs, encoders and outputs: the same state as clock by clock.

PASSO_SEED is the seed of the random motions.
"""

import random

import pytest
from passo import registers as r
from passo.build import Parameters

from tests.test_core_advance import SEED
from tests.test_encoders import EncoderSession
from tests.test_outputs_advance import OutputSession

PARTS = dict.fromkeys(("inputs", "encoders", "outputs", "raster", "compare"), 1)
BUILDS = [
    Parameters(axes=3, **PARTS),
    Parameters(channels=2, axes=2, line_queue_log2=3, ramp_queue_log2=3, **PARTS),
]


class MachineSession(OutputSession, EncoderSession):
    """A host that does anything with a machine that does anything."""


@pytest.mark.parametrize("number", range(8))
def test_advance_agrees_with_every_clock(number: int) -> None:
    rng = random.Random(f"{SEED}/machine/{number}")
    MachineSession(BUILDS[number % len(BUILDS)], rng).play(40)


def test_a_machine_that_stands_is_skipped() -> None:
    """With an armed trigger and encoders at any level."""
    session = MachineSession(BUILDS[0], random.Random(SEED))
    trigger = r.ChannelTriggerWord(
        source=r.TriggerSource.INDEX, axis=1, falling=False, action=r.TriggerAction.LATCH, arm=True
    )
    session.link.write(session.channels[0].base + r.CHANNEL_TRIGGER, trigger.pack())
    session.pair.set("encoder_a", 5)
    session.pair.run(100_000)
    assert session.pair.skipped > 99_000
    session.pair.set("encoder_index", 2)
    session.pair.run(1000)
    state = session.link.read(session.channels[0].base + r.CHANNEL_TRIGGER_STATE, 1)
    assert r.ChannelTriggerStateWord.unpack(state[0]).fired

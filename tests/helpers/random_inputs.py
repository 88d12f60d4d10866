# SPDX-License-Identifier: MIT
"""Random events at the inputs of a machine: levels of pins, and writes to the registers of inputs."""

import random

from passo import registers as r
from passo.build import Parameters
from passo.pins import INPUTS

PINS = [pin for pin in INPUTS if pin.parameter == "inputs"]
E_STOP_SHARE = 0.1  # share of the events at pins that press or release e-stop


def width(parameters: Parameters, pin: str) -> int:
    """Bits of a pin."""
    (form,) = (known.width for known in PINS if known.name == pin)
    return {"1": 1, "CHANNELS": parameters.channels}.get(form, parameters.channels * parameters.axes)


class RandomInputs:
    """Draws events; what it has drawn for the pins stays in `levels`."""

    def __init__(self, rng: random.Random, parameters: Parameters) -> None:
        self.rng, self.parameters = rng, parameters
        self.levels = {pin.name: pin.idle for pin in PINS}

    def pin(self) -> tuple[str, int]:
        """A change of a pin: one bit, and back again more often than not."""
        rng = self.rng
        if not self.levels["estop_n"] or rng.random() < E_STOP_SHARE:
            name, level = "estop_n", int(not self.levels["estop_n"])
        else:
            name = rng.choice([pin.name for pin in PINS if pin.name != "estop_n"])
            level = 0
            if self.levels[name] == 0 or rng.random() < 0.3:
                level = self.levels[name] ^ 1 << rng.randrange(width(self.parameters, name))
        self.levels[name] = level
        return name, level

    def write(self) -> tuple[int, int]:
        """A write: address and word."""
        rng, parameters = self.rng, self.parameters
        channel = r.ADDRESS_CHANNEL_BASE + rng.randrange(parameters.channels) * r.ADDRESS_CHANNEL_STRIDE
        axis = rng.randrange(parameters.axes)
        kind = rng.randrange(12)
        if kind == 0:
            return r.ADDRESS_INPUT_FILTER, rng.choice([0, 0, 1, 2, rng.randrange(100)])
        if kind == 1:
            word = r.WatchdogWord(stop_after=rng.randrange(3), disable_after=rng.randrange(2))
            return r.ADDRESS_WATCHDOG, word.pack()
        if kind < 5:
            return r.ADDRESS_ESTOP_CLEAR, 1
        if kind == 5:
            return channel + r.CHANNEL_INPUT_CLEAR, rng.getrandbits(32)
        if kind == 6:
            return channel + r.CHANNEL_PROBE, rng.choice([0, 0, 1, 2])
        if kind < 9:
            block = channel + r.CHANNEL_AXIS_BASE + axis * r.CHANNEL_AXIS_STRIDE
            polarities = 0 if rng.random() < 0.8 else 1 << rng.randrange(4)
            return block + r.AXIS_INPUTS, polarities | rng.getrandbits(3) << r.AXIS_INPUTS_LIMIT_SOFT_LSB
        return channel + r.CHANNEL_TRIGGER, self._trigger(axis).pack()

    def _trigger(self, axis: int) -> r.ChannelTriggerWord:
        rng = self.rng
        return r.ChannelTriggerWord(
            source=r.TriggerSource(rng.randrange(1, 6)),
            axis=axis,
            falling=rng.random() < 0.3,
            action=r.TriggerAction(rng.randrange(4)),
            arm=rng.random() < 0.9,
        )

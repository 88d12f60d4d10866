# SPDX-License-Identifier: MIT
"""The console and a core that lost its settings: what was set is written again."""

from collections.abc import Sequence

import pytest
from passo import registers as r
from passo.engine import Engine, model_engine
from passo.registers import HeaderWord, Operation

from tests.test_console import CLOCK_HZ, Bench

# What moves or switches something: a new core is not told.
COMMANDS = {r.CHANNEL_COMMAND, r.CHANNEL_TRACKER_ENABLE, r.CHANNEL_OUTPUT_LEVELS}
SETTINGS = {
    "core": ("config input_filter=20us watchdog=0.4 watchdog_disable=0.2 hold_time=0.3 stop_time=0.07",),
    "pins": (
        "config axis=1 step_high=3us step_low=4us dir_setup=5us dir_hold=6us step_inverted=1",
        "config axis=2 direction_inverted=1 enable_inverted=1 both_edges=1",
    ),
    "inputs": (
        "input axis=0 limit_low=active_low limit_soft=1",
        "input axis=2 home=active_high alarm=active_high alarm_disables=1",
    ),
    "probe": ("input probe=active_low",),
    "outputs": ("output levels=5 pwm=2000 lag=30us reference=0.25",),
    "encoder": ("encoder axis=1 counts_per_step=2.5 limit=20 stop=soft inverted=1", "encoder filter=9"),
    "tracker": ("tracker axis=2 speed=5000 acceleration=200_000", "tracker axis=0 speed=70 acceleration=900"),
}


def listen(engine: Engine) -> dict[int, int]:
    """The last word that each register is sent, by address, from now on."""
    sent: dict[int, int] = {}
    send = engine.transfer

    def transfer(mosi: Sequence[int], gap: int = 16) -> list[int]:
        header = HeaderWord.unpack(mosi[0])
        if header.operation == Operation.WRITE:
            for i in range(header.length):
                sent[header.address + i] = mosi[1 + i]
        return send(mosi, gap)

    engine.transfer = transfer  # type: ignore[method-assign]
    return sent


@pytest.mark.parametrize("first", SETTINGS)
def test_open_sets_up_a_new_core(first: str) -> None:
    """Each kind of setting, given first or last; the words of the registers are those of before."""
    bench = Bench(axes=3, inputs=1, encoders=1, outputs=1, trackers=1)
    fresh = model_engine(bench.engine.parameters, CLOCK_HZ)
    before, after = listen(bench.engine), listen(fresh)
    for kind in (first, *(kind for kind in SETTINGS if kind != first)):
        for line in SETTINGS[kind]:
            assert bench.ask(line) == "ok", line
    bench.machine.engine = fresh
    assert bench.ask("open") == "ok"
    channel = r.ADDRESS_CHANNEL_BASE
    settings = {
        at: word for at, word in before.items() if at - channel not in COMMANDS and at != r.ADDRESS_RUN
    }
    assert len(settings) > 20
    assert {at: after.get(at) for at in settings} == settings
    bench.machine.engine = bench.engine
    fresh.close()
    bench.close()


ONE_BY_ONE = {
    "config": (
        "hold_time=300ms stop_time=70ms flow=refuse need_enable=1 input_filter=30us watchdog=0.4 "
        "watchdog_disable=0.2",
        "hold_time=200ms stop_time=80ms flow=wait need_enable=0 input_filter=40us watchdog=0.3 "
        "watchdog_disable=0.1",
    ),
    "config axis=1": (
        "step_high=3us step_low=4us dir_setup=5us dir_hold=6us step_inverted=1 direction_inverted=1 "
        "enable_inverted=1 both_edges=1 steps_per_unit=20",
        "step_high=4us step_low=5us dir_setup=6us dir_hold=7us step_inverted=0 direction_inverted=0 "
        "enable_inverted=0 both_edges=0 steps_per_unit=30",
    ),
    "input axis=1": (
        "limit_low=active_high limit_high=active_high home=active_high alarm=active_high limit_soft=1 "
        "alarm_soft=1 alarm_disables=1",
        "limit_low=active_low limit_high=active_low home=active_low alarm=none limit_soft=0 alarm_soft=0 "
        "alarm_disables=0",
    ),
    "output": ("levels=5 pwm=2000 lag=30us reference=0.25", "levels=6 pwm=3000 lag=40us reference=0.125"),
    "encoder axis=1": (
        "counts_per_step=2.5 limit=20 stop=soft inverted=1 index_inverted=1 index_gated=1",
        "counts_per_step=3.5 limit=30 stop=hard inverted=0 index_inverted=0 index_gated=0",
    ),
    "tracker axis=1": (
        "speed=5000 acceleration=200_000 backlash=3",
        "speed=6000 acceleration=300_000 backlash=4",
    ),
}


@pytest.mark.parametrize("command", ONE_BY_ONE)
def test_a_setting_changes_alone(command: str) -> None:
    """The others are shown as they were, whichever one is given."""
    bench = Bench(axes=3, inputs=1, encoders=1, outputs=1, trackers=1)
    first, second = ONE_BY_ONE[command]
    assert bench.ask(f"{command} {first}") == "ok"
    shown = bench.tell(command)
    keys = [word.partition("=")[0] for word in first.split()]
    assert set(keys) <= set(shown)
    for word in second.split():
        assert bench.ask(f"{command} {word}") == "ok", word
        now = bench.tell(command)
        assert [key for key in now if now[key] != shown[key]] == [word.partition("=")[0]]
        shown = now
    bench.close()

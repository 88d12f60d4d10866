# SPDX-License-Identifier: MIT
"""The host of a move file with a machine: settings, tasks, readings."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from passo import registers as r
from passo.driver import Driver, DriverError, new_track
from passo.link import error_name, error_text
from passo.move_forms import USER_BANK, MachineEncoder, MachineTrack, MoveHome, MoveProbe, MoveThread
from passo.moves import MoveFile, Task, q32
from passo.moving_channel import SLEWS_PER_SECOND
from passo.native import ffi, planner
from passo.plan import table_of
from passo.registers import TriggerSource
from passo.rig import RATIO_ONE
from passo.run import RunError
from passo.scene_plan import reference_of
from passo.scene_run import Section, sampled_at
from passo.setup import Setup
from passo.setup_outputs import counts_of, fastest

SPINDLE_FILTER = 3  # clocks
STOPS = {"none": "PASSO_FOLLOWING_SHOW", "soft": "PASSO_FOLLOWING_SOFT", "hard": "PASSO_FOLLOWING_HARD"}


class SceneDriver(Driver):
    """A driver with what a scene needs besides."""

    def configure_inputs(self, setup: Setup, axes: int) -> None:
        """Tell the core which inputs are there; afterwards an alarm has its polarity."""
        self.call("configure_watchdog", 0, 0)
        self.call("configure_filter", round(setup.settings.filter * self.clock_hz))
        for axis in range(axes):
            self.call("configure_inputs", axis, _input_config(setup, axis))

    def configure(self, setup: Setup, file: MoveFile, sections: list[Section]) -> None:
        """All other settings."""
        plans = [plan for section in sections for plan in section.plans]
        for axis in range(file.axes):
            self.configure_axis(axis, file.pins)
        probe = setup.find("probe", 0)
        if probe is not None:
            self.call("configure_probe", setup.inputs[probe].polarity == "low")
        stop = setup.settings.stop_time
        slew = self.clock_hz // SLEWS_PER_SECOND if stop is None else round(stop * self.clock_hz)
        slowest = min((plan.c.velocity_peak for plan in plans), default=0)
        self.call("configure_motion", slew, slew, max(1, slowest >> 16 >> 4) if slowest else 0)
        if table := table_of(plans):
            self.call("load_table", USER_BANK, table)
        for encoder in setup.encoders:
            self.call("configure_encoder_filter", encoder.filter)
            self.call("configure_encoder", encoder.axis, _encoder_config(encoder))

        if setup.spindle and not setup.encoders:
            self.call("configure_encoder_filter", SPINDLE_FILTER)
        self._configure_outputs(setup, reference_of(setup, sections))

    def _configure_outputs(self, setup: Setup, reference: int) -> None:
        if setup.has_outputs:
            lag = round(setup.settings.lag * self.clock_hz)
            fields = {"pwm_hz": round(setup.settings.pwm), "reference": reference, "lag": lag}
            self.call("configure_outputs", ffi().new("struct passo_outputs_config *", fields))
        if compare := setup.compare:
            fields = {
                "axis": compare.axis,
                "position": int(compare.position.value) - setup.start(compare.axis),
                "interval": compare.interval,
                "width": round(compare.width * self.clock_hz),
            }
            self.call("arm_compare", ffi().new("struct passo_compare_config *", fields))

    def push_raster(self, values: Sequence[int]) -> int:
        """Queue values of a raster line; return how many were taken."""
        taken = ffi().new("size_t *")
        error = self.attempt("push_raster", bytes(values), len(values), taken)
        if error and error_name(error) != "STOPPED":
            raise DriverError("push_raster", error)
        return 0 if error else taken[0]

    def begin(self, move: Task, setup: Setup) -> None:
        """Begin a home, a probe or a thread."""
        if isinstance(move, MoveThread):
            self.call("thread", _thread(move, setup))
            return
        common = {"speed": q32(move.speed), "acceleration": q32(move.acceleration)}
        if isinstance(move, MoveProbe):
            fields = {"steps": move.steps, "away": move.away, "optional": move.optional}
            self.call("probe", ffi().new("struct passo_probe *", common | fields))
        if isinstance(move, MoveHome):
            fields = {
                "source": TriggerSource[move.switch.upper()],
                "back_off": move.back_off,
                "pull_off": move.pull_off,
                "slow_speed": q32(move.slow_speed),
                "position": move.edge_position,
            }
            moved = [(axis, steps) for axis, steps in enumerate(move.steps) if steps]
            self.homes = ffi().new("struct passo_home[]", len(moved))  # must live until the end
            for home, (axis, steps) in zip(range(len(moved)), moved, strict=True):
                self.homes[home] = common | fields | {"axis": axis, "distance": steps}
            self.call("home", self.homes, len(moved))

    def trigger(self) -> Any:
        """The `struct passo_trigger_report`."""
        report = ffi().new("struct passo_trigger_report *")
        self.call("read_trigger", report)
        return report

    def readings(self) -> Any:
        """The `struct passo_readings`."""
        readings = ffi().new("struct passo_readings *")
        self.call("read_inputs", readings)
        return readings

    def sample(self, axes: int) -> tuple[int, np.ndarray, np.ndarray]:
        """A SAMPLE: its clock, positions as the core counts them, encoder positions."""
        clock = sampled_at(self.engine.clock)
        at = r.CHANNEL_ENCODER_POSITION_BASE - r.CHANNEL_POSITION_BASE
        words = self.read(r.CHANNEL_POSITION_BASE, at + axes)
        both = np.zeros((2, 8), np.int32)
        for row, first in enumerate((0, at)):
            both[row, :axes] = np.array(words[first : first + axes], np.uint32).view(np.int32)
        return clock, both[0], both[1]

    def tracker_positions(self) -> list[int]:
        """Steps of the trackers of 8 axes."""
        words = self.read(r.CHANNEL_TRACKER_POSITION_BASE, r.CHANNEL_TRACKER_POSITION_COUNT)
        return np.array(words, np.uint32).view(np.int32).tolist()

    def greatest(self, axis: int, counts_per_step: float) -> float:
        """Greatest following error of an axis in steps."""
        reading = ffi().new("struct passo_encoder_reading *")
        self.call("read_encoder", axis, reading)
        return reading.greatest / counts_per_step

    def read(self, address: int, length: int) -> list[int]:
        """Read registers of the channel."""
        words = ffi().new("uint32_t[]", length)
        address += r.ADDRESS_CHANNEL_BASE
        self._wire(self.lib.passo_host_read(self.host, address, words, length))
        return list(words)

    def _wire(self, error: int) -> None:
        self.hardware.check()
        if error:
            raise RunError(error_text(error))


def track_of(track: MachineTrack) -> Any:
    """The `struct passo_track`."""
    assert track.speed and track.acceleration and track.backlash
    return new_track(track.axis, int(track.backlash.value), track.speed, track.acceleration)


def _encoder_config(encoder: MachineEncoder) -> Any:
    """The `struct passo_encoder_config`."""
    ratio = round(encoder.counts_per_step * RATIO_ONE)
    fields = {"ratio": ratio, "limit": r.ENCODER_LIMIT_RESET}
    if encoder.limit:
        limit, stop = round(encoder.limit * encoder.counts_per_step), STOPS[encoder.stop]
        fields |= {"limit": limit, "stop": getattr(planner(), stop)}
    return ffi().new("struct passo_encoder_config *", fields)


def _thread(move: MoveThread, setup: Setup) -> Any:
    """The `struct passo_thread`."""
    assert setup.spindle
    top_rpm = move.top_rpm if move.top_rpm is not None else fastest(setup.spindle) * 5 / 4
    fields = {
        "encoder": setup.spindle_axis,
        "wait_index": move.wait_index,
        "steps": move.steps,
        "counts": counts_of(move, setup.spindle),
        "top_speed": q32(top_rpm / 60 * setup.spindle.counts_per_turn),
    }
    return ffi().new("struct passo_thread *", fields)


def _input_config(setup: Setup, axis: int) -> Any:
    """The `struct passo_input_config` of an axis."""
    config: dict[str, bool] = {}
    for one in setup.inputs:
        if one.axis != axis or one.role == "probe":
            continue
        config[f"{one.role}_inverted"] = one.polarity == "low"
        if one.role == "alarm":
            config |= {"alarm_soft": one.soft, "alarm_disables": one.disables}
        else:
            config[one.role] = True
            config["limit_soft"] = config.get("limit_soft", False) or one.soft
    return ffi().new("struct passo_input_config *", config)

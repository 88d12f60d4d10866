# SPDX-License-Identifier: MIT
"""Generate from the pins and parameters of the core: structs in C, a table in Python, benches in Verilog.

Their source is schema/pins.toml.
"""

import sys
import tomllib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from generated import is_check, keep

ROOT = Path(__file__).resolve().parent.parent
SOURCE = "schema/pins.toml"
GENERATED = f"Generated from {SOURCE} by tools/generate_pins.py."
C_TYPES = {"1": "bool", "CHANNELS": "uint8_t"}  # of a width; others have a bit for each axis or more


@dataclass(frozen=True)
class Parameter:
    """A parameter that the host can read back."""

    name: str
    default: int
    text: str


@dataclass(frozen=True)
class Pin:
    """An input or output of passo_spi_top."""

    name: str
    width: str = "1"
    idle: int = 0
    parameter: str = ""
    follows_sclk: bool = False

    @property
    def c_type(self) -> str:
        """Type of its levels."""
        return C_TYPES.get(self.width, "uint64_t")

    @property
    def verilog(self) -> str:
        """Range and name."""
        return self.name if self.width == "1" else f"[{self.width}-1:0] {self.name}"

    @property
    def idle_level(self) -> str:
        """In Verilog, for all bits."""
        return f"1'b{self.idle}" if self.width == "1" else f"{{{self.width}{{1'b{self.idle}}}}}"


@dataclass(frozen=True)
class Source:
    """What the table has."""

    parameters: Sequence[Parameter]
    levels: Sequence[str]
    inputs: Sequence[Pin]
    outputs: Sequence[Pin]  # without MISO

    @classmethod
    def read(cls) -> "Source":
        """Read the table."""
        table = tomllib.loads((ROOT / SOURCE).read_text())
        assert not table.keys() - {"parameter", "level", "input", "output"}
        outputs = [Pin(**pin) for pin in table["output"]]
        assert [pin.name for pin in outputs if pin.follows_sclk] == ["spi_miso"]
        return cls(
            [Parameter(**parameter) for parameter in table["parameter"]],
            [level["name"] for level in table["level"]],
            [Pin(**pin) for pin in table["input"]],
            [pin for pin in outputs if not pin.follows_sclk],
        )


def macro(head: str, parts: Sequence[str], between: str = " ") -> list[str]:
    """A macro of one part per line."""
    lines = [f"#define {head}", *(f"    {part}{between.rstrip()}" for part in parts[:-1]), f"    {parts[-1]}"]
    return [f"{line} \\" for line in lines[:-1]] + [lines[-1], ""]


def write_c(source: Source) -> str:
    """Structs, and macros that do something for each parameter or pin."""
    inputs, outputs = source.inputs, source.outputs
    idle = ", ".join(f".{pin.name} = true" for pin in inputs if pin.idle)
    assert all(pin.width == "1" for pin in inputs if pin.idle)
    lines = [
        "/* SPDX-License-Identifier: MIT",
        " * Parameters and pins of the core, and macros that do something for each of them.",
        " *",
        f" * {GENERATED} */",
        "#ifndef PASSO_PINS_H",
        "#define PASSO_PINS_H",
        "",
        "#include <stdbool.h>",
        "#include <stdint.h>",
        "",
        "struct passo_parameters {",
        *(f"\tuint8_t {parameter.name}; /* {parameter.text} */" for parameter in source.parameters),
        "\t/* initial pin levels, bit channel * AXES + axis */",
        *(f"\tuint64_t {level};" for level in source.levels),
        "};",
        "",
        "/* Input pins, with a bit per axis, channel * AXES + axis, or per channel. Each level of",
        " * spi_sclk must last at least one clock, and spi_cs_n must not change together with it. */",
        "struct passo_inputs {",
        *(f"\t{pin.c_type} {pin.name};" for pin in inputs),
        "};",
        "",
        "/* Output pins. `outputs` has 8 bits per channel. */",
        "struct passo_outputs {",
        *(f"\t{pin.c_type} {pin.name};" for pin in outputs),
        "\tbool spi_miso;",
        "};",
        "",
        "/* Levels of the output pins, except MISO, after a clock; clock 1 is the first one after reset. */",
        "struct passo_pin_event {",
        "\tuint64_t clock;",
        *(f"\tuint64_t {pin.name};" for pin in outputs),
        "};",
        "",
        "enum passo_input {",
        *(f"\tPASSO_INPUT_{pin.name.upper()}," for pin in inputs),
        "\tPASSO_INPUT_COUNT",
        "};",
        "",
        f"#define PASSO_OUTPUT_COUNT {len(outputs)}u",
        "",
        "/* Nothing is connected. */",
        f"#define PASSO_INPUTS_IDLE {{{idle}}}",
        "",
        "/* X(name, Verilog name) */",
        *macro("PASSO_PARAMETERS(X)", [f"X({p.name}, {p.name.upper()})" for p in source.parameters]),
        *macro("PASSO_LEVELS(X)", [f"X({name}, {name.upper()})" for name in source.levels]),
        "/* X(name, type, enumeration) */",
        *macro("PASSO_INPUTS(X)", [f"X({p.name}, {p.c_type}, PASSO_INPUT_{p.name.upper()})" for p in inputs]),
        "/* X(name, type, number), all but MISO */",
        *macro("PASSO_OUTPUTS(X)", [f"X({p.name}, {p.c_type}, {i}u)" for i, p in enumerate(outputs)]),
        *macro("PASSO_SAME_INPUTS(a, b)", same(inputs)),
        *macro("PASSO_SAME_OUTPUTS(a, b)", same(outputs)),
        "#endif",
        "",
    ]
    return "\n".join(lines)


def same(pins: Sequence[Pin]) -> list[str]:
    """A C expression that is true if both structs have the same levels."""
    terms = [f"(a)->{pin.name} == (b)->{pin.name}" for pin in pins]
    return [f"({terms[0]}", *(f"&& {term}" for term in terms[1:-1]), f"&& {terms[-1]})"]


def write_python(source: Source) -> str:
    """The same for Python."""

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


def concatenated(pins: Sequence[str]) -> str:
    """The pins as one vector of 64 bits each, the first in the lowest bits."""
    return ",\n".join(f"  64'd0 | {name}" for name in reversed(pins))


def write_probe(source: Source) -> str:
    """The recorder of the pins, at the end of passo_spi_top."""
    names = [pin.name for pin in source.inputs] + ["spi_miso"] + [pin.name for pin in source.outputs]
    widths = [pin.width for pin in (*source.inputs, *source.outputs)]
    return f"""\
// SPDX-License-Identifier: MIT
// Recorder of the pins of the core. {GENERATED}
//
// Clock 1 is the first rising edge ever without rst. Whenever a pin is not as it was a clock before, a row
// goes to pins.log: the clock; the inputs and MISO as they stand at its rising edge; the other outputs as the
// rising edge before left them. The numbers are decimal; one with an X in it is not a number.

localparam PINS = 1 + {" + ".join(widths)};

wire [PINS-1:0] pins = {{{", ".join(names)}}};
reg  [PINS-1:0] pins_before;
reg             begun = 1'b0;
reg  [    31:0] clock = 0;
integer         file;

initial file = $fopen("pins.log", "w");

always @(posedge clk) begin
  pins_before <= pins;
  if (begun || rst === 1'b0) begin
    begun <= 1'b1;
    clock <= clock + 1;
    if (!begun || pins !== pins_before) begin
      $fwrite(file, "%0d{" %0d" * len(names)}\\n", clock + 1, {", ".join(names)});
      $fflush(file);
    end
  end
end
"""


def write_player(source: Source) -> str:
    """Pins of the soak's player, as variables and as vectors of 64 bits each."""
    inputs, outputs = source.inputs, [*source.outputs, Pin("spi_miso")]
    form = " ".join(f"{pin.name} %h %h" for pin in outputs)
    shown = ", ".join(f"{pin.name}, wanted[{64 * i}+:64]" for i, pin in enumerate(outputs))
    return "\n".join(
        [
            "// SPDX-License-Identifier: MIT",
            f"// Pins of the core as 64 bits each, the first in the lowest bits. {GENERATED}",
            "",
            f"localparam INPUT_COUNT = {len(inputs)};",
            f"localparam OUTPUT_COUNT = {len(outputs)};",
            "",
            *(f"reg {pin.verilog} = {pin.idle_level};" for pin in inputs),
            *(f"wire {pin.verilog};" for pin in outputs),
            "",
            "reg  [64*OUTPUT_COUNT-1:0] wanted;",
            "wire [64*OUTPUT_COUNT-1:0] seen = {",
            concatenated([pin.name for pin in outputs]),
            "};",
            "",
            "task set_inputs(input [64*INPUT_COUNT-1:0] levels);",
            "  begin",
            *(f"    {pin.name} = levels[{64 * i}+:64];" for i, pin in enumerate(inputs)),
            "  end",
            "endtask",
            "",
            "task tell_difference(input [31:0] clock);",
            f'  $display("clock %0d: {form}", clock, {shown});',
            "endtask",
            "",
        ]
    )


OUTPUTS: dict[str, Callable[[Source], str]] = {
    "model/passo_pins.h": write_c,
    "sim/passo/pins.py": write_python,
    "cocotb_tests/probes/passo_spi_top.vh": write_probe,
    "soak/player_pins.vh": write_player,
}


def main() -> int:
    check = is_check(f"Generate what runs the core from {SOURCE}.")
    source = Source.read()
    return keep(ROOT, {name: write(source) for name, write in OUTPUTS.items()}, check)


if __name__ == "__main__":
    sys.exit(main())

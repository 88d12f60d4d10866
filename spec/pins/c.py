# SPDX-License-Identifier: MIT
"""Parameters and pins in C: structs, and macros that do something for each of them."""

from collections.abc import Sequence

from pins.schema import GENERATED, Pin, Source


def macro(head: str, parts: Sequence[str], between: str = " ") -> list[str]:
    """A macro of one part per line."""
    lines = [f"#define {head}", *(f"    {part}{between.rstrip()}" for part in parts[:-1]), f"    {parts[-1]}"]
    return [f"{line} \\" for line in lines[:-1]] + [lines[-1], ""]


def header(source: Source) -> str:
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
        *(f"\tuint{p.bits}_t {p.name}; /* {p.text} */" for p in source.parameters),
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

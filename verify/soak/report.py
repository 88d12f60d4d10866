# SPDX-License-Identifier: MIT
"""What a soak prints, and what it writes to build/soak.json."""

from collections.abc import Sequence
from typing import Any

from passo.console import table

from verify.soak.defects import Catch
from verify.soak.parts import Part, console
from verify.soak.program import KINDS

JUDGED = {
    "steps": "steps",
    "positions": "positions read",
    "paths": "paths made exactly",
    "quiets": "states that said quiet",
    "aborts": "aborts",
    "stops": "stops",
    "gaps": "gaps after a stop",
    "gates": "words that need rest",
    "resets": "resets",
}


MACHINE_JUDGED = {
    "causes": "causes of stops",
    "slews": "slews of soft stops",
    "latches": "positions latched, to the clock",
    "fired": "triggers that fired",
    "tries": "steps tried toward an active switch",
    "levels": "levels longer than the filter",
    "glitches": "glitches that it must ignore",
    "estops": "e-stops",
    "counted": "edges of encoders counted",
    "encoders": "encoder positions read",
    "holds": "holds without power",
    "compares": "compare pulses",
    "words": "changes of the outputs",
}


def events(part: Part) -> int:
    """Disturbances of a part."""
    return sum(count for name, count in part.counts.items() if name.startswith("kind:"))


def show_machine(parts: Sequence[Part], numbers: dict[str, Any]) -> None:
    """Print what was judged of a machine, and the numbers of its path, if they were measured."""
    judged = table("A machine", "what", *(part.name for part in parts))
    judged.add_row("events", *(f"{events(part):,}" for part in parts))
    for key, text in MACHINE_JUDGED.items():
        judged.add_row(text, *(f"{part.counts[key]:,}" for part in parts))
    console.print(judged)
    if not numbers:
        return
    thread, laser, raster = numbers["thread"], numbers["laser"], numbers["raster"]
    bound = table("Bound to the machine", "what", "measured", "ok")
    bound.add_row(
        f"thread: {thread['turns']} turns, spindle +-30 %",
        f"{thread['worst_counts']:.2f} counts from the exact pitch at most, "
        f"{'same' if thread['same_phase'] else 'NOT the same'} phase in every pass",
        "yes" if thread["ok"] else "NO",
    )
    bound.add_row(
        "laser: energy per step, 5 % to 100 %, hold",
        f"within {laser['worst']:.2%}",
        "yes" if laser["ok"] else "NO",
    )
    bound.add_row(
        f"raster: {raster['values']:,} values",
        f"{raster['wrong']} not on their substep",
        "yes" if raster["ok"] else "NO",
    )
    console.print(bound)


def show(parts: Sequence[Part], caught: Sequence[Catch]) -> None:
    """Print the tables."""
    shown = table(
        "Histories", "part", "histories", "clocks", "frames", "aimed", "on the clock", "failed", "s"
    )
    for part in parts:
        counts = part.counts
        aimed = counts["aimed"]
        shown.add_row(
            part.name,
            f"{counts['histories']:,}",
            f"{counts['clocks'] / 1e6:,.0f} M",
            f"{counts['frames']:,}",
            f"{aimed:,}" if aimed else "",
            f"{counts['hit'] / aimed:.0%}" if aimed else "",
            str(len(part.failures)),
            f"{part.seconds:.0f}",
        )
    console.print(shown)
    judged = table("Judged", "what", *(part.name for part in parts))
    for key, text in JUDGED.items():
        judged.add_row(text, *(f"{part.counts[key]:,}" for part in parts))
    console.print(judged)
    wires = [part for part in parts if part.name.startswith("driver")]
    if wires:
        wire = table("The driver's wire", "what", *(part.name for part in wires))
        for key in (
            "retries",
            "flips",
            "lost clocks",
            "doubled clocks",
            "cuts",
            "deaths",
            "moves",
            "lines",
            "errors",
        ):
            wire.add_row(key, *(f"{part.counts[key]:,}" for part in wires))
        console.print(wire)
    if caught:
        made = table("Planted defects", "defect", "caught", "after histories", "s")
        for one in caught:
            made.add_row(
                one.defect.name,
                "yes" if one.good else "NO",
                f"{one.history + 1:,}" if one.history >= 0 else "",
                f"{one.seconds:.0f}",
            )
        console.print(made)


def report(
    seed: int, parts: Sequence[Part], caught: Sequence[Catch], numbers: dict[str, Any]
) -> dict[str, Any]:
    """The contents of soak.json."""
    return {
        "seed": seed,
        "ok": not any(part.failures for part in parts)
        and all(one.good for one in caught)
        and all(number["ok"] for number in numbers.values()),
        "machine": {
            **numbers,
            **{
                part.name: {"events": events(part), **{key: part.counts[key] for key in MACHINE_JUDGED}}
                for part in parts
                if part.name.split()[0] in KINDS
            },
        },
        "parts": {
            part.name: {
                "seconds": round(part.seconds, 1),
                "failed": len(part.failures),
                "failures": [
                    {"history": one.history, "clock": one.clock, "text": one.text, "again": one.again}
                    for one in part.failures
                ],
                **part.counts,
            }
            for part in parts
        },
        "defects": [
            {
                "name": one.defect.name,
                "says": one.defect.says,
                "caught": one.good,
                "seed": seed,
                "histories": one.history + 1,
                "broken": one.says,
            }
            for one in caught
        ],
    }

# SPDX-License-Identifier: MIT
"""The corpus: short programs that have every word in each combination of plane, units and distance mode."""

from collections.abc import Iterator
from itertools import product

PLANES = {"G17": "XYZIJ", "G18": "ZXYKI", "G19": "YZXJK"}
UNITS, DISTANCES = ("G21", "G20"), ("G90", "G91")
FEED = "F100"
# By topic, with a bar between lines; {a} {b} are the axes of the plane, {c} the third one, {i} {j} the words
# of a center. What lines mean depends on the distance mode, and is meant to.
TOPICS = {
    "lines": """
        G0 {a}1 {b}2 {c}3 | G1 {a}-1.5 | {b}.5 {c}+2. | g01{a}2{b}-1 | N8 G1 {c}0 (comment) {a}1 |
        G0 {c}1 | F50 {a}3 | G93 G1 {a}1 {b}1 F2 | {c}2 F4 | G94 F90 G1 {a}0 | G61 {a}1 | G64 {b}1 |
        G64 P0.1 Q0.05 {a}2 | G4 P0.25 | M0 | M1 | G80 | G1 {c}0 | T3
    """,
    "arcs": """
        G0 {a}1 {b}1 | G2 {a}2 {b}2 R2 | G3 {a}1 {b}1 R1.5 | {a}3 {b}-1 {c}1 R-4 |
        G91 G3 {a}0 {b}0 {i}1 {j}0 | G2 {a}1 {b}-1 {j}-1 | G3 {a}1 {b}1 {j}1 {c}.5 | {a}-1 {b}1 {i}-1 |
        G2 {a}1 {b}1 R1 | G2 {a}1 {b}1 R-1 | G3 {a}0.5 {b}0.25 R2 {c}-1 | G91.1 G2 {a}1 {b}1 {i}1 |
        G93 G3 {a}1 {b}1 {j}1 F3 | G94 F100 G1 {a}1
    """,
    "offsets": """
        G10 L2 P1 {a}1 {b}-1 | G0 {a}2 {b}2 {c}2 | G10 L20 P2 {a}.5 {c}1 | G55 G0 {a}1 | G10 L2 P0 {b}2 |
        G1 {b}1 | G92 {a}3 {c}-1 | G1 {a}1 {c}1 | G92.1 | G1 {a}2 | G54 G1 {b}2 | G43.1 Z.5 | G1 {c}1 |
        G49 | G1 {b}1 | G28.1 | G0 {a}3 | G30.1 | G28 {a}1 | G30 {b}1 {c}1 | G28 | G59 G0 {a}1 | G40 |
        G91 G28 {c}0
    """,
    "cycles": """
        G0 {a}0 {b}0 {c}3 | M3 S100 G98 G81 {a}1 {b}1 {c}-1 R1 | {a}2 | G82 {b}2 {c}-1.5 R1 P.1 | {a}1 L2 |
        G80 | G0 {c}1 | G99 G85 {a}1 {b}1 {c}-1 R.5 | {a}2 | G89 {b}2 {c}-.5 R.5 P.2 |
        G73 {a}1 {c}-1 R.5 Q1 | G80 | G0 {c}1 |
        G83 {b}1 {c}-1 R.5 Q2 | G80 | G98 G86 {a}3 {c}-1 R.5 P.1 | G80 | G0 {c}3
    """,
    "outputs": """
        M3 S500 G1 {a}1 | M8 {b}1 | M7 | {c}1 | S250 M4 {a}2 | M9 {b}2 | M5 G4 P.5 | S800 | M3 {a}0 |
        M62 P1 {a}1 | M64 P0 | {b}1 | M63 P1 {a}2 | M62 P3 | M65 P0 {b}2 | M5 |
        M67 E0 Q50 {a}1 | {b}1 |
        M68 E0 Q12.5 | {a}2 | G3 {a}1 {b}1 R5 M67 E0 Q3 | M66 P2 L0 | M66 P1 L4 Q1 G1 {a}0 |
        M68 E0 Q0 {b}0 | M30
    """,
    "tools": """
        G10 L1 P3 Z.5 | T3 M6 | G43 G0 {c}1 | {a}1 | T4 | G43.1 Z.25 | G1 {b}1 | G43.2 H3 | {a}2 {c}2 | G49 |
        {b}2 | M61 Q4 | G43 H3 G0 {a}0 | {c}3 | M6 | G49 | G1 {a}1 {c}1 | G90 G53 {a}1 {c}.5 | M2
    """,
    "probes": """
        G1 {a}1 {c}2 | G38.2 {c}-1 | G1 {a}2 | F30 G38.3 {b}3 | G1 {c}1 | G38.4 {c}2 | G0 {a}4 |
        G38.5 {a}3 {b}2 | G61.1 G1 {b}1 | {a}1 | G64 P.1 {b}2 | G91 G1 {c}1
    """,
    "axes": """
        G0 A90 {a}1 | G1 {b}1 B-45 C10.5 | {a}2 A-30 | G2 {a}1 {b}1 R4 A15 C20 | G3 {a}2 {b}2 {c}1 R3 B1 |
        G10 L2 P3 A10 B-5 | G56 G0 {a}1 A0 | G57 B5 {b}1 | G58 C1 {c}1 | G10 L20 P4 C2 | G57 G1 {a}1 C3 |
        G92 A1 | G1 {a}3 A2 | G92.1 | G93 G1 {b}3 F4 | G94 F50 | G28.1 | G0 {a}9 A9 | G28 A1 |
        G91 G1 A5 {a}1 | G90 G53 G0 C1 {c}1
    """,
    "lathe": """
        G7 G0 {a}1 {b}2 {c}3 | G1 X4 | G92 X2 | X3 | G92.1 | G10 L2 P1 X1 | X2 | G10 L2 P1 X0 |
        G2 {a}1 {b}1 R5 | G8 G1 X1 | M3 S500 | G95 F.1 G1 {a}2 | {b}1 | S300 {a}1 | G3 {a}2 {b}2 R4 |
        G94 F80 G1 {a}0 | G7 | M4 G96 S10 D400 | G0 X3 | X-1 | {a}2 {b}3 | G97 S200 | G1 {c}2 | X3 | G8 | X1 |
        G33 {c}-1 K.5 | {c}0 K.25 | G33.1 {a}3 {c}-2 K2 | G0 {a}1 | G93 G33 {b}3 K1 | G94 F50 G1 {b}1
    """,
    "values": """
        #1=1 #2=[#1+1] | #3=[#2*3 mod 4] | G1 {a}#1 {b}[#2/4] {c}-#3 | #<width>=2.5 #<_all>=[2**3/4] |
        {a}[#<width>-#<_all>] {b}sin[30] {c}atan[1]/[2] | #1=4 {a}#1 #1=5 | G[0+1] {a}[#1/10] |
        F[20*3] {b}#[1+1] | #[#2+10]=7 {a}[#12/10] | {b}[exists[#<width>]+exists[#<none>]] |
        {a}round[2.5] {b}fix[-1.5] {c}fup[1.2] |
        {a}[1 lt 2 and 3 ge 3] {b}[2 eq 2.00001] {c}[1 xor 1 or 0] |
        {a}acos[.5] {b}[sqrt[16]-ln[exp[2]]] {c}abs[-1] | {a}--1 {b}+-.5
    """,
    "flow": """
        o100 sub | G1 {a}#1 {b}[#2/2] | #1=9 | o101 if [#2 gt 2] | o100 return [#2*2] | o101 endif |
        {c}#1 | o100 endsub [-1] | G1 {a}1 | o100 call [1] [2] | {c}#<_value> | o100 call [1.5] [3] |
        {c}#<_value> | #5=0 | o102 while [#5 lt 3] | #5=[#5+1] | o103 if [#5 eq 2] | {a}2 |
        o103 elseif [#5 eq 3] | {b}2 | o103 else | {c}2 | o103 endif | o102 endwhile | o104 repeat [2] |
        {a}#5 #5=[#5-1] | o104 endrepeat | o<last> do | #5=[#5+1] | {b}#5 | o<last> while [#5 le 4] |
        o105 while [1] | #5=[#5-1] | o106 if [#5 lt 0] | o105 break | o106 endif | o105 endwhile |
        {a}#5
    """,
    "state": """
        G0 {a}1 {b}2 {c}3 | #10=#5420 #11=#5421 #12=#5422 | G1 {a}[#10/2] {b}[#11/2] {c}[#12/2] |
        {a}[#<_x>+#<_y>] {b}[#<_metric>+2*#<_absolute>] {c}[#<_plane>/100] |
        {a}[#<_feed>/100] {b}[#5220+1] | G55 {a}[#<_coord_system>/100] {c}[#<_motion_mode>/5] |
        S300 M3 {a}[#<_spindle_on>+#<_rpm>/100] {b}#<_spindle_cw> |
        {b}[#<_call_level>+1] {c}[#<_inverse_time>+#<_units_per_minute>+1] | M8 {c}[1+#<_flood>] |
        {a}[#<_mist>+.5] | #13=[#<_imperial>+#<_incremental>*2] {a}[1+#13] {b}[#<_line>/10] |
        {a}[#5400+1] {c}[#<_ccomp>/400] |
        M66 P3 L0 | {a}[#5399+2] | M66 P0 L4 Q.5 | {b}[#5399+3]
    """,
}
# Compensation is for two of the planes. Distances are increments.
CONTOURS = {
    "left": """
        G91 G41.1 D.2 | G1 {a}1 | {a}2 | {b}2 | {a}-1 {b}1 | G3 {a}-1 {b}-1 {j}-1 | G1 {b}-2 | G40 |
        {a}-1 {b}-1
    """,
    "right": """
        G91 G42.1 D.3 | G1 {a}1 {b}1 | G2 {a}1 {b}1 {i}1 | G1 {a}2 | {b}-2 {c}1 | G1 {c}-1 | {a}1 |
        G40 G0 {b}2
    """,
    "table": """
        G91 G42 D4 | G1 {a}1 | {b}2 | G40 | {a}1 | G41 D5 G1 {b}2 | {a}-2 | G40 G1 {b}1
    """,
    "timed": """
        G91 G93 G41.1 D.2 | G1 {a}1 F5 | {b}-2 F3 | G2 {a}1 {b}-1 {j}-1 F2 | G1 {b}-1 F6 | G40 {a}1 F9
    """,
}


def corpus() -> Iterator[tuple[str, list[str]]]:
    """Name and lines of each program."""
    for plane, units, distance in product(PLANES, UNITS, DISTANCES):
        words = dict(zip("abcij", PLANES[plane], strict=True))
        for topic, lines in TOPICS.items():
            head = [f"{units} {distance} {plane}", FEED, "G1 X0 Y0 Z0"]
            yield f"{topic} {plane} {units} {distance}", [*head, *_lines(lines.format(**words))]


def contours() -> Iterator[tuple[str, list[str]]]:
    """The same for those with compensation."""
    for plane, units in product(("G17", "G18"), UNITS):
        words = dict(zip("abcij", PLANES[plane], strict=True))
        for topic, lines in CONTOURS.items():
            head = [f"{units} G90 {plane}", FEED, "G0 X0 Y0 Z0"]
            yield f"{topic} {plane} {units}", [*head, *_lines(lines.format(**words))]


def _lines(text: str) -> list[str]:
    return [line.strip() for line in text.split("|")]

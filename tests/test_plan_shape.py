# SPDX-License-Identifier: MIT
"""`passo shape`: tables from formulas and files, and invalid shapes."""

import math
import tomllib
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path

import pytest
from passo import cli, shape
from passo.formula import formula
from passo.native import ffi, planner
from passo.shape import ShapeError, check, read_table, sample, table_text, write_table


def test_formulas() -> None:
    for text, function in {
        "u": lambda u: u,
        "u^2 * (3 - 2 * u)": lambda u: u * u * (3 - 2 * u),
        "(1 - cos(pi * u)) / 2": lambda u: (1 - math.cos(math.pi * u)) / 2,
        "-e**(-3*u)": lambda u: -math.exp(-3 * u),
        "max(0, min(1, 2*u - 0.5))": lambda u: max(0, min(1, 2 * u - 0.5)),
    }.items():
        made = formula(text)
        assert all(abs(made(k / 64) - function(k / 64)) < 1e-12 for k in range(65)), text


@pytest.mark.parametrize(
    "text",
    [
        "",
        "u u",
        "x",
        "__import__('os')",
        "u.real",
        "u if u else 1",
        "[u]",
        "'u'",
        "True",
        "sin",
        "sin()",
        "open(u)",
        "(lambda: u)()",
        "u < 1",
        "sin(u, x=1)",
        "max(*u)",
        "1" * 501,
        "(" * 400,
        "\0",
    ],
)
def test_what_is_no_formula(text: str) -> None:
    with pytest.raises(ShapeError) as caught:
        sample(formula(text))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "text", ["1/u", "log(u)", "sqrt(u - 1)", "9**9**9**9", "(0-u)**0.5", "exp(9999 * u)"]
)
def test_formulas_without_a_value(text: str) -> None:
    with pytest.raises(ShapeError, match="no value at u"):
        sample(formula(text))


def test_tables_are_scaled_and_checked() -> None:
    assert sample(formula("7 + 3 * u")) == tuple(256 * k for k in range(256))
    assert sample(formula("min(1, 2 * u)"))[200] == 65535
    for text, reason in {
        "1 - u": "must rise",
        "3": "must rise",
        "u + 0.1 * sin(4 * pi * u)": "must not decrease",
    }.items():
        with pytest.raises(ShapeError, match=reason):
            sample(formula(text))
    with pytest.raises(ShapeError, match="256 points, not 3"):
        check([0, 1, 2])
    with pytest.raises(ShapeError, match="point 9 is 65536"):
        check([0] * 9 + [65536] * 247)
    with pytest.raises(ShapeError, match="start at 0, not at 1"):
        check([1] * 256)


@pytest.mark.parametrize(
    ("text", "area"),
    [
        ("u^3", lambda u: u**4 / 4),
        ("u^7", lambda u: u**8 / 8),
        ("u^2 * (3 - 2 * u)", lambda u: u**3 - u**4 / 2),
        ("6*u^5 - 15*u^4 + 10*u^3", lambda u: u**6 - 3 * u**5 + 5 * u**4 / 2),
    ],
)
def test_area_follows_the_curve(text: str, area: Callable[[float], float]) -> None:
    """What a ramp has traveled at each point; points rounded each by itself are 21 to 149 off."""
    points, shape_at = sample(formula(text)), formula(text)
    total = 0
    for k, point in enumerate(points):
        assert abs(point - shape_at(k / 256) * 65536) <= 4
        assert abs(total + point / 2 - area(k / 256) * 256 * 65536) <= 9
        total += point


def test_facts_are_those_of_the_planner() -> None:
    facts = ffi().new("struct passo_table_facts *")
    for text in ("u", "u^3", "u^2 * (3 - 2 * u)", "sqrt(u)"):
        points = sample(formula(text))
        assert planner().passo_table_check(points, facts) == 0
        assert check(points) == shape.Facts(Fraction(facts.mean, 1 << 24), facts.symmetric)


def test_files(tmp_path: Path) -> None:
    points = sample(formula("u^3"))
    write_table(points, tmp_path / "t.csv")
    assert read_table(tmp_path / "t.csv") == points
    write_table(points, tmp_path / "t.toml")
    data = tomllib.loads((tmp_path / "t.toml").read_text())
    assert tuple(data["points"]) == points and Fraction(data["mean"], 1 << 24) == check(points).mean
    (tmp_path / "curve.csv").write_text("u,s\n0,0\n0.25,0.5\n1,1\n")
    curve = read_table(tmp_path / "curve.csv")
    assert (curve[32], curve[64], curve[160]) == (16384, 32768, 49152)
    with (tmp_path / "t.csv").open("a") as file:
        file.write("256,65536\n")  # the point that is always there may be
    assert read_table(tmp_path / "t.csv") == points


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "first line must be"),
        ("a,b\n1,2\n", "first line must be"),
        ("k,point\n0,0\n1,1\n", "points 0 to 255"),
        ("k,point\n0,0,0\n", "must have two numbers"),
        ("k,point\n0,zero\n", "must have two numbers"),
        ("u,s\n", "must have two numbers"),
        ("u,s\n0,0\n", "u must rise strictly from 0 to 1"),
        ("u,s\n0,0\n0.5,1\n", "u must rise strictly from 0 to 1"),
        ("u,s\n0,0\n1,1\n0.5,1\n", "u must rise strictly from 0 to 1"),
        ("u,s\n0,nan\n1,1\n", "finite"),
        ("u,s\n0,0\n0.5,1\n0.7,0.5\n1,1\n", "not decrease"),
    ],
)
def test_bad_files(tmp_path: Path, text: str, reason: str) -> None:
    path = tmp_path / "bad.csv"
    path.write_text(text)
    with pytest.raises(ShapeError, match=reason) as caught:
        read_table(path)
    assert str(caught.value).startswith(str(path))


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out, picture = tmp_path / "t.csv", tmp_path / "t.png"
    assert cli.main(["shape", "--formula", "u^2*(3-2*u)", "--out", str(out), "--plot", str(picture)]) == 0
    assert "mean 0.500000, symmetric, slope at most 1.500" in capsys.readouterr().out
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert cli.main(["shape", "--csv", str(out)]) == 0
    for arguments in (["--formula", "1 - u"], ["--csv", str(tmp_path / "none.csv")]):
        assert cli.main(["shape", *arguments]) == 2
    assert cli.main(["shape", "--formula", "u", "--out", str(tmp_path / "no" / "t.csv")]) == 2
    assert capsys.readouterr().err.count("\n") == 3
    for empty in ("", " "):
        assert cli.main(["shape", "--formula", empty]) == 2
        assert capsys.readouterr().err == "the formula is empty\n"


@pytest.mark.parametrize("ends", ["\n", "\r\n"])
def test_a_file_of_a_spreadsheet(tmp_path: Path, ends: str) -> None:
    """It begins with a byte order mark."""
    for text in ("u,s\n0,0\n1,1\n", table_text(sample(lambda u: u))):
        for encoding in ("utf-8", "utf-8-sig"):
            (tmp_path / "t.csv").write_text(text, encoding=encoding, newline=ends)
            assert read_table(tmp_path / "t.csv") == sample(lambda u: u)

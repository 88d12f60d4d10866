# SPDX-License-Identifier: MIT
"""tools/stack_usage.py, on disassembly as objdump writes it."""

import sys

import pytest
from passo.toolchain import paths

sys.path.insert(0, str(paths.tools))
import stack_usage
from stack_usage import Function, StackError, connect, deepest

LISTING = """
08000100 <start>:
 8000100:\tpush\t{r4, lr}
 8000102:\tsub\tsp, #8
 8000104:\tbl\t8000120 <middle>
 8000108:\tbne.n\t8000102 <start+0x2>
 800010a:\tpop\t{r4, pc}

08000120 <middle>:
 8000120:\tstmdb\tsp!, {r4, r5, r6, r7, r8, lr}
 8000124:\tsub.w\tsp, sp, #736\t@ 0x2e0
 8000128:\tblx\tr3
 800012a:\tb.w\t8000140 <leaf.constprop.0>

08000140 <leaf.constprop.0>:
 8000140:\tstr.w\tr7, [sp, #-16]!
 8000144:\tbx\tlr

08000160 <hook>:
 8000160:\tpush\t{r0, r1, r2, r3}
 8000162:\tbx\tlr
"""


def functions(
    monkeypatch: pytest.MonkeyPatch, listing: str = LISTING, caller: str = "??"
) -> dict[int, Function]:
    """With the name that the debug information has for each indirect call."""

    def run(*command: str) -> str:
        if not command[0].endswith("addr2line"):
            return listing
        return "".join(f"{site}\n{caller}\nfile.c:1\n" for site in command if site.startswith("0x"))

    monkeypatch.setattr(stack_usage, "_run", run)
    return stack_usage.disassemble(paths.build, "")


def test_frames_and_paths_add_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pushes, subtractions and stores that move the stack pointer; calls, tail calls, calls by pointer."""
    found = functions(monkeypatch)
    by_name = connect(found, {"middle": ["hook"]})
    assert {f.name: f.frame for f in found.values()} == {"start": 16, "middle": 760, "leaf": 16, "hook": 16}
    depth, path = deepest(found, by_name["start"][0])
    assert depth == 16 + 760 + 16
    assert path[:2] == ["start 16", "middle 760"]


def test_a_call_by_pointer_must_be_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """Rejects an unlisted indirect call, an unknown target, and a listed function without indirect calls."""
    for calls in ({}, {"middle": ["nobody"]}, {"middle": ["hook"], "hook": ["leaf"]}):
        with pytest.raises(StackError):
            connect(functions(monkeypatch), calls)


def test_a_call_by_pointer_belongs_to_the_function_that_was_inlined(monkeypatch: pytest.MonkeyPatch) -> None:
    """As link-time optimization does it: the list has the name of the source."""
    found = functions(monkeypatch, caller="within.part.0")
    stack_usage.name_callers(found, paths.build, "")
    assert list(found[0x8000120].pointers.values()) == [["within", "middle"]]
    connect(found, {"within": ["hook"]})
    assert 0x8000160 in found[0x8000120].calls
    with pytest.raises(StackError, match="within makes an indirect call"):
        connect(found, {"other": ["hook"]})


def test_recursion_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """The depth would be unbounded."""
    found = functions(monkeypatch)
    by_name = connect(found, {"middle": ["start"]})
    with pytest.raises(StackError, match="recursion: start -> middle -> start"):
        deepest(found, by_name["start"][0])


@pytest.mark.parametrize("line", ["sub.w\tsp, sp, r3", "mov\tsp, r3", "add\tsp, r4"])
def test_what_is_not_understood_is_an_error(monkeypatch: pytest.MonkeyPatch, line: str) -> None:
    """A stack pointer that is changed by a register."""
    with pytest.raises(StackError):
        functions(monkeypatch, LISTING.replace("sub\tsp, #8", line))


def test_a_function_that_became_part_of_another_keeps_its_name(monkeypatch: pytest.MonkeyPatch) -> None:
    """Link-time optimization makes functions parts of others: the innermost one that is listed counts."""
    found = functions(monkeypatch)
    where = "0x08000128\ninner.lto_priv.0\nfile.c:1\nouter\nfile.c:2\nmiddle\nfile.c:3\n"
    monkeypatch.setattr(stack_usage, "_run", lambda *command: where)
    stack_usage.name_callers(found, paths.build, "")
    for calls in ({"inner": ["hook"]}, {"outer": ["hook"]}, {"middle": ["hook"]}):
        connect(found, calls)
    with pytest.raises(StackError, match="listed but without indirect calls: outer"):
        connect(found, {"inner": ["hook"], "outer": ["leaf"]})
    with pytest.raises(StackError, match="inner makes an indirect call but is not listed"):
        connect(found, {"start": ["hook"]})

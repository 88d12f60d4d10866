# SPDX-License-Identifier: MIT
"""Pages of the C interface: headers of driver, planner and Linux host, read by Doxygen, as Markdown.

Comments of the headers are plain ones. A copy marks them for Doxygen: at the top of a file, above what they
describe, and behind a member. A declaration directly below a described one shares its description, as in the
header. Members below `private` are left out.
"""

import re
import shutil
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from passo.failure import Failure
from passo.toolchain import paths

NOT_FOR_USERS = (
    "passo_math.h",
    "passo_path_state.h",
    "passo_strings.h",
)  # beside those that begin with "Internal:"
SPDX = "/* SPDX-License-Identifier: MIT\n"
RULE = re.compile(r"^/\* -{8,}.*\*/\n", re.M)
HEADING = re.compile(r"^\t/\* (?:for users to read|private|Private)\b[^\n]*\*/\n", re.M)
PRIVATE = re.compile(r"^\t/\* [Pp]rivate[^\n]*\*/\n(.*?)^\};", re.M | re.S)
ERROR_NAMES = re.compile(r"\b[A-Z][A-Z_]+\b")
ERROR = "PASSO_ERROR_"
AS_IT_IS = "\0"  # before what gets no links
SHOWN = 4  # names in a heading
CODE_MAX = 110  # characters of a macro that is shown with its value
DOXYFILE = """
INPUT = .
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
XML_PROGRAMLISTING = NO
OPTIMIZE_OUTPUT_FOR_C = YES
MACRO_EXPANSION = NO
EXTRACT_ALL = YES
SORT_MEMBER_DOCS = NO
QUIET = YES
WARN_IF_UNDOCUMENTED = NO
WARN_NO_PARAMDOC = NO
WARN_AS_ERROR = FAIL_ON_WARNINGS
"""


def headers() -> list[Path]:
    """Those of the interface."""
    found = [file for folder in (paths.driver, paths.linux, paths.planner) for file in folder.glob("*.h")]
    return sorted(
        file
        for file in found
        if file.name not in NOT_FOR_USERS and " * Internal:" not in file.read_text("utf-8")[:200]
    )


def marked(text: str) -> str:
    """A header with its comments marked for Doxygen."""
    text = text.replace(SPDX, "/** @file\n", 1)
    text = RULE.sub("\n", text)  # lines keep their numbers
    text = PRIVATE.sub(lambda found: f"/// @cond\n{found[1]}/** @endcond */ }};", text)
    text = HEADING.sub("\n", text)
    return re.sub(r"^([^\n]*?)/\* ", _mark, text, flags=re.M)


def _mark(found: re.Match[str]) -> str:
    return f"{found[1]}/**< " if found[1].strip() else f"{found[1]}/** "


Rows = list[tuple[str, str]]  # members or values, and what they are
NAME = re.compile(r"\b(?:passo|PASSO)_\w+(?:\.h)?\b")
CODE = re.compile(r"(```.*?```|`[^`]*`)", re.S)
DOCUMENT = re.compile(r"\b(docs/\w+\.md)\b")


@dataclass
class Entry:
    """A function, a type or a macro; or several that share a description."""

    names: list[str]
    line: int  # of the header, and its last one
    end: int
    text: str = ""
    code: list[str] = field(default_factory=list)  # declarations of functions and macros
    tables: dict[str, Rows] = field(default_factory=dict)  # by the name of a type
    is_shared: bool = True  # its description is above it

    @property
    def is_described(self) -> bool:
        """By a comment of its own, or by those of its members."""
        return bool(self.text or any(text for rows in self.tables.values() for _, text in rows))

    def join(self, other: "Entry") -> None:
        """Describe the one below as well."""
        self.names += other.names
        self.code += other.code
        self.tables |= other.tables
        self.end = other.end


class Interface:
    """The entries of all headers."""

    def __init__(self, folder: Path):
        """Doxygen works in `folder`."""
        self.files = headers()
        self._xml = folder / "xml"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        for file in self.files:
            (folder / file.name).write_text(marked(file.read_text("utf-8")), encoding="utf-8")
        (folder / "Doxyfile").write_text(DOXYFILE, encoding="utf-8")
        done = subprocess.run(["doxygen"], cwd=folder, capture_output=True, text=True)
        if done.returncode:
            raise Failure(f"Doxygen: {done.stderr.strip()}")

    def _tree(self, refid: str) -> Element:
        found = ElementTree.parse(self._xml / f"{refid}.xml").getroot().find("compounddef")
        assert found is not None
        return found

    @cached_property
    def _compounds(self) -> dict[str, Element]:
        """By the name of the file."""
        index = ElementTree.parse(self._xml / "index.xml").getroot()
        found = {}
        for compound in index.iter("compound"):
            if compound.get("kind") == "file":
                found[compound.findtext("name", "")] = self._tree(compound.get("refid", ""))
        return found

    @cached_property
    def entries(self) -> dict[str, list[Entry]]:
        """Of each header, in its order."""
        return {file.name: self._joined(file) for file in self.files}

    @cached_property
    def places(self) -> dict[str, str]:
        """The page, and the anchor, of each name; of files as well."""
        found = {}
        for file, entries in self.entries.items():
            found[file] = f"{file}.md"
            for entry in entries:
                values = [
                    row[0] for rows in entry.tables.values() for row in rows if row[0].startswith("PASSO_")
                ]
                found |= {name: f"{file}.md#{entry.names[0].lower()}" for name in (*entry.names, *values)}
        return found

    def undescribed(self) -> list[str]:
        """Functions and types that no comment describes."""
        entries = [entry for found in self.entries.values() for entry in found]
        return [name for entry in entries if not entry.is_described for name in entry.names]

    def _joined(self, file: Path) -> list[Entry]:
        """One directly below another one, without a comment of its own, shares its description."""
        lines, found = file.read_text("utf-8").split("\n"), list[Entry]()
        compound = self._compounds[file.name]
        all_of_it = [self._struct(self._tree(one.get("refid", ""))) for one in compound.iter("innerclass")]
        all_of_it += [_member(member) for member in compound.iter("memberdef")]
        for entry in sorted((one for one in all_of_it if one), key=lambda one: one.line):
            above = lines[entry.line - 2].rstrip().endswith("*/")
            entry.is_shared = above or "/*" not in lines[entry.line - 1] or bool(entry.tables)
            before = found[-1] if found else None
            between = lines[before.end : entry.line - 1] if before else [""]
            if before and before.is_shared and not entry.text and all(line.strip() for line in between):
                before.join(entry)
            else:
                found.append(entry)
        return found

    def _struct(self, tree: Element) -> Entry | None:
        name = tree.findtext("compoundname", "")
        if "." in name:
            return None  # inside another one, which names it
        line, end = _lines_of(tree)
        rows: Rows = []
        before = 0
        for member in tree.iter("memberdef"):
            at, _ = _lines_of(member)
            text = describe(member)
            if at == before and rows and not rows[-1][1]:  # int a, b; /* what both are */
                rows[-1] = (rows[-1][0], text)
            rows.append((_field(member), text))
            before = at
        return Entry([name], line, end, describe(tree), tables={f"struct {name}": rows})

    def page(self, file: Path, source: str, documents: str) -> str:
        """Markdown of a header; `source`: link to the page of its source; `documents`: to the top folder."""
        lines = [f"# {file.name}", "", f"[Source]({source})", "", describe(self._compounds[file.name])]
        for entry in self.entries[file.name]:
            lines += self._section(entry)
        made = [
            part if number % 2 else self._linked(part, file.name, documents)
            for number, part in enumerate(CODE.split("\n".join(lines)))
        ]
        return "".join(made) + "\n"

    def _section(self, entry: Entry) -> Iterator[str]:
        first, *others = entry.names
        shown = ", ".join(entry.names[:SHOWN]) + (", ..." if len(entry.names) > SHOWN else "")
        yield f"\n## {AS_IT_IS}{shown} {{ #{first.lower()} }}\n"
        if others:
            yield "".join(f'<a id="{AS_IT_IS}{name.lower()}"></a>' for name in others) + "\n"
        if entry.code:
            yield "```c\n" + "\n".join(entry.code) + "\n```\n"
        yield entry.text
        for name, rows in entry.tables.items():
            yield f"\n| `{name}` | |\n|---|---|"
            yield from (f"| `{member}` | {' '.join(text.split())} |" for member, text in rows)

    def _linked(self, text: str, file: str, documents: str) -> str:
        """Names that have an entry, those of errors behind "Error:", and documents become links."""

        def link(shown: str, name: str = "") -> str:
            place = self.places.get(name or shown, "").removeprefix(f"{file}.md")
            return f"[{shown}]({place})" if place else shown

        found = []
        for line in text.split("\n"):
            if not line.startswith((f"## {AS_IT_IS}", "<a id")):
                line = NAME.sub(lambda one: link(one[0]), line)
                line = DOCUMENT.sub(rf"[\1]({documents}/\1)", line)
                before, errors, after = line.partition("Error")
                line = before + errors + ERROR_NAMES.sub(lambda one: link(one[0], ERROR + one[0]), after)
            found.append(line.replace(AS_IT_IS, ""))
        return "\n".join(found)


def _lines_of(element: Element) -> tuple[int, int]:
    location = element.find("location")
    assert location is not None
    line = int(location.get("line", "0"))
    return line, max(line, int(location.get("bodyend", "0")))


def _field(member: Element) -> str:
    kind, name = _plain(member.find("type")), member.findtext("name", "")
    gap = "" if kind.endswith("*") else " "
    return f"{kind}{gap}{name}{member.findtext('argsstring', '')}"


def _member(member: Element) -> Entry | None:
    kind, name, (line, end) = member.get("kind", ""), member.findtext("name", ""), _lines_of(member)
    text = describe(member)
    if kind == "function":
        code = f"{member.findtext('definition', '')}{member.findtext('argsstring', '')};"
        return Entry([name], line, end, text, [code])
    if kind == "enum":
        values = [(one.findtext("name", ""), describe(one)) for one in member.iter("enumvalue")]
        return Entry([name], line, end, text, tables={f"enum {name}": values})
    if kind == "define" and not name.endswith("_H"):
        parameters = [one.findtext("defname", "") for one in member.iter("param")]
        call = f"({', '.join(parameters)})" if parameters else ""
        code = f"#define {name}{call} {_plain(member.find('initializer'))}".strip()
        return Entry([name], line, end, text, [code if len(code) < CODE_MAX else f"#define {name}{call}"])
    return None


def _plain(element: Element | None) -> str:
    return "" if element is None else " ".join("".join(element.itertext()).split())


def describe(element: Element) -> str:
    """The description of an element as Markdown."""
    parts = [element.find(f"{kind}description") for kind in ("brief", "detailed")]
    return "\n\n".join(text for part in parts if part is not None if (text := _blocks(part).strip()))


def _blocks(element: Element) -> str:
    found = [_inline(child).strip("\n") for child in element]
    return "\n\n".join(text for text in found if text.strip())


def _inline(element: Element) -> str:
    inner = _escape(element.text) + "".join(_inline(child) + _escape(child.tail) for child in element)
    match element.tag:
        case "para" | "listitem":
            return inner
        case "ref":
            return "".join(element.itertext())
        case "computeroutput":
            return f"`{''.join(element.itertext())}`"
        case "emphasis":
            return f"*{inner}*"
        case "sp":
            return " "
        case "ulink":
            return f"[{inner}]({element.get('url')})"
        case "programlisting" | "verbatim" | "preformatted":
            return "\n\n```c\n" + _code(element) + "\n```\n\n"
        case "itemizedlist" | "orderedlist":
            return "\n\n" + "\n".join(f"* {_blocks(child)}" for child in element) + "\n\n"
        case "nonbreakablespace" | "linebreak":
            return " "
        case "ndash" | "mdash":
            return " -- "
    raise Failure(f"Doxygen: <{element.tag}> is not known to tools/c_api.py")


def _code(element: Element) -> str:
    lines = list(element.iter("codeline"))
    if not lines:
        return "".join(element.itertext()).strip("\n")
    for space in element.iter("sp"):
        space.text = " "
    return "\n".join("".join(line.itertext()) for line in lines)


def _escape(text: str | None) -> str:
    return re.sub(r"([*<|\[\]])", r"\\\1", text or "")

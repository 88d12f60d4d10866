# SPDX-License-Identifier: MIT
"""Mutants of C sources: all of a file in one copy of it, each behind `passo_at(NUMBER)`.

A copy is the preprocessed source, from its syntax tree, so it needs no headers. What a program of such
copies does is chosen by the environment: PASSO_MUTANT is the number of the mutant, none for the sources as
they are; PASSO_REACHED is a file with a byte for each number, which is set when its place is reached. A
library that is loaded already looks again in a process that is forked.
"""

import copy
from collections.abc import Callable, Collection
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from passo.compiler import CC, call, includes
from passo.toolchain import paths
from pycparser import c_ast, c_generator, c_parser

HEADERS = paths.root / "verify/equal/headers"

# What the headers for proofs do not have.
MACROS = {
    "NULL": "((void *)0)",
    **{f"INT{bits}_MAX": f"{2 ** (bits - 1) - 1}" for bits in (8, 16, 32)},
    **{f"INT{bits}_MIN": f"(-{2 ** (bits - 1) - 1} - 1)" for bits in (8, 16, 32)},
    **{f"UINT{bits}_MAX": f"{2**bits - 1}" for bits in (8, 16)},
    "INT64_MAX": f"{2**63 - 1}L",
    "INT64_MIN": f"(-{2**63 - 1}L - 1)",
    **{f"INT{bits}_C(value)": "value" for bits in (8, 16, 32)},
    "SIZE_MAX": f"{2**64 - 1}UL",
}

# In each folder, as programs take some of them.
CHOICE = """
#include <fcntl.h>
#include <pthread.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
__attribute__((weak)) int passo_mutant;
__attribute__((weak)) unsigned char *passo_reached;
__attribute__((weak)) void passo_choose_mutant(void)
{
	const char *number = getenv("PASSO_MUTANT"), *reached = getenv("PASSO_REACHED");
	struct stat found;

	passo_mutant = number ? atoi(number) : 0;
	if (reached && stat(reached, &found) == 0) {
		const int file = open(reached, O_RDWR);

		passo_reached = mmap(0, (size_t)found.st_size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
		close(file);
	}
}
__attribute__((weak, constructor)) void passo_choose_now_and_in_copies(void)
{
	passo_choose_mutant();
	pthread_atfork(0, 0, passo_choose_mutant);
}
"""
# What its headers would define.
OFFSETOF = "#define offsetof(type, member) __builtin_offsetof(type, member)\n"
DECLARED = """
extern int passo_mutant;
extern unsigned char *passo_reached;
static inline int passo_at(int number)
{
	if (passo_reached)
		passo_reached[number] = 1;
	return number == passo_mutant;
}
"""

SWAPS = {
    **{
        "+": "-",
        "-": "+",
        "*": "+",
        "/": "*",
        "%": "*",
        "<<": ">>",
        ">>": "<<",
        "&": "|",
        "|": "&",
        "^": "|",
    },
    **{"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "&&": "||", "||": "&&"},
}
ASSIGNED = {
    "+=": "-=",
    "-=": "+=",
    "|=": "&=",
    "&=": "|=",
    "<<=": ">>=",
    ">>=": "<<=",
    "*=": "+=",
    "/=": "*=",
}


@dataclass(frozen=True)
class Change:
    """What a mutant changes."""

    file: str
    line: int
    function: str
    kind: str
    text: str


def preprocessed(source: Path, folders: Collection[Path]) -> str:
    """A source with all that it includes."""
    macros = [f"-D{name}={value}" for name, value in MACROS.items()]
    flags = ["-E", "-nostdinc", "-D__attribute__(x)=", *macros, *includes(HEADERS, source.parent, *folders)]
    return call([CC, *flags, source])


def _text(node: c_ast.Node) -> str:
    return " ".join(c_generator.CGenerator().visit(node).split())


def _as_it_is(visited: Any) -> Any:
    return visited


def _has_no_code(node: Any) -> bool:
    """Types, and what the compiler alone sees."""
    types = c_ast.Typename | c_ast.StaticAssert | c_ast.Typedef
    return isinstance(node, types) or (isinstance(node, c_ast.UnaryOp) and node.op == "sizeof")


@dataclass
class Mutator:
    """Goes through the functions of a source, counts the changes, and makes the chosen ones."""

    source: Path
    chosen: dict[int, int] = field(default_factory=dict)  # place in `changes`: number
    changes: list[Change] = field(default_factory=list)
    function: str = ""  # that it is in

    def run(self, tree: c_ast.FileAST) -> None:
        """Change the functions that the source itself defines."""
        for item in tree.ext:
            if isinstance(item, c_ast.FuncDef) and Path(item.decl.coord.file).name == self.source.name:
                self.function = item.decl.name
                item.body = self._visit(item.body)

    def _change(self, node: Any, kind: str, make: Callable[[], Any]) -> int | None:
        """Note a possible change of a node; its number if it is chosen."""
        place = len(self.changes)
        mutant = make()
        before = _text(node)
        line = node.coord.line if node.coord else 0
        says = f"`{before}` is left out" if mutant is None else f"`{before}` becomes `{_text(mutant)}`"
        self.changes.append(Change(self.source.name, line, self.function, kind, says))
        return self.chosen.get(place)

    def _at(self, number: int) -> c_ast.FuncCall:
        return c_ast.FuncCall(c_ast.ID("passo_at"), c_ast.ExprList([c_ast.Constant("int", str(number))]))

    def _either(self, node: Any, kind: str, make: Callable[[], Any]) -> Callable[[Any], Any]:
        """A function that puts the mutant in front of the node, when that has been visited."""
        number = self._change(node, kind, make)
        if number is None:
            return _as_it_is
        mutant = copy.deepcopy(make())
        return lambda visited: c_ast.TernaryOp(self._at(number), mutant, visited, node.coord)

    def _visit(self, node: Any, constant: bool = False) -> Any:
        """The node with the chosen changes below it, and of itself."""
        if node is None:
            return None
        wrap: Callable[[Any], Any] = _as_it_is
        if isinstance(node, c_ast.BinaryOp) and node.op in SWAPS:
            wrap = self._either(
                node, "operator", lambda: c_ast.BinaryOp(SWAPS[node.op], node.left, node.right, node.coord)
            )
        elif isinstance(node, c_ast.Constant) and "int" in node.type:
            wrap = self._either(
                node, "constant", lambda: c_ast.BinaryOp("+", node, c_ast.Constant("int", "1"), node.coord)
            )
        elif isinstance(node, c_ast.UnaryOp) and node.op in ("!", "-", "~"):
            wrap = self._either(node, "operator", lambda: node.expr)
        elif isinstance(node, c_ast.If):
            return self._visit_if(node)
        elif isinstance(node, c_ast.Compound):
            node.block_items = [self._statement(item) for item in node.block_items or []]
            return node
        elif isinstance(node, c_ast.Assignment) and node.op in ASSIGNED:
            make = lambda: c_ast.Assignment(ASSIGNED[node.op], node.lvalue, node.rvalue, node.coord)  # noqa: E731
            wrap = self._either(node, "operator", make)
        elif isinstance(node, c_ast.Case):
            node.stmts = [self._statement(item) for item in node.stmts or []]
            return node
        elif isinstance(node, c_ast.Decl):
            if "static" not in node.storage and not isinstance(node.type, c_ast.Struct | c_ast.Enum):
                node.init = self._visit(node.init)
            return node
        elif _has_no_code(node):
            return node
        self._children(node)
        return wrap(node)

    def _children(self, node: Any) -> None:
        for name in node.__slots__:
            value = getattr(node, name, None)
            if isinstance(value, c_ast.Node):
                if isinstance(node, c_ast.NamedInitializer | c_ast.StructRef) and name in ("name", "field"):
                    continue
                statement = name in ("stmt", "iftrue", "iffalse") and not isinstance(node, c_ast.TernaryOp)
                setattr(node, name, self._statement(value) if statement else self._visit(value))
            elif isinstance(value, list) and name in ("exprs", "block_items", "stmts", "decls"):
                setattr(node, name, [self._visit(item) for item in value])

    def _visit_if(self, node: c_ast.If) -> c_ast.If:
        wrap = self._either(node.cond, "condition", lambda: c_ast.UnaryOp("!", node.cond, node.cond.coord))
        node.cond = wrap(self._visit(node.cond))
        node.iftrue = self._statement(node.iftrue)
        node.iffalse = self._statement(node.iffalse)
        return node

    def _statement(self, node: Any) -> Any:
        """A statement, which a mutant may leave out."""
        number = None
        if isinstance(node, c_ast.Assignment | c_ast.FuncCall) or (
            isinstance(node, c_ast.UnaryOp) and node.op in ("p++", "p--", "++", "--")
        ):
            number = self._change(node, "statement", lambda: None)
        visited = self._visit(node)
        if number is None:
            return visited
        # in braces: an `else` may follow
        unless = c_ast.If(c_ast.UnaryOp("!", self._at(number)), visited, None, node.coord)
        return c_ast.Compound([unless], node.coord)


class Parsed:
    """The syntax tree of a source."""

    def __init__(self, source: Path, text: str) -> None:
        self.source = source
        self.tree = c_parser.CParser().parse(text, str(source))
        self.code = c_generator.CGenerator().visit(self.tree)  # without comments and layout

    def changes(self) -> list[Change]:
        """All that can be made."""
        mutator = Mutator(self.source)
        mutator.run(self.tree)
        return mutator.changes

    def mutated(self, chosen: dict[int, int]) -> str:
        """The source with mutants, as the tree is from then on: the places of changes, and numbers."""
        Mutator(self.source, chosen).run(self.tree)
        # the compiler checks these in the source
        self.tree.ext = [item for item in self.tree.ext if not isinstance(item, c_ast.StaticAssert)]
        return DECLARED + OFFSETOF + c_generator.CGenerator().visit(self.tree)

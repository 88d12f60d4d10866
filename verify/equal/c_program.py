# SPDX-License-Identifier: MIT
"""Reads preprocessed C: types, enum constants, functions and constant objects."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from pycparser import c_ast, c_parser

from verify.equal.c_types import (
    BOOL,
    INT,
    LONG,
    UNSIGNED,
    UNSIGNED_LONG,
    Array,
    Integer,
    Pointer,
    Struct,
    Type,
    UnsupportedError,
    Void,
)

_NAMED = {
    "_Bool": BOOL,
    "int": INT,
    "signed int": INT,
    "unsigned": UNSIGNED,
    "unsigned int": UNSIGNED,
    "long": LONG,
    "unsigned long": UNSIGNED_LONG,
    "unsigned char": Integer(8, False),
    "signed char": Integer(8, True),
    "char": Integer(8, True),
    "unsigned short": Integer(16, False),
    "short": Integer(16, True),
}


@dataclass
class Program:
    """What a C source defines."""

    text: str
    structs: dict[str, Struct] = field(default_factory=dict)
    typedefs: dict[str, Type] = field(default_factory=dict)
    constants: dict[str, int] = field(default_factory=dict)  # of enums
    functions: dict[str, c_ast.FuncDef] = field(default_factory=dict)
    objects: dict[str, c_ast.Decl] = field(default_factory=dict)  # with file scope

    @cached_property
    def names(self) -> list[str]:
        """Names of the objects."""
        return list(self.objects)

    def __post_init__(self) -> None:
        for item in c_parser.CParser().parse(self.text):
            if isinstance(item, c_ast.Typedef):
                self.typedefs[item.name] = self.type_of(item.type)
            elif isinstance(item, c_ast.FuncDef):
                self.type_of(item.decl.type.type)
                self.functions[item.decl.name] = item
            elif isinstance(item, c_ast.Decl):
                if isinstance(item.type, c_ast.Struct | c_ast.Enum):
                    self.type_of(item.type)
                elif not isinstance(item.type, c_ast.FuncDecl):
                    self.objects[item.name] = item

    def type_of(self, node: Any) -> Type:
        """The type that a declaration or a type name gives."""
        if isinstance(node, c_ast.TypeDecl | c_ast.Typename | c_ast.Decl):
            return self.type_of(node.type)
        if isinstance(node, c_ast.PtrDecl):
            return Pointer(self.type_of(node.type))
        if isinstance(node, c_ast.ArrayDecl):
            return Array(self.type_of(node.type), self.constant(node.dim))
        if isinstance(node, c_ast.IdentifierType):
            name = " ".join(node.names)
            if name == "void":
                return Void()
            kind = _NAMED.get(name) or self.typedefs.get(name)
            if kind is None:
                raise UnsupportedError(f"type {name}")
            return kind
        if isinstance(node, c_ast.Enum):
            self._read_enum(node)
            return UNSIGNED  # gcc and clang choose it as no constant is negative
        if isinstance(node, c_ast.Struct):
            kind = self.structs.setdefault(node.name, Struct(node.name))
            if node.decls:
                kind.fields = {decl.name: self.type_of(decl.type) for decl in node.decls}
            return kind
        raise UnsupportedError(f"type {type(node).__name__}")

    def _read_enum(self, node: c_ast.Enum) -> None:
        following = 0
        for constant in node.values.enumerators if node.values else ():
            value = self.constant(constant.value) if constant.value else following
            self.constants[constant.name] = value
            following = value + 1

    def constant(self, node: Any) -> int:
        """The value of a constant expression: the length of an array, or of an enum constant."""
        from verify.equal.c_evaluate import Evaluator

        bits = Evaluator(self).constant(node)
        if not isinstance(bits, int):
            raise UnsupportedError("a constant that is not known")
        return int(bits)

# SPDX-License-Identifier: MIT
"""Random programs in LinuxCNC's language: expressions, parameters, subroutines, choices and loops."""

import random

# With an argument that they have a value of, mostly.
FUNCTIONS = (
    *("abs[{}]", "cos[{}]", "fix[{}]", "fup[{}]", "round[{}]", "sin[{}]", "tan[{}]", "sqrt[abs[{}]]"),
    *("exp[[{}] mod 3]", "ln[1+abs[{}]]", "asin[.7*sin[{}]]", "acos[.7*cos[{}]]"),
)
OPERATORS = ("+", "-", "*", " eq ", " ne ", " gt ", " ge ", " lt ", " le ", " and ", " or ", " xor ")
LONGEST = 240  # characters of a line, for rs274


class Language:
    """Makes programs; the same generator, the same programs."""

    def __init__(self, rng: random.Random):
        self.rng, self.label, self.depth = rng, 100, 0
        self.names = {"step", "depth", "_global"}
        self.breaks = rng.random() < 0.5  # in LinuxCNC one of `while` also ends the next `do`

    def number(self) -> str:
        """Often one of few, so that comparisons are equal at times."""
        rng = self.rng
        return rng.choice(
            (f"{rng.randint(0, 4)}", f"{rng.uniform(0, 9):.2f}", f"-{rng.randint(1, 3)}", ".5", "2.")
        )

    def value(self, deep: int = 1) -> str:
        """A word's value."""
        rng = self.rng
        kind = rng.randrange(6) if deep else 0
        if kind == 1:
            return f"#{rng.choice((1, 2, 3, 40, 41))}"
        if kind == 2:
            return f"#<{rng.choice(sorted(self.names))}>"
        if kind == 3:
            argument = self.bracket(deep - 1)[1:-1]
            return rng.choice(("", "-", "+")) + rng.choice(FUNCTIONS).format(argument)
        if kind == 4:
            return f"atan{self.bracket(deep - 1)}/{self.bracket(deep - 1)}"
        if kind == 5:
            return self.bracket(deep - 1)
        return self.number()

    def bracket(self, deep: int = 1) -> str:
        """An expression with up to three operators."""
        rng = self.rng
        text = self.value(deep)
        for _ in range(rng.choice((0, 1, 1, 2, 3))):
            if rng.random() < 0.25:
                right = self.value(deep) if rng.random() < 0.03 else rng.choice(("2", "3", "-1.5"))
                text += rng.choice((f"/{right}", " mod 3", " mod -1.5", "**2", "**3"))
            else:
                text += rng.choice(OPERATORS) + self.value(deep)
        return f"[{text}]"

    def bounded(self) -> str:
        """An expression whose value is moderate, for a coordinate."""
        return f"[[{self.value()}] mod 50]"

    def small(self) -> str:
        """A count up to 3."""
        return f"[fix[[{self.value()}] mod 4]]"

    def lines(self, count: int) -> list[str]:
        """Statements."""
        made: list[str] = []
        while len(made) < count:
            statement = self.statement()
            if max(map(len, statement)) < LONGEST:
                made += statement
        return made

    def statement(self) -> list[str]:
        """One of them, with what is in it."""
        rng = self.rng
        kind = rng.random()
        if kind < 0.3:
            return [f"{rng.choice(('G0', 'G1', ''))} {rng.choice('XYZ')}{self.bounded()}"]
        if kind < 0.55 or self.depth > 2:
            return [self.assignment()]
        if kind < 0.6:
            return [f"G1 X#40 #40={self.bounded()} #<step>=[#40 + 1] Y#<step>"]
        self.depth += 1
        self.label += 1
        label = f"o{self.label}" if rng.random() < 0.7 else f"O<name{self.label}>"
        body = self.lines(rng.randint(1, 3))
        made: list[str]
        if kind < 0.75:
            made = [f"{label} if {self.bracket()}", *body]
            if rng.random() < 0.5:
                made += [f"{label} elseif {self.bracket()}", *self.lines(1)]
            if rng.random() < 0.5:
                made += [f"{label} else", *self.lines(1)]
            made.append(f"{label} endif")
        elif kind < 0.87:
            made = [f"{label} repeat {self.small()}", *body, f"{label} endrepeat"]
        elif kind < 0.94:
            if rng.random() < 0.3:
                self.label += 1
                leave = "break" if self.breaks else "continue"
                body += [f"o{self.label} if {self.bracket()}", f"{label} {leave}", f"o{self.label} endif"]
            counter = f"#{60 + self.depth}"
            condition = f"[{counter} {rng.choice(('lt', 'le', 'ne'))} {rng.randint(1, 3)}]"
            made = [
                f"{counter}=0",
                f"{label} while {condition}",
                f"{counter}=[{counter} + 1]",
                *body,
                f"{label} endwhile",
            ]
            if not self.breaks:
                made[1], made[-1] = f"{label} do", f"{label} while [{counter} lt 3]"
        else:
            made = [
                f"o<sub{rng.randint(1, 2)}> call {self.bracket()} {self.bracket()}",
                "G0 Z[#<_value> mod 20]",
            ]
        self.depth -= 1
        return made

    def assignment(self) -> str:
        """Of a parameter of any kind."""
        rng = self.rng
        target = rng.choice(("#1", "#2", "#40", "#41", *(f"#<{name}>" for name in sorted(self.names))))
        return f"{target} = {self.bounded() if rng.random() < 0.5 else self.bracket()}"

    def subroutine(self, number: int) -> list[str]:
        """With two arguments, perhaps a value; it has no division, since rs274 evaluates what it skips."""
        rng = self.rng
        self.depth = 2
        body = ["#<step>=#1", "#<depth>=[#2 mod 9]", *self.lines(3)]
        if rng.random() < 0.5:
            self.label += 1
            body += [
                f"o{self.label} if {self.bracket()}",
                f"o<sub{number}> return [{self.value(0)}-#2]",
                f"o{self.label} endif",
            ]
        self.depth = 0
        end = f" [{self.value(0)}+#1]" if rng.random() < 0.5 else ""
        return [f"o<sub{number}> sub", *body, f"o<sub{number}> endsub{end}"]


def language_program(rng: random.Random, lines: int = 25) -> list[str]:
    """A program; some divide by zero or end otherwise with an error."""
    made = Language(rng)
    head = ["G0 F500", "#<step>=1", "#<depth>=2", "#<_global>=3", *made.subroutine(1), *made.subroutine(2)]
    return [*head, *made.lines(lines)]

"""Formulas: a force or torque as a text, ``-200*v - 50*sign(v)``, read without running it.

.. code-block:: text

    sum     = product {("+" | "-") product}
    product = signed {("*" | "/") signed}
    signed  = ["+" | "-"] power
    power   = atom [("^" | "**") signed]
    atom    = number | name | function "(" sum {"," sum} ")" | "(" sum ")"
              | "where" "(" sum ("<" | "<=" | ">" | ">=") sum "," sum "," sum ")"

A power binds closer than a sign before it, ``-x^2 = -(x^2)``, and is grouped from the right. What is read
becomes a tree of `Node`, and that a `Program` for a stack: instructions in postfix order.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple

from linkwright.kernel.limits import FORMULA, grouped

# Function → minimum and maximum number of arguments; None for any number.
FUNCTIONS: dict[str, tuple[int, int | None]] = {
    **dict.fromkeys(("sin", "cos", "tan", "asin", "acos", "atan", "tanh", "exp", "log", "sqrt"), (1, 1)),
    **dict.fromkeys(("abs", "sign", "step"), (1, 1)),
    **dict.fromkeys(("atan2", "pow"), (2, 2)),
    **dict.fromkeys(("min", "max"), (2, None)),
    "where": (3, 3),
}

# Variables that grow with the speed of the crank.
SPEEDS = frozenset({"omega", "vx", "vy", "v", "psi_dot"})

VARIABLES = frozenset({"phi", "t", "x", "y", "s", "psi"}) | SPEEDS

# Names that stand for a number; g in m/s².
NUMBERS = {"pi": 3.141592653589793, "g": 9.81}

# Numbers that the core's stack holds, module `kernel::formula` there.
DEPTH = 16

# Brackets and signs inside one another; far more than anyone writes, far less than Python's own limit.
_NESTED = 60

_TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)|(?P<name>[A-Za-z_]\w*)"
    r"|(?P<sign>\*\*|<=|>=|[-+*/^(),<>])|(?P<other>\S))"
)
_COMPARISONS = ("<", "<=", ">", ">=")


class Node(NamedTuple):
    """A part of a formula."""

    op: str  # `number`, `name`, `negative`, `+ - * / ^`, a comparison, or the name of a function
    args: tuple[Node, ...] = ()  # what it works on
    value: float | str = ""  # of a number, or a name
    position: int = 0  # of its first character, from 1


# An instruction and what it works with.
Instruction = tuple[str, float | str | None]
Program = tuple[Instruction, ...]


class FormulaError(Exception):
    """What is wrong with a text: what belongs at a place, and what to change."""

    def __init__(self, expected: str, remedy: str = "") -> None:
        super().__init__(expected)
        self.expected = expected
        self.remedy = remedy


@lru_cache(maxsize=256)
def parse(text: str) -> Node:
    """The tree of a formula such as ``12*max(0, sin(phi))^2``; a `FormulaError` says where it fails."""
    return _Reader(text).formula()


def names(node: Node) -> dict[str, int]:
    """Names in a formula and the character at which each stands first, without its functions."""
    places = {str(node.value): node.position} if node.op == "name" else {}
    for arg in node.args:
        places = {**names(arg), **places}
    return places


def restarted(node: Node, angle: str, advance: str) -> Node:
    """The formula of an angle, which starts anew in every revolution and advances by a named number in each.

    f(u) + h (φ − u)/2π, where u = π − atan2(sin φ, −cos φ) goes from 0 to 2π in every revolution.
    """
    turn = parse(f"pi - atan2(sin({angle}), -cos({angle}))")
    done = Node("/", (Node("-", (Node("name", (), angle), turn)), parse("2*pi")))
    return Node("+", (_with(node, angle, turn), Node("*", (Node("name", (), advance), done))))


def _with(node: Node, name: str, other: Node) -> Node:
    """A formula with another formula in place of a name."""
    if node.op == "name":
        return other if node.value == name else node
    return node._replace(args=tuple(_with(arg, name, other) for arg in node.args))


# What jumps, where its first part passes zero or, of two, one of them passes the other.
_JUMPS = frozenset({*_COMPARISONS, "step", "sign", "atan2"})


def conditions(node: Node) -> set[str]:
    """Names that decide where a formula jumps."""
    deciding = set(names(node)) if node.op in _JUMPS else set()
    return deciding.union(*map(conditions, node.args))


def terms(node: Node) -> tuple[Node, ...]:
    """The formula as summands that may be worked with one by one.

    What grows with speed stands alone, since each such summand may grow in its own way; what depends on
    nothing but the position is kept together.
    """
    alone: list[Node] = []
    together: Node | None = None
    for summand in _summands(node):
        if names(summand).keys() & (SPEEDS | {"t"}):
            alone.append(summand)
        else:
            together = summand if together is None else Node("+", (together, summand))
    return (*alone, together) if together is not None else tuple(alone)


def program(node: Node) -> Program:
    """Instructions of a formula in postfix order, each with its operand.

    ``number`` with its value, ``name`` with the name, ``power`` with a whole exponent, and without an operand
    the operators and functions of the grammar.
    """
    return tuple(_instructions(node))


def depth(program: Program) -> int:
    """How many numbers a program keeps at once."""
    height = most = 0
    for op, _ in program:
        height += 1 - _TAKES.get(op, 1)
        most = max(most, height)
    return most


_TAKES = {"number": 0, "name": 0, "where": 4} | dict.fromkeys(
    ("+", "-", "*", "/", "pow", "atan2", "min", "max"), 2
)


def _summands(node: Node) -> Iterator[Node]:
    if node.op in "+-" and len(node.args) == 2:
        yield from _summands(node.args[0])
        for summand in _summands(node.args[1]):
            yield summand if node.op == "+" else Node("negative", (summand,), position=summand.position)
    elif node.op == "negative":
        for left in _summands(node.args[0]):
            yield Node("negative", (left,), position=left.position)
    else:
        yield node


def _instructions(node: Node) -> Iterator[Instruction]:
    if node.op in ("number", "name"):
        yield node.op, node.value
        return
    if node.op == "where":
        yield from _choice(node)
        return
    exponent = _whole(node.args[1]) if node.op in ("^", "pow") else None
    for nth, operand in enumerate(node.args[:1] if exponent is not None else node.args):
        yield from _instructions(operand)
        # The smallest of many is the smaller of the first and the next, and so on.
        if node.op in ("min", "max") and nth > 0:
            yield node.op, None
    if exponent is not None:
        yield "power", exponent
    elif node.op not in ("min", "max"):
        yield ("pow" if node.op == "^" else node.op), None


def _choice(node: Node) -> Iterator[Instruction]:
    """``where`` as a, b, x, y: x where a < b, else y. What is not a < b is turned round until it is."""
    comparison, yes, no = node.args
    low, high = comparison.args
    if comparison.op in (">", "<="):
        low, high = high, low
    if comparison.op in ("<=", ">="):
        yes, no = no, yes
    for operand in (low, high, yes, no):
        yield from _instructions(operand)
    yield "where", None


def _whole(node: Node) -> int | None:
    """The exponent, if it is a whole number small enough for repeated products."""
    sign = -1 if node.op == "negative" else 1
    node = node.args[0] if node.op == "negative" else node
    if node.op == "number" and float(node.value).is_integer() and abs(float(node.value)) <= 64:
        return sign * int(node.value)
    return None


class _Reader:
    """Goes through a text from left to right."""

    def __init__(self, text: str) -> None:
        self.tokens = [
            (str(match.lastgroup), match[str(match.lastgroup)], match.start(str(match.lastgroup)) + 1)
            for match in _TOKEN.finditer(text)
        ]
        if len(self.tokens) > FORMULA.most:
            found = f"{FORMULA.words}, found {grouped(len(self.tokens))}"
            raise FormulaError(found, "write a part of it as a constant or a table")
        self.tokens.append(("end", "", len(text) + 1))
        self.place = 0
        self.nested = 0

    def formula(self) -> Node:
        node = self._sum()
        kind, word, at = self._here()
        if kind == "end":
            return node
        remedy = ""
        if word in ("<", "<=", ">", ">=", "="):
            remedy = "a comparison stands in where(a < b, x, y) only"
        elif kind in ("name", "number") or word == "(":
            remedy = (
                f'write a product with a sign, as in "2*{word}"'
                if kind == "name"
                else "write products with *"
            )
        raise FormulaError(f"an operator or the end at character {at}, where {_quoted(word)} stands", remedy)

    def _here(self) -> tuple[str, str, int]:
        return self.tokens[self.place]

    def _take(self, *signs: str) -> str:
        """The sign that stands here, if it is one of some, and go on."""
        kind, word, _ = self._here()
        if kind == "sign" and word in signs:
            self.place += 1
            return word
        return ""

    def _need(self, sign: str, remedy: str = "") -> None:
        _, word, at = self._here()
        if not self._take(sign):
            raise FormulaError(f"{_quoted(sign)} at character {at}, where {_quoted(word)} stands", remedy)

    def _sum(self) -> Node:
        left = self._product()
        while sign := self._take("+", "-"):
            left = Node(sign, (left, self._product()), position=left.position)
        return left

    def _product(self) -> Node:
        left = self._signed()
        while sign := self._take("*", "/"):
            left = Node(sign, (left, self._signed()), position=left.position)
        return left

    def _signed(self) -> Node:
        at = self._here()[2]
        self.nested += 1
        if self.nested > _NESTED:
            raise FormulaError(f"at most {_NESTED} brackets and signs inside one another", "simplify it")
        sign = self._take("+", "-")
        inner = self._signed() if sign else self._power()
        self.nested -= 1
        return Node("negative", (inner,), position=at) if sign == "-" else inner

    def _power(self) -> Node:
        base = self._atom()
        if self._take("^", "**"):
            return Node("^", (base, self._signed()), position=base.position)
        return base

    def _atom(self) -> Node:
        kind, word, at = self._here()
        if kind == "number":
            self.place += 1
            return Node("number", value=float(word), position=at)
        if kind == "name":
            self.place += 1
            return self._call(word, at) if self._take("(") else Node("name", value=word, position=at)
        if self._take("("):
            inner = self._sum()
            self._need(")", "close the bracket")
            return inner
        raise FormulaError(f"a number, a name or ( at character {at}, where {_quoted(word)} stands")

    def _call(self, name: str, at: int) -> Node:
        """A function with its arguments; its name and the bracket are read."""
        if name not in FUNCTIONS:
            from linkwright.kernel.description.base import suggestion

            expected = f"a function at character {at}, where {_quoted(name)} stands"
            raise FormulaError(expected, suggestion(name, FUNCTIONS) or "there is " + ", ".join(FUNCTIONS))
        args = [self._comparison() if name == "where" else self._sum()]
        while self._take(","):
            args.append(self._sum())
        least, most = FUNCTIONS[name]
        if len(args) < least or (most is not None and len(args) > most):
            wanted = f"{least} argument{'s' if least > 1 else ''}" if most else f"{least} arguments or more"
            raise FormulaError(f"{wanted} of {name} at character {at}, found {len(args)}")
        self._need(")", "close the bracket")
        return Node(name, tuple(args), position=at)

    def _comparison(self) -> Node:
        left = self._sum()
        _, word, at = self._here()
        sign = self._take(*_COMPARISONS)
        if not sign:
            expected = f"a comparison <, <=, > or >= at character {at}, where {_quoted(word)} stands"
            raise FormulaError(expected, "as in where(a < b, x, y)")
        return Node(sign, (left, self._sum()), position=left.position)


def _quoted(word: str) -> str:
    return f'"{word}"' if word else "the end"

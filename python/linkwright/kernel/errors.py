"""What can go wrong, in two families: the input is wrong, or the machine cannot do it.

| error | family | says |
| --- | --- | --- |
| `UnitError` | input | a number or a text is not the quantity that was asked for |
| `MachineError` | input | a description contradicts itself; lists every problem |
| `MachineFileError` | input | the same for a file: with file and line |
| `LawError` | input | a motion law cannot do what it was asked for |
| `ShapeError` | input | arrays do not fit together |
| `FrozenError` | input | an attribute of a description or a result was to be set |
| `CoreError` | input | the compiled core is not that of this package |
| `AssemblyError` | finding | the links do not close |
| `StartError` | finding | the drive does not start, stalls or runs backwards |
| `SteadyStateError` | finding | there is no periodic motion |
| `ConvergenceError` | finding | a method did not reach the accuracy asked for |
| `CamError` | finding | a cam cannot be made or followed |
| `SynthesisError` | finding | no linkage does what was asked for |
| `ExchangeError` | finding | a curve cannot be manufactured, or a written file does not keep its tolerance |
| `InternalError` | – | the program contradicted itself: a fault of Linkwright, not of the input |

An input error means exit code 2 of the command line, a finding exit code 1, an internal one exit code 70.
Nothing here needs the compiled core.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import FrozenInstanceError, dataclass
from typing import ClassVar

from linkwright.kernel.limits import MESSAGE_LINE, PROBLEMS, Limit, grouped


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing that is wrong in the input: where it is, what is there, what belongs there.

    Attributes
    ----------
    key : str
        Address of the entry, such as ``mechanism.cranks.A2.phase``.
    found : str
        What stands there, as the user wrote it.
    expected : str
        What belongs there.
    remedy : str
        What to change; empty if ``expected`` says it already.
    path : str
        The file, or the override (``--set …``) that brought the entry in.
    line : int or None
        Line in the file, counted from 1.
    """

    key: str = ""
    found: str = ""
    expected: str = ""
    remedy: str = ""
    path: str = ""
    line: int | None = None

    @property
    def place(self) -> str:
        """File, line and key on one line."""
        where = f"{self.path}:{self.line}" if self.path and self.line else self.path
        return ": ".join(part for part in (where, self.key) if part)

    def __str__(self) -> str:
        """A block of up to four lines."""
        rows = (("found", self.found), ("expected", self.expected), ("remedy", self.remedy))
        body = [f"  {name + ':':<10}{cut(text)}" for name, text in rows if text]
        return "\n".join([cut(self.place), *body] if self.place else body)


def printable(text: str) -> str:
    """A text with escapes for control characters and those that turn the direction of writing."""
    if text.isprintable():
        return text
    return "".join(
        letter if letter.isprintable() or letter == "\n" else ascii(letter)[1:-1] for letter in text
    )


def cut(text: str) -> str:
    """A text that fits into some lines of a terminal, and does not steer it."""
    text = printable(text)
    most = MESSAGE_LINE.most
    return text if len(text) <= most else f"{text[: most - 1]}…"


class LinkwrightError(Exception):
    """Any error that this package raises on purpose."""

    exit_code: ClassVar[int] = 1


class InputError(LinkwrightError):
    """What was given is wrong; nothing was computed."""

    exit_code: ClassVar[int] = 2


def require_within(limit: Limit, number: float, what: str, remedy: str) -> None:
    """Refuse a count beyond its limit before any work; `what`: option or key; `remedy`: what to change."""
    if not number <= limit.most:
        # Beyond 1e15 the digits say nothing.
        shown = grouped(round(number)) if number < 1e15 else f"{number:.3g}"
        raise InputError(f"{what}: found {shown}, expected {limit.words}; {remedy}")


class FindingError(LinkwrightError):
    """The input is sound, and the answer is that the machine cannot do it.

    Attributes
    ----------
    cause : str
        What findings of several analyses have in common, so that a study says it once; empty if nothing.
    """

    exit_code: ClassVar[int] = 1
    cause: str = ""


class InternalError(LinkwrightError):
    """The program contradicted itself.

    Parameters
    ----------
    analysis : str
        What was being computed.
    reason : str
        What was wrong, and where in the program.
    """

    # EX_SOFTWARE of sysexits.h.
    exit_code: ClassVar[int] = 70

    def __init__(self, analysis: str, reason: str) -> None:
        super().__init__(analysis, reason)
        self.analysis = analysis
        self.reason = reason

    def __str__(self) -> str:
        """What to do about it, too."""
        return (
            f"{self.analysis}: internal error, {self.reason}; the input is not to blame: please report it "
            "with the machine file and the command"
        )


class UnitError(InputError):
    """A value is not the quantity that was asked for; ``problem`` says what was."""

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        self.problem = problem


class MachineError(InputError):
    """A description contradicts itself; ``problems`` lists all that was found wrong."""

    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems: list[Problem] = list(problems)
        super().__init__(self.problems)

    def __str__(self) -> str:
        """A block for each problem, as many as fit on a screen; and how many more there are."""
        blocks = [str(problem) for problem in self.problems[: PROBLEMS.most]]
        more = len(self.problems) - len(blocks)
        if more:
            blocks.append(f"… and {grouped(more)} more problem{'s' if more > 1 else ''}")
        return "\n\n".join(blocks)


class MachineFileError(MachineError):
    """A machine file cannot be read, or describes no machine; the problems have a file and a line."""


class LawError(InputError):
    """A motion law cannot do what it was asked for; ``problem`` says what, with a key of the law."""

    def __init__(self, problem: Problem) -> None:
        super().__init__(problem)
        self.problem = problem


class ShapeError(InputError):
    """Arrays do not fit together."""


class FrozenError(InputError, FrozenInstanceError):
    """An attribute of a description or result was to be set; the message says how to make a changed copy."""


class CoreError(InputError):
    """The compiled core is not that of this package; the numbers of both formats, and what to do."""

    def __init__(self, found: int | None, expected: int, path: str) -> None:
        super().__init__(
            f"{path}: found a compiled core of format {found}, expected format {expected}; build it again "
            "(in a clone: make demo, or maturin develop --release), or install linkwright anew"
        )
        self.found = found
        self.expected = expected


class AssemblyError(FindingError):
    """The links do not close at some crank angle.

    Parameters
    ----------
    message : str
        One sentence with the numbers and the remedy.
    element : str
        Name of the element that does not close.
    crank_angle : float or None
        Crank angle at which it does not [rad].
    gap : float or None
        Length that is missing [m].
    """

    def __init__(
        self, message: str, *, element: str = "", crank_angle: float | None = None, gap: float | None = None
    ) -> None:
        super().__init__(message)
        self.element = element
        self.crank_angle = crank_angle
        self.gap = gap


class StartError(FindingError):
    """The machine does not start, stalls on the way, or is driven backwards."""


class SteadyStateError(FindingError):
    """There is no periodic motion; the message says what the drive lacks."""


class ConvergenceError(FindingError):
    """A method stopped before it reached the accuracy asked for.

    Parameters
    ----------
    message : str
        One sentence with the numbers and the remedy.
    method : str
        What was being solved.
    iterations : int or None
        How many were made.
    residual : float or None
        How far off the last value was, in the unit that the message names.
    """

    def __init__(
        self, message: str, *, method: str = "", iterations: int | None = None, residual: float | None = None
    ) -> None:
        super().__init__(message)
        self.method = method
        self.iterations = iterations
        self.residual = residual


class CamError(FindingError):
    """A cam cannot be made or followed; the message has angle, numbers and the smallest change."""


class SynthesisError(FindingError):
    """No linkage of the kind does what was asked for; the message has the numbers and what to change."""


class ExchangeError(FindingError):
    """A curve has no outline that can be manufactured, or what was read back is not what was written."""


# A value is shown on one line of a terminal, together with a few words.
_SHOWN = 80

# Longer whole numbers are reported by their length.
_WHOLE_BITS = 256


def show(value: object) -> str:
    """Write a value as the user may have written it, shortened to fit in a line."""
    if isinstance(value, list | tuple | dict):
        return "a table" if isinstance(value, dict) else "a list"
    if isinstance(value, int) and value.bit_length() > _WHOLE_BITS:
        # Python refuses to write numbers of thousands of digits.
        return f"a whole number of about {int(value.bit_length() * math.log10(2)) + 1} digits"
    # What lies beyond the part that is shown costs nothing.
    text = f'"{value[: 4 * _SHOWN]}"' if isinstance(value, str) else str(value)
    text = " ".join(text.lower().split() if isinstance(value, bool) else text.split())
    text = printable(text)
    return text if len(text) <= _SHOWN else text[: _SHOWN - 3] + "..."

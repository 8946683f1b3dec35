"""An analysis: what it is called, which function makes it, when it applies, and all that is shown of it.

A room declares its analyses in its `analyses.py`; `linkwright.app.subjects` lists them. Study, report, check,
studio, studies and derivatives read that list, so that an analysis is written down once.

A function is named by its place, ``of("turning.tables:turning_tables", "turning_moment")``, and imported
when it is called: a machine without such a part does not load its room. What is named after the place is
passed on of the study: ``"machine"`` or an entry of it, ``"machine.topper"``, and results by name, without
which it is not called; ``"?rod_rotator"``, a result or None; ``"*cam"``, all of several parts. Without names
it is the study itself.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Any

from linkwright.kernel.findings import Findings
from linkwright.kernel.later import at_place
from linkwright.kernel.page.table import few
from linkwright.kernel.public.immutable import freeze, refuse
from linkwright.kernel.result import Result
from linkwright.machine.machine import Machine


@dataclass(frozen=True)
class Obstacle:
    """What stands in the way of an analysis."""

    words: str  # what is missing
    remedy: str = ""  # words of the button that mends it; empty if nothing simple does
    entries: Mapping[str, Any] | None = None  # entries that the button sets


@dataclass(frozen=True)
class Of:
    """A function by its place below `linkwright`, and the parts of a study that it takes."""

    place: str  # "module:name"
    parts: tuple[str, ...] = ()

    @property
    def function(self) -> Callable[..., Any]:
        """The function, imported now."""
        function: Callable[..., Any] = at_place(self.place)
        return function

    def __call__(self, *args: Any, **options: Any) -> Any:
        """Call the function."""
        return self.function(*args, **options)

    def shown(self, known: Results) -> Iterable[Any]:
        """What the function tells of a study; nothing where a result that it needs is not there."""
        if not self.parts:
            return self.function(known) or ()
        needed = [part for part in self.parts if part[0].isalpha()]
        values = {part: _part(known, part) for part in self.parts}
        there = {part for part, value in values.items() if value is not None and value != ()}
        if not there or not there.issuperset(needed):
            return ()
        return self.function(*values.values()) or ()


def _part(known: Results, part: str) -> Any:
    return known.each(part[1:]) if part[0] == "*" else attrgetter(part.lstrip("?"))(known)


def of(place: str, *parts: str) -> Of:
    """A function by its place, with the parts of a study that it takes."""
    return Of(place, parts)


def _always(machine: Machine) -> bool:
    """Any machine."""
    return True


@dataclass(frozen=True, kw_only=True)
class Analysis:
    """An analysis of a machine.

    `make` takes the `Results` of a study so far and its `Findings`, and gives the result, a function that
    gives it when it is asked for, results by the name of a part, or None; without it the `function` is called
    with the machine. `tangents` takes machine and addresses, and gives `Derivatives`. `check` takes machine
    and `Findings`, and gives what it has examined, in words. `obstacle` takes the machine. The others are of
    a study, see `Of`.
    """

    name: str  # in ``--json``, studies, derivatives, the studio
    words: str = ""  # what the studio calls it; empty where it does not list it
    lane: str = "study"  # of the studio: fast, study or torsion
    function: Of | None = None
    within: str = ""  # the result within another that it is, "pumping_unit.gear"
    options: Mapping[str, Any] = field(default_factory=dict)  # of the function, in a study
    applies: Callable[[Machine], bool] = _always
    parts: Callable[[Machine], tuple[str, ...]] | None = None  # names of parts, of an analysis of several
    part: str = ""  # what a part is called, such as "cam"
    mark: Of | None = None  # of machine, part and `Label` of a quantity: word and unit that it has there
    obstacle: Of | None = None
    is_of_study: bool = True  # whether a study has it
    is_motion: bool = False  # whether its tables and figures belong to the report's part on motion
    formerly: str = ""  # its name before, which is still read
    make: Of | None = None
    findings: Of | None = None
    warnings: Of | None = None
    tangents: Of | None = None
    # Of the machine and entries over many machines, address → (n,): the results one after another, or None
    # where machines are computed one by one.
    many: Of | None = None
    check: Of | None = None
    summary: Of | None = None  # of the machine: rows of what it consists of
    tables: Of | None = None
    details: Of | None = None  # tables at the end
    figures: Of | None = None
    # What its reader asks first: quantities of the result, or word, value and unit of each.
    headline: tuple[str, ...] | Of = ()
    formulas: Of | None = None
    papers: Of | None = None  # sources of formulas
    assumptions: Of | None = None
    scene: Of | None = None

    @property
    def analyse(self) -> Callable[..., Any]:
        """The function that makes the result of a machine, imported now."""
        assert self.function is not None, self.name
        return self.function.function


class Results(Mapping[str, Result]):
    """Results of a machine by the name of their analysis, what it cannot do, and what to know of it.

    A result is an attribute as well, None where it is not there; of an analysis of several parts, such as
    cams, results are named ``"cam"`` or, where there are several, ``"cam.NAME"``.
    """

    findings: tuple[str, ...] = ()  # what the machine cannot do, in sentences
    warnings: tuple[str, ...] = ()  # what its designer should know, in sentences
    attempt: Any = None  # the motion from the start to the stall, where the run-up fails
    sound_cams: tuple[Any, ...] = ()  # cams that can be made

    def __init__(self, machine: Machine, accuracy: float = 1e-10, step: float | None = None) -> None:
        self.machine = machine
        self.accuracy = accuracy  # relative, of the steady speed
        self.step = step  # of the crank angle for the step method [rad]; None without it
        self._results: dict[str, Any] = {}

    def __getitem__(self, name: str) -> Result:
        """A result by its name."""
        if not isinstance(self._results[name], Result):
            self._results[name] = self._results[name]()
            freeze(self._results[name])
        found: Result = self._results[name]
        return found

    def __iter__(self) -> Iterator[str]:
        """Names of the results."""
        return iter(self._results)

    def __len__(self) -> int:
        """How many results there are."""
        return len(self._results)

    def __getattr__(self, name: str) -> Any:
        """A result by its name; None where the analysis has none."""
        if name.startswith("_"):
            raise AttributeError(name)
        return self[name] if name in self._results else self._without(name)

    def __dir__(self) -> list[str]:
        """Attributes, and the results that there are."""
        return sorted({*super().__dir__(), *(name for name in self._results if name.isidentifier())})

    def _without(self, name: str) -> Any:
        return None

    def close(self, findings: Findings) -> None:
        """Take over what was collected; from now on nothing of it changes."""
        self.findings, self.warnings = findings.findings, findings.warnings
        freeze(self._results)
        self._is_closed = True

    def __setattr__(self, name: str, value: Any) -> None:
        """Set an attribute while the study is made."""
        if vars(self).get("_is_closed"):
            refuse(self, name, "")
        object.__setattr__(self, name, value)

    def each(self, name: str) -> tuple[Any, ...]:
        """Results of an analysis of several parts."""
        return tuple(self[key] for key in self._results if key.partition(".")[0] == name)

    def add(self, analysis: Analysis, findings: Findings) -> None:
        """Make the result of an analysis; what fails becomes a finding."""
        made = self._made(analysis, findings)
        if isinstance(made, Mapping) and not isinstance(made, Result):
            names = analysis.parts(self.machine) if analysis.parts is not None else ()
            single = len(names) == 1
            self._results |= {analysis.name if single else f"{analysis.name}.{k}": v for k, v in made.items()}
        elif made is not None:
            self._results[analysis.name] = made
        findings.add(analysis.findings.shown(self) if analysis.findings else ())
        findings.warn(analysis.warnings.shown(self) if analysis.warnings else ())

    def _made(self, analysis: Analysis, findings: Findings) -> Any:
        if analysis.make is not None:
            return analysis.make(self, findings)
        if analysis.within:
            within, _, name = analysis.within.partition(".")
            return getattr(getattr(self, within, None), name, None)
        return findings.of(analysis.analyse, self.machine, **analysis.options)

    def headline(self, analyses: Iterable[Analysis]) -> Iterator[tuple[str, str, str]]:
        """What the reader asks first: word, value, unit."""
        for analysis in analyses:
            if isinstance(analysis.headline, Of):
                yield from analysis.headline.shown(self) if analysis.applies(self.machine) else ()
                continue
            parts = [key for key in self._results if key.partition(".")[0] == analysis.name]
            for key in parts if analysis.headline else ():
                names = analysis.parts(self.machine) if analysis.parts is not None else ()
                before = f"{analysis.part} {key.partition('.')[2] or names[0]}: " if names else ""
                yield from few(self[key], analysis.headline, before)

    def shown(self, analyses: Iterable[Analysis], what: str) -> Iterator[Any]:
        """What the analyses that apply show of themselves, such as their ``"tables"``, in their order."""
        for analysis in analyses:
            shown: Of | None = getattr(analysis, what)
            if shown is not None and analysis.applies(self.machine):
                yield from shown.shown(self)

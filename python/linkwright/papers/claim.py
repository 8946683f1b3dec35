"""One printed claim beside what comes out: the deviation, and a verdict in words.

A claim is a table ``[[claim]]`` of a paper's file of data:

| key | is |
| --- | --- |
| ``name``, ``where`` | What it is; page, figure or formula |
| ``printed``, or ``value`` and ``unit`` | As printed: words; or a number [SI], or its name in the file |
| ``quantity`` | Name of the quantity that a printed number is compared with |
| ``difference`` | Or of the largest difference of a printed formula from another way, as a share |
| ``deviation`` | Or of formula over exact, less one |
| ``holds``, ``in_part`` | Or of the statements that it holds, and that it does in part |
| ``tolerance`` | Its name in ``tolerances.toml``, where its reason is |
| ``computed`` | What comes out, in words |
| ``because`` | Why it differs, if it does |
| ``verdict`` | Words by kind of verdict, in place of the usual ones |

A claim with none of these quantities is not judged: its value is taken, or its words are given.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

from linkwright.papers.page import filled, named, rounded_up


@dataclass(frozen=True)
class Tolerance:
    """Deviations, as shares, up to which a value is reproduced, and near; and the reason."""

    reproduced: float
    near: float
    why: str

    def kind(self, deviation: float) -> str:
        """``"reproduced"``, ``"near"`` or ``"far"``."""
        off = abs(deviation)
        return "reproduced" if off <= self.reproduced else "near" if off <= self.near else "far"


@cache
def tolerance(name: str) -> Tolerance:
    """A tolerance of ``tolerances.toml``."""
    text = files("linkwright.papers").joinpath("tolerances.toml").read_text(encoding="utf-8")
    return Tolerance(**tomllib.loads(text)[name])


@dataclass(frozen=True)
class Cell:
    """A published and a computed value."""

    published: float  # as printed, in SI
    computed: float | None  # None where a way of computing has no such value
    because: str  # why it differs, if it does
    given: bool = False  # whether the computation takes the published value, so that agreement says nothing
    allowed: str = "digits"  # name of the tolerance

    @property
    def deviation(self) -> float | None:
        """Computed over published, less one [–]."""
        return None if self.computed is None else self.computed / self.published - 1

    @property
    def kind(self) -> str:
        """``"reproduced"``, ``"near"``, ``"far"``, or ``"none"`` where there is nothing to compare."""
        if self.deviation is None or self.given:
            return "none"
        return tolerance(self.allowed).kind(self.deviation)

    @property
    def verdict(self) -> str:
        """In words."""
        if self.deviation is None:
            return f"no value: {self.because}"
        if self.given:
            return "taken from the paper"
        if self.kind == "near":
            # Up to the next tenth of a percent, but not for the sake of rounding.
            return f"within {math.ceil(1e3 * abs(self.deviation) - 1e-6) / 10:.1f} %"
        return "reproduced" if self.kind == "reproduced" else f"not reproduced because {self.because}"

    @property
    def percent(self) -> str:
        """The deviation in percent with its sign; empty where there is nothing to compare."""
        if self.deviation is None or self.given:
            return "taken" if self.given else ""
        digits = 2 if self.kind == "reproduced" else 1
        return f"{100 * self.deviation:+.{digits}f} %".replace("-", "−")

    def to_dict(self) -> dict[str, Any]:
        """Its entries, ready for JSON."""
        return {
            "published": self.published,
            "computed": self.computed,
            "deviation_percent": None if self.deviation is None else 100 * self.deviation,
            "verdict": self.verdict,
        }


@dataclass(frozen=True)
class Row:
    """One claim, judged."""

    # In words, with units.
    name: str
    printed: str
    computed: str
    verdict: str
    kind: str  # `"reproduced"`, `"near"`, `"far"` or `"none"`
    # Where it is printed; the reason for its tolerance.
    where: str
    why: str

    def to_dict(self) -> dict[str, str]:
        """What it says, ready for JSON."""
        return {name: getattr(self, name) for name in ("name", "printed", "computed", "verdict", "kind")}


def cell_of(claim: Mapping[str, Any], values: Mapping[str, Any]) -> Cell:
    """A printed number of a claim beside the quantity that it names among printed and computed values."""
    value = named(values, claim["value"]) if isinstance(claim["value"], str) else claim["value"]
    because = filled(claim.get("because", ""), values)
    return Cell(value, named(values, claim["quantity"]), because, allowed=claim["tolerance"])


def judged(claim: Mapping[str, Any], values: Mapping[str, Any]) -> Row:
    """Judge a claim, as the table above has it, by printed and computed values."""
    form = next((form for form in _FORMS if form in claim), "")
    printed, computed, verdict, kind = _FORMS.get(form, _taken)(claim, values)
    printed, computed = (
        filled(claim[key], values) if key in claim else usual
        for key, usual in (("printed", printed), ("computed", computed))
    )
    words = claim.get("verdict", {}).get(kind)
    why = tolerance(claim["tolerance"]).why if "tolerance" in claim else ""
    verdict = filled(words, values) if words else verdict
    name = filled(claim["name"], values)
    return Row(name, printed, computed or printed, verdict, kind, claim["where"], why)


_FitJudgement = tuple[str, str, str, str]


def _taken(claim: Mapping[str, Any], values: Mapping[str, Any]) -> _FitJudgement:
    return "", "", "taken from the paper", "none"


def _number(claim: Mapping[str, Any], values: Mapping[str, Any]) -> _FitJudgement:
    cell, unit = cell_of(claim, values), claim["unit"]
    shown = "–" if cell.computed is None else f"{cell.computed:.{claim.get('digits', 6)}g} {unit}"
    return f"{cell.published:.10g} {unit}", shown, cell.verdict, cell.kind


def _agreement(claim: Mapping[str, Any], values: Mapping[str, Any]) -> _FitJudgement:
    difference = named(values, claim["difference"])
    kind = tolerance(claim["tolerance"]).kind(difference)
    because = filled(claim["because"], values)
    words = "reproduced to rounding" if kind == "reproduced" else f"not reproduced because {because}"
    return "", f"the same to {difference:.0e}" if difference else "the same", words, kind


def _deviation(claim: Mapping[str, Any], values: Mapping[str, Any]) -> _FitJudgement:
    allowed = tolerance(claim["tolerance"])
    words, kind = holding(named(values, claim["deviation"]), allowed)
    because = filled(claim.get("because", ""), values)
    return "", "", f"{words}: {because}" if because else words, kind


def holding(deviation: float, allowed: Tolerance) -> tuple[str, str]:
    """How well a formula holds by its deviation, in words, and the kind of verdict."""
    kind = allowed.kind(deviation)
    if tolerance("rounding").kind(deviation) == "reproduced":
        return "holds exactly", kind
    # Up to the next digit that tells it.
    return "does not hold" if kind == "far" else f"holds within {rounded_up(100 * abs(deviation), 2)} %", kind


def _statement(claim: Mapping[str, Any], values: Mapping[str, Any]) -> _FitJudgement:
    holds, in_part = (key in claim and named(values, claim[key]) for key in ("holds", "in_part"))
    kind = "reproduced" if holds else "near" if in_part else "far"
    return "", "", "reproduced" if holds else "not reproduced", kind


_FORMS = {"quantity": _number, "difference": _agreement, "deviation": _deviation, "holds": _statement}

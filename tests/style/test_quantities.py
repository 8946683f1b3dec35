"""Quantities are declared once, at their attributes: what is shown of a result follows from that."""

from __future__ import annotations

import inspect
import re
from collections import Counter
from dataclasses import dataclass, fields, is_dataclass
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import numpy as np
import pint
import pytest
from test_docs import tables
from test_docstrings import entries, section

import linkwright as lw
from linkwright import InputError
from linkwright.app.subjects import ANALYSES
from linkwright.drive import SteadyState
from linkwright.drive.tables import drive_tables
from linkwright.kernel.page.table import curves_csv
from linkwright.kernel.quantities import About, Label, declared, in_table, quantities_of
from linkwright.kernel.result import Result
from linkwright.studio.language import in_words
from linkwright.torsion import TorsionStudy

REGISTRY = pint.UnitRegistry()
RESULTS = [each for each in tables().results() if is_dataclass(each)]
DECLARED = [each for each in RESULTS if declared(each)]


def is_coherent(unit: str) -> bool:
    """Whether a unit is one of SI without a factor."""
    return REGISTRY.Quantity(1.0, plain(unit)).to_base_units().magnitude == 1.0


def plain(unit: str) -> str:
    """A unit as pint reads it."""
    return unit.replace("²", "**2").replace("³", "**3").replace(" ", "*")


def test_all_results_are_declared() -> None:
    """No result has a list of its attributes that was written by hand."""
    assert {each.__name__ for each in RESULTS} - {each.__name__ for each in DECLARED} == set()


@pytest.mark.parametrize("result", DECLARED, ids=lambda each: each.__name__)
def test_all_attributes_are_declared(result: type) -> None:
    """Fields all, properties if they are numbers or arrays of numbers."""
    names = {each.name for each in fields(result) if not each.name.startswith("_")}
    for name, member in inspect.getmembers(result, lambda each: isinstance(each, property)):
        hint = get_type_hints(member.fget).get("return")
        kinds = {get_origin(each) or each for each in (hint, *get_args(hint))}
        if kinds & {int, float, np.ndarray} and get_origin(hint) not in (tuple, dict, list):
            names.add(name)
    assert names - set(declared(result)) == set()


@pytest.mark.parametrize("result", DECLARED, ids=lambda each: each.__name__)
def test_declarations_say_something_of_each(result: type) -> None:
    for name, (_, mark) in declared(result).items():
        if isinstance(mark, About):
            assert mark.about.endswith("."), name
            continue
        assert mark.word, name
        assert mark.word == mark.word.strip(" ."), name
        assert not mark.about or mark.about.endswith("."), name
        assert not mark.over or mark.over in declared(result), name
        for unit in mark.unit.split(" or "):
            assert unit in ("", "–") or is_coherent(unit), (name, unit)
    for table in {mark.table for _, mark in declared(result).values() if isinstance(mark, Label)} - {""}:
        assert in_table(result, table)


@pytest.mark.parametrize("result", DECLARED, ids=lambda each: each.__name__)
def test_words_tell_the_quantities_of_a_result_apart(result: type) -> None:
    """Curves and single numbers stand in different places."""
    words = [(quantity.word, quantity.kind) for quantity in quantities_of(result)]
    assert len(set(words)) == len(words), Counter(words).most_common(1)


def test_docstrings_tell_what_is_declared() -> None:
    for result in DECLARED:
        told = entries(section(result.__doc__ or "", "Attributes") or "")
        assert list(told) == list(declared(result)), result.__name__


@dataclass(frozen=True)
class Sample(Result):
    """A result of which the field below is all that was written.

    Notes
    -----
    None.
    """

    crank_angle: Annotated[np.ndarray[Any, np.dtype[np.float64]], Label("crank angle", "φ", "rad")]
    pull: Annotated[
        np.ndarray[Any, np.dtype[np.float64]], Label("pull of the rope", "Z", "N", "On the drum.")
    ]


def test_docstring_has_its_section_before_others() -> None:
    text = Sample.__doc__ or ""
    assert "pull : ndarray, shape as crank_angle\n    Pull of the rope, Z [N]. On the drum.\n" in text
    assert text.index("Attributes\n") < text.index("Notes\n")


def test_heads_of_columns_have_the_units_that_are_declared() -> None:
    found = Sample(np.array([0.0, 1.0]), np.array([2.0, 3.0]))
    assert curves_csv(found).splitlines()[0] == "crank_angle [rad],pull [N]"


@dataclass(frozen=True)
class Heated(SteadyState):
    """Steady motion with one more scalar: it is declared, and that is all."""

    @property
    def loss(self) -> Annotated[float, Label("what is lost", "V", "J", table="drive", before="efficiency")]:
        """Work of the motor less that of the loads."""
        return self.energy_motor - self.energy_load


def test_one_declaration_puts_a_scalar_into_table_json_docs_and_list(monkeypatch: pytest.MonkeyPatch) -> None:
    machine = lw.read("machines/roller_two_carts.toml")
    found = lw.study(machine)
    steady = found.steady_state
    assert steady is not None
    heated = Heated(**{each.name: getattr(steady, each.name) for each in fields(steady)})
    monkeypatch.setitem(found._results, "steady_state", heated)
    rows = {table.name: table.rows for table in drive_tables(found)}["drive"]
    words = [row[0] for row in rows]
    assert words[words.index("what is lost") + 1] == "efficiency of the drive per revolution"
    assert heated.to_dict()["loss"] == steady.energy_motor - steady.energy_load
    assert "loss : float\n    What is lost, V [J]. Work of the motor less that of the loads." in (
        Heated.__doc__ or ""
    )
    listed = {each.name: each for each in lw.quantities(found)}
    assert listed["steady_state.loss"].unit == "J"
    assert listed["steady_state.speed"].over == "steady_state.crank_angle"


def test_scalars_and_curves_of_a_study_are_keys_of_its_answer() -> None:
    for name in ("roller_two_carts", "roller_cam", "rod_rotator_continuous", "topper"):
        found = lw.study(lw.read(f"machines/{name}.toml"))
        told = found.to_dict(curves=True)["results"]
        for each in lw.quantities(found):
            analysis, _, attribute = each.name.rpartition(".")
            assert attribute in told[analysis], each.name


def test_every_result_of_a_study_declares_its_attributes() -> None:
    hints = [*get_type_hints(TorsionStudy).values()]
    hints += [get_type_hints(each.analyse)["return"] for each in ANALYSES if each.function is not None]
    kinds = {kind for hint in hints for kind in (hint, *get_args(hint)) if isinstance(kind, type)}
    results = {kind for kind in kinds if issubclass(kind, Result)}
    assert len(results) > 25
    assert {each.__name__ for each in results if not declared(each)} == set()


def test_a_unit_may_depend_on_the_machine() -> None:
    profile = lw.cam_profile(lw.read("machines/roller_cam.toml"))
    assert {each.name: each.unit for each in lw.quantities(profile)}["lift"] == "m"
    assert {each.name: each.unit for each in lw.quantities(type(profile))}["lift"] == "m or rad"


def test_what_is_no_result_is_refused() -> None:
    with pytest.raises(InputError, match="expected a result, its class, or a study"):
        lw.quantities(3)


def test_words_have_a_translation() -> None:
    """The studio shows all of them in each of its languages."""
    words = {quantity.word for result in RESULTS for quantity in quantities_of(result)}
    said = {word: in_words(word, "uk", "word") for word in words}
    # Names of laws and formulas remain; a word of four small letters is English.
    assert not [word for word, text in said.items() if re.search(r"\b[a-z]{4,}\b", text)]


def test_what_has_no_unit_says_so() -> None:
    line = lw.straight_line("hoeken", 0.2)
    assert (line.unit_of("length"), line.unit_of("exact"), line.unit_of("nothing")) == ("m", "", "")

"""The border to the core: the stub says what is there, parts keep their names, nonsense is refused."""

from __future__ import annotations

import ast
import inspect
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import linkwright as lw
from linkwright import _core
from linkwright.kernel.description import formula
from linkwright.machine import compile_machine

STUB = Path(lw.__file__).with_name("_core.pyi")


def told(body: list[ast.stmt]) -> dict[str, dict[str, Any] | None]:
    found: dict[str, dict[str, Any] | None] = {}
    for node in body:
        if isinstance(node, ast.ClassDef):
            found[node.name] = told(node.body)
        elif isinstance(node, ast.FunctionDef) or (
            isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name)
        ):
            name = node.name if isinstance(node, ast.FunctionDef) else node.target.id  # type: ignore[union-attr]
            if not name.startswith("_"):
                found[name] = None
    return found


def there(where: Any) -> set[str]:
    names = where.__all__ if inspect.ismodule(where) else vars(where)
    return {name for name in names if not name.startswith("_")}


def disagreements(stub: dict[str, Any], where: Any, at: str) -> list[str]:
    wrong = [f"{at}.{name}" for name in stub.keys() ^ there(where)]
    for name, inside in stub.items():
        if inside is not None and hasattr(where, name):
            wrong += disagreements(inside, getattr(where, name), f"{at}.{name}")
    return wrong


def test_the_stub_says_what_is_there() -> None:
    stub = told(ast.parse(STUB.read_text(encoding="utf-8")).body)
    assert disagreements(stub, _core, "_core") == []
    assert disagreements(stub | {"Plan": {"has_law": None}}, _core, "_core")


@pytest.mark.parametrize(
    "kinds",
    [_core.Element, _core.At, _core.What, _core.Body, _core.Motor, _core.Condition, _core.TorqueLaw],
)
def test_arguments_are_the_fields(kinds: Any) -> None:
    """What is built by name is read by the same names, in no order at all."""
    for name in there(kinds):
        kind = getattr(kinds, name)
        fields = there(kind)
        signature = inspect.signature(kind)
        assert set(signature.parameters) == fields, name
        assert {each.kind for each in signature.parameters.values()} <= {inspect.Parameter.KEYWORD_ONLY}


def test_parts_keep_their_values() -> None:
    crank = _core.Element.Crank(sin=6, cos=5, radius=4, pivot=3, link=2, pin=1)
    assert isinstance(crank, _core.Element)
    assert [crank.pin, crank.link, crank.pivot, crank.radius, crank.cos, crank.sin] == [1, 2, 3, 4, 5, 6]
    with pytest.raises(AttributeError):
        crank.pin = 2  # type: ignore[misc]
    with pytest.raises(TypeError):
        _core.Element.Crank(1, 2, 3, 4, 5, 6)  # type: ignore[misc, call-arg]


def plan(*elements: _core.Element, parameters: int = 6) -> _core.Plan:
    """A fixed point 0 and some elements."""
    drive = _core.Drive(motor=None, ratio=0, forward=0, reverse=0, inertia=0, speed_start=0)
    ground = [_core.GroundPoint(point=0, x=0, y=0)]
    return _core.Plan(
        parameters=parameters, ground=ground, elements=list(elements), bodies=[], loads=[], drive=drive
    )


def test_an_element_that_makes_no_sense_is_named() -> None:
    sound = _core.Element.Crank(pin=1, link=0, pivot=0, radius=0, cos=1, sin=2)
    plan(sound)
    twice = r"element 1, a crank: point 1 is made where point 2 is the next"
    with pytest.raises(IndexError, match=twice):
        plan(sound, sound)
    with pytest.raises(
        IndexError, match=r"element 0, a crank: parameter 2 does not exist: there are 2 so far"
    ):
        plan(sound, parameters=2)
    with pytest.raises(OverflowError):
        _core.Element.Crank(pin=-1, link=0, pivot=0, radius=0, cos=1, sin=2)


def test_tables_and_laws_that_make_no_sense_are_refused() -> None:
    with pytest.raises(ValueError, match="knots must be finite and increase"):
        _core.Table([0.0, 0.0], [1.0, 2.0])
    half = _core.Piece(start=0.0, length=3.0, polynomial=[1.0], harmonics=[])
    with pytest.raises(ValueError, match="must follow one another over one revolution"):
        _core.MotionLaw([half])
    with pytest.raises(ValueError, match="no such instruction"):
        _core.Formula([("sine", None)])


@pytest.mark.parametrize(
    "text",
    [
        "sin(phi) + cos(phi) - tan(phi)*asin(x)/acos(y)",
        "atan(vx) + atan2(x, y) + exp(vy) + log(x) + sqrt(s) + tanh(v)",
        "abs(x) + sign(v) + step(s) + min(x, y) + max(x, y) + where(x < y, s, psi)",
        "-psi_dot^2 + x^y + omega + t + pi",
    ],
)
def test_the_core_knows_every_word_of_formulas(text: str) -> None:
    words = [(op, 0 if op == "number" else operand) for op, operand in formula.program(formula.parse(text))]
    known = [("number", 0) if operand == "pi" else (op, operand) for op, operand in words]
    _core.Formula(known)


def test_every_status_has_its_sentence() -> None:
    sentences = dict(_core.Status.sentences())
    names = there(_core.Status) - {"sentences"}
    assert {int(getattr(_core.Status, name)) for name in names} == sentences.keys()
    assert all(len(sentence) > 5 for sentence in sentences.values())
    assert _core.Status.DOES_NOT_CLOSE != _core.Status.OK


def test_loads_with_a_potential_do_not_resist_a_cycle() -> None:
    """Without gravity and springs the mean resistance over the revolution is the same."""
    machine = lw.read("machines/roller_two_carts.toml")
    compiled = compile_machine(machine)
    angles = lw.steady_state(machine, n=4096).crank_angle[:-1]
    whole = compiled.reductions(angles)
    rest = compiled.without_conservative().reductions(angles)
    assert abs((whole.load - rest.load).mean()) < 1e-9 * abs(whole.dry).max()


def test_tables_of_forced_vibration_have_their_axes() -> None:
    """Rows of discs and columns of speeds are not taken for each other, though there are as many numbers."""
    discs, speeds, orders = 2, 3, 1
    table = np.ones((discs, speeds))
    tables = dict.fromkeys(("stiffness", "damping", "loss", "disc_damping"), table)

    def solve(**other: Any) -> Any:
        given = {"torques": np.ones((orders, discs, speeds), complex)} | tables | other
        _core.torsion_forced(
            parent=np.array([0, 0], np.int32),
            inertia=np.ones(discs),
            speeds=np.arange(1.0, speeds + 1),
            orders=np.ones(orders),
            **given,
        )
        return given["torques"]

    assert np.isfinite(solve()).all()
    for wrong in ({"torques": np.ones((orders, speeds, discs), complex)}, {"loss": table.T.copy()}):
        with pytest.raises(ValueError, match="a place for every disc and speed"):
            solve(**wrong)


def test_systems_of_equations_are_solved_side_by_side() -> None:
    """Against LAPACK one by one; one without a solution leaves the others as they are."""
    rng = np.random.default_rng(3)
    matrix, right = rng.normal(size=(6, 6, 21)), rng.normal(size=(2, 6, 21))
    # Pivots are needed: the diagonal is zero in every second system.
    matrix[np.arange(6), np.arange(6), ::2] = 0.0
    matrix[:, 4, 5] = 0.0
    found = right.copy()
    _core.solve_systems(matrix, found)
    for k in range(21):
        if k == 5:
            assert not np.isfinite(found[..., k]).all()
        else:
            exact = np.linalg.solve(matrix[..., k].T, right[..., k].T).T
            # Rounding times a condition of some hundreds.
            np.testing.assert_allclose(found[..., k], exact, rtol=0, atol=1e-12 * np.abs(exact).max())


@pytest.mark.parametrize("shape", [(2, 5, 21), (2, 6, 20)])
def test_right_sides_of_another_shape_are_refused(shape: tuple[int, int, int]) -> None:
    with pytest.raises(IndexError, match="6 by 6 by 21 numbers"):
        _core.solve_systems(np.ones((6, 6, 21)), np.ones(shape))

"""Wrong numbers and arrays end in errors of Linkwright that name the argument, at every public function."""

from __future__ import annotations

import contextlib
import copy
import dataclasses
import inspect
import pickle
import re
import warnings
from collections.abc import Callable, Iterator
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.exceptions import ComplexWarning

import linkwright as lw
from linkwright import InputError, LinkwrightError, MachineError, ShapeError, SteadyStateError
from linkwright.cam import MotionLaw
from linkwright.kernel.public.arguments import checks_of
from linkwright.machine import dumps as lw_dumps
from linkwright.papers.published_lengths import PAPER

TURN = np.linspace(0.0, 6.0, 7)


@cache
def _machine(name: str) -> lw.Machine:
    return lw.read(f"machines/{name}.toml")


@cache
def _profile() -> Any:
    return lw.cam_profile(_machine("roller_cam"), n=90)


def _law() -> MotionLaw:
    found: MotionLaw = _machine("roller_cam").mechanism.cams["cart"].motion.lift
    return found


@cache
def right_calls() -> dict[str, tuple[Callable[..., Any], dict[str, Any]]]:
    cart, cam, engine = (_machine(name) for name in ("roller_one_cart", "roller_cam", "v8_diesel"))
    topper, rotator = _machine("topper"), _machine("rod_rotator_continuous")
    one_mass = lw.OneMass(1.0, 100.0, 0.05)
    follower = lw.FollowerLoad(1.0, 1e4, 100.0)
    rise = _law()
    lift = tuple(rise.at(TURN, k) for k in range(3))
    calls: dict[str, dict[str, Any]] = {
        "Friction": {"coefficient": 0.1, "radius": 0.01, "viscous": 0.0, "length": 0.0},
        "OneMass": {"mass": 1.0, "stiffness": 100.0, "damping_ratio": 0.05, "preload": 0.0},
        "FollowerLoad": {"mass": 1.0, "spring_rate": 1e4, "preload": 100.0, "damping": 0.0, "load": TURN},
        "StemGuide": {"length": 0.1, "overhang": 0.05, "coefficient": 0.1, "diameter": 0.01},
        "ArmPivot": {"arm": 0.1, "coefficient": 0.1, "radius": 0.01},
        "Material": {"modulus": 206e9, "poisson": 0.3},
        "addresses": {"machine": cart},
        "get": {"machine": cart, "address": "drive"},
        "replace": {"machine": cart, "entries": {"bodies.cart1.mass": 500.0}},
        "read": {"path": "machines/topper.toml", "overrides": (), "allow_outside": False},
        "loads": {"text": "format = 1", "overrides": (), "path": "", "allow_outside": False},
        "kinematics": {"machine": cart, "angles": TURN, "third": False},
        "mjcf": {
            "machine": cart,
            "angle": 0.1,
            "speed": 3.0,
            "speed_start": 0.0,
            "step": 1e-3,
            "leave_out": ("gravity",),
        },
        "urdf": {"machine": cart, "angle": 0.1, "n": 12},
        "motions": {"machine": cart, "angles": TURN, "slides": ["cart1"], "out": None},
        "coupler_curve": {"machine": cart, "point": "A1", "straight": 0.001},
        "centrodes": {"machine": cart, "link": "cart1.rod", "angles": [0.5, 1.0]},
        "pose": {"machine": cart, "crank_angle": 1.0, "speed": 2.0, "acceleration": 3.0},
        "motion": {"machine": cart, "law": (TURN, TURN), "times": TURN},
        "reduction": {"machine": cart, "n": 8},
        "steady_state": {"machine": cart, "accuracy": 1e-8, "n": 8, "angles": TURN},
        "transient": {
            "machine": cart,
            "angle": 0.1,
            "speed": 1.0,
            "duration": 0.1,
            "turns": 0.1,
            "accuracy": 1e-6,
        },
        "step_method": {"machine": cart, "step": np.radians(1)},
        "forces": {
            "machine": cart,
            "speed": 1.0,
            "acceleration": 0.0,
            "angles": TURN,
            "n": 8,
            "pressure_angle": 0.3,
        },
        "balance": {"machine": cart, "links": ["A1"], "speed": 1.0, "radius": 0.1, "n": 16},
        "partial_balance": {
            "machine": cart,
            "slider": "cart1",
            "share": 0.5,
            "speed": 1.0,
            "radius": 0.1,
            "n": 16,
        },
        "harmonics": {"crank_angle": np.linspace(0, 2 * np.pi, 17), "values": np.ones(17), "order": 2},
        "cam_profile": {"machine": cam, "n": 90},
        "loaded_cam": {"machine": cam, "profile": _profile(), "speed": 1.0},
        "search_cams": {"machine": cam, "entries": {"base_radius": [0.3, 0.4]}, "law": None, "per_turn": 16},
        "follower_vibration": {"lift": rise, "model": one_mass, "speed": 1.0, "n": 16},
        "vibration_over_speed": {"lift": rise, "model": one_mass, "speeds": [1.0, 2.0]},
        "residual_spectrum": {
            "rise": rise,
            "ratio": [1.0, 2.0],
            "damping_ratio": 0.0,
            "damping_ratio_frame": 0.0,
            "share": 1.0,
        },
        "residual_over_speed": {"rise": rise, "model": one_mass, "speed": [5.0, 6.0]},
        "cam_course": {
            "cam_angle": TURN,
            "lift": lift,
            "speed": 1.0,
            "pressure_angle": 0.0,
            "sliding": 0.0,
            "offset": 0.0,
            "acceleration": 0.0,
        },
        "contact_force": {
            "course": lw.cam_course(TURN, lift, 1.0),
            "follower": follower,
            "friction": 0.0,
            "clearance": 0.0,
        },
        "least_preload": {"lift": rise, "follower": follower, "speed": 1.0, "contact": 0.0},
        "line_contact": {"force": 1.0, "radius": 0.1, "radius_other": 0.2, "length": 0.1},
        "pumping_unit": {"machine": rotator, "n": 16},
        "rod_rotator": {"machine": rotator, "n": 16},
        "length_verdict": {"claim": PAPER, "edge_angle": 0.2, "diameter": 0.1, "offset": 0.02},
        "sweep_field": {"machine": topper, "over": {"edge_length": [0.2, 0.3]}, "level": 0.9},
        "holzer_table": {"machine": engine, "frequency": 10.0},
        "forced_vibration": {"machine": engine, "speeds": [100.0, 150.0]},
        "torsion_study": {"machine": engine, "holzer": [10.0]},
        "waterfall": {
            "time": np.linspace(0, 20, 2001),
            "angle": np.linspace(0, 500, 2001),
            "signal": np.ones(2001),
            "highest": 4.0,
            "step": 0.5,
            "turns": 8,
        },
        "mesh_torques": {"machine": engine, "speeds": [100.0, 150.0]},
        "measured_speed": {
            "disc": "d",
            "samples": np.ones(64),
            "turns": 2,
            "orders": [0.5, 1.0],
            "noise": 0.1,
        },
        "engine_data": {"engine": engine.train.engine, "speed": 100.0},
        "damped_vibration": {"machine": engine, "speed": 100.0},
        "campbell": {"source": engine, "orders": [0.5, 1.0], "speed_range": (120.0, 150.0)},
        "scheme": {"machine": engine, "diameter": 0.1},
        "steady_states": {
            "machine": cart,
            "entries": {"bodies.cart1.mass": [500.0, 510.0]},
            "accuracy": 1e-8,
        },
        "choose_flywheel": {"machine": cart, "unevenness": 0.2},
        "crank_rocker": {"swing": 1.0, "time_ratio": 1.1, "frame": 1.0, "coupler_max": 3.0},
        "slider_crank": {"stroke": 1.0, "time_ratio": 1.1, "rod": None},
        "straight_line": {"kind": "hoeken", "length": 1.0, "crank_range": (-1.0, 1.0)},
        "straight_lines": {"length": 1.0},
    }
    return {name: (getattr(lw, name), call) for name, call in calls.items()}


def _unaligned() -> np.ndarray:
    return np.frombuffer(b"\0" + np.linspace(1.0, 2.0, 4).tobytes(), dtype=np.uint8)[1:].view(np.float64)


WRONG: dict[str, Any] = {
    "nan": np.nan,
    "infinite": np.inf,
    "complex": 1 + 2j,
    "text": "abc",
    "none": None,
    "truth": True,
    "object": object(),
    "empty": [],
    "ragged": [[1.0, 2.0], [3.0]],
    "texts": ["a", "b"],
    "nothings": [None, None],
    "complex array": np.array([1 + 2j, 3.0]),
    "not finite": [1.0, np.nan],
    "table": np.ones((2, 2)),
    "three dimensions": np.ones((2, 2, 2)),
    "array of one number": np.array(1.0),
    "unaligned": _unaligned(),
    "every other": np.linspace(1.0, 2.0, 8)[::2],
    "backwards": np.linspace(1.0, 2.0, 5)[::-1],
    "single precision": np.linspace(1.0, 2.0, 4, dtype=np.float32),
    "big-endian": np.linspace(1.0, 2.0, 4).astype(">f8"),
    "huge": 2**5000,
    "huge in size": 1e308,
    "tiny": 5e-324,
    "negative": -1.0,
    "zero": 0,
    "dictionary": {"a": 1.0},
    "bytes": b"abc",
    "times": np.array(["2020-01-01"], dtype="datetime64[s]"),
}


def _cases() -> Iterator[tuple[str, str]]:
    for name, (function, call) in right_calls().items():
        checked = checks_of(inspect.unwrap(function))
        for argument in call:
            if argument in checked or argument in ("entries", "over", "law", "out"):
                yield name, argument


def _misused(name: str, argument: str, value: Any) -> None:
    function, call = right_calls()[name]
    given = call[argument]
    if isinstance(given, dict):
        value = {next(iter(given)): value}
    with contextlib.suppress(LinkwrightError):
        function(**{**call, argument: value})


@pytest.mark.parametrize(("name", "argument"), list(_cases()))
def test_misuse(name: str, argument: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error", ComplexWarning)
        for word, value in WRONG.items():
            try:
                _misused(name, argument, value)
            except Exception as error:
                raise AssertionError(f"{name}({argument}={word}): {type(error).__name__}: {error}") from error


def _open_parts(value: Any, place: str) -> Iterator[str]:
    if isinstance(value, np.ndarray):
        if value.flags.writeable:
            yield place
    elif isinstance(value, dict):
        if type(value) is dict:
            yield place
        for key, each in value.items():
            yield from _open_parts(each, f"{place}[{key}]")
    elif isinstance(value, tuple):
        for i, each in enumerate(value):
            yield from _open_parts(each, f"{place}[{i}]")
    elif dataclasses.is_dataclass(value):
        for field in dataclasses.fields(value):
            yield from _open_parts(getattr(value, field.name), f"{place}.{field.name}")


# Parts of a machine, and what a number or a table in its place must do.
PLACES = ("mechanism.cranks.A1", "mechanism.cranks.A1.radius", "bodies", "drive.motor.kind", "loads", "name")


@pytest.mark.parametrize("address", PLACES)
def test_whatever_is_put_into_a_machine_is_refused_by_its_address_or_can_be_used(address: str) -> None:
    for word, value in WRONG.items():
        try:
            changed = lw.replace(_machine("roller_one_cart"), {address: value})
            lw.steady_state(changed, n=8)
        except LinkwrightError:
            continue
        except Exception as error:
            raise AssertionError(f"{address} = {word}: {type(error).__name__}: {error}") from error


def test_a_table_that_is_put_into_a_machine_is_checked() -> None:
    cart = _machine("roller_one_cart")
    given = {"radius": 0.31, "phase": 0.1}
    assert lw.get(lw.replace(cart, {"mechanism.cranks.A1": given}), "mechanism.cranks.A1.radius") == 0.31
    for wrong, key in (({"radius": "x"}, "radius"), ({"radius": 1.0, "foo": 2}, "foo")):
        with pytest.raises(MachineError, match=rf"^mechanism\.cranks\.A1\.{key}\n"):
            lw.replace(cart, {"mechanism.cranks.A1": wrong})


@pytest.mark.parametrize(
    ("address", "value"),
    [
        ("drive.gearbox.efficiency", 1.0001),
        ("drive.gearbox.efficiency", -1),
        ("bodies.cart1.mass", -5.0),
        ("mechanism.cranks.A1.radius", -0.1),
        ("drive.motor.inertia", -3.0),
    ],
)
def test_a_number_out_of_the_range_of_its_entry_is_refused(address: str, value: float) -> None:
    """A gearbox that drives with an efficiency of −1 gave δ = 0.161; a crank of −0.1 m among many moved."""
    told = rf"^{re.escape(address)}\n  found:    {value:g}\n  expected: "
    for given in (value, np.array([0.5, value]), np.array([np.nan, value])):
        with pytest.raises(MachineError, match=told):
            lw.replace(_machine("roller_two_carts"), {address: given})


@pytest.mark.parametrize("value", [None, 1j, [[1.0], [1.0, 2.0]], np.nan, b"abc", {"a": 1}])
def test_what_is_written_and_where_is_named(value: Any, tmp_path: Path) -> None:
    cart = _machine("roller_one_cart")
    for function, right in ((lw.write, cart), (lw.write_report, lw.study(cart))):
        name = next(iter(inspect.signature(function).parameters))
        with pytest.raises(InputError, match=rf"^{name}: found "):
            function(value, tmp_path / "file")
        with pytest.raises(InputError, match=r"^path: found "):
            function(right, value)


@pytest.mark.parametrize("name", sorted(right_calls()))
def test_results_stay_as_they_are_and_can_be_pickled(name: str) -> None:
    function, call = right_calls()[name]
    if name == "loads":
        call = {**call, "text": lw_dumps(_machine("roller_one_cart"))}
    result = function(**call)
    again = pickle.loads(pickle.dumps(result))
    assert type(again) is type(result)
    if not isinstance(result, np.ndarray | dict):
        assert result == again == copy.deepcopy(result)
        # What a terminal shows when the name of a result is typed.
        assert len(repr(result)) < 20_000
    if dataclasses.is_dataclass(result):
        assert not list(_open_parts(result, name))


@pytest.mark.parametrize("name", ["roller_cam", "roller_two_carts", "v8_diesel", "topper_crank"])
def test_machines_stay_as_they_are_and_can_be_pickled(name: str) -> None:
    machine = _machine(name)
    assert pickle.loads(pickle.dumps(machine)) == machine == copy.deepcopy(machine)
    for table in (machine.bodies, machine.loads, machine.mechanism.cranks):
        with pytest.raises(TypeError, match="immutable"):
            table.clear()


def test_a_study_of_a_cam_can_be_pickled() -> None:
    study = lw.study(_machine("roller_cam"))
    again = pickle.loads(pickle.dumps(study))
    assert again.to_dict() == study.to_dict()
    assert again == study
    assert len(repr(study)) < 20_000


def test_results_that_differ_in_one_number_of_an_array_are_not_equal() -> None:
    first = lw.reduction(_machine("roller_one_cart"), n=8)
    other = pickle.loads(pickle.dumps(first))
    assert first == other
    curve = np.array(other.inertia_reduced)
    curve[3] += 1.0
    assert first != dataclasses.replace(other, inertia_reduced=curve)
    assert first != lw.reduction(_machine("roller_one_cart"), n=9)
    assert first != 3


# Annotations of arguments that their function looks at itself: one of several unlike things.
_OWN = {
    "Any",
    "Bearing | None",
    "Law | Callable[[Any], Any] | Sequence[ArrayLike]",
    "NDArray[np.float64] | None",
}


def _arguments() -> Iterator[tuple[str, str, str, Callable[[str, Any], Any] | None]]:
    for name in dir(lw):
        member = getattr(lw, name)
        is_error = inspect.isclass(member) and issubclass(member, Exception)
        if name.startswith("_") or not callable(member) or member is lw.Machine or is_error:
            continue
        function = inspect.unwrap(member.__init__ if inspect.isclass(member) else member)
        checks = checks_of(function)
        for each in list(inspect.signature(function).parameters.values())[inspect.isclass(member) :]:
            yield name, each.name, str(each.annotation), checks.get(each.name)


def test_no_argument_goes_unchecked() -> None:
    found = {f"{name}.{argument}: {kind}" for name, argument, kind, check in _arguments() if check is None}
    assert {each for each in found if each.partition(": ")[2] not in _OWN} == set()


@pytest.mark.parametrize("wrong", [3, 1j, object(), [3], b"abc"], ids=lambda value: type(value).__name__)
def test_what_is_of_another_class_is_named(wrong: Any) -> None:
    """A number in place of a study, a motion, a profile, a list of names."""
    classes = ("Machine", "Study", "StudyPlan", "Transient", "CamProfile", "Sequence[str]", "Iterable[str]")
    several = 0
    for _, argument, kind, check in _arguments():
        if check is not None and kind.partition(" | ")[0] in classes:
            with pytest.raises(InputError, match=f"^{argument}: found"):
                check(argument, wrong)
            several += 1
    assert several > 70
    # One text is not the list of its letters.
    with pytest.raises(InputError, match=r"responses: found .steady_state.period., expected a list of texts"):
        lw.gradient(_machine("roller_one_cart"), "steady_state.period")


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (
            lambda: lw.front(_study(), method=np.arange(3)),
            r'^method: .* one of "both"',
        ),
        (lambda: lw.optimise(_study(), method="best"), "^method: found 'best'"),
        (lambda: lw.optimise(_study(), seed=-1), "^seed: found -1"),
        # As long as a generator of another library takes.
        (lambda: lw.optimise(_study(), seed=2**32), "^seed: found 4294967296"),
        (lambda: lw.optimise(_study(), watch=3), "^watch: found 3, expected a function$"),
        (lambda: lw.choose_motor(_machine("roller_one_cart"), track=3), "^track: found 3"),
        (lambda: lw.choose_motor(_machine("roller_one_cart"), by=None), "^by: found None"),
        (lambda: lw.sweep(_study(), "rows", chunks="0:1"), "^chunks: found '0:1'"),
        (lambda: lw.sweep(_study(), "rows", chunks=(0, 1, 2)), "^chunks: found"),
        (lambda: lw.choose_motor(_machine("roller_one_cart"), catalogue=[3]), "^catalogue: found"),
        (lambda: lw.read_servo_motors(3), "^path: found 3"),
        (lambda: lw.choose_servo(3, (), ()), "^cycle: found 3"),
        (lambda: lw.read_motors(3), "^path: found 3"),
        (lambda: lw.gradient(_machine("roller_one_cart"), []), "^responses: found an empty list"),
    ],
)
def test_words_functions_and_pairs_are_checked(call: Callable[[], Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        call()


@contextlib.contextmanager
def _strict() -> Iterator[None]:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


@cache
def _study() -> Any:
    variables = {"ratio": {"address": "drive.gearbox.ratio", "range": [9.0, 10.0], "steps": 2}}
    tables = {"variables": variables, "responses": {"delta": "steady_state.unevenness"}}
    return lw.new_study(_machine("roller_one_cart"), {**tables, "goals": {"delta": "minimise"}})


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: lw.evaluate(_study(), {"ratio": 1.0}), r"^variables\[ratio\]: found"),
        (lambda: lw.evaluate(_study(), {"ratio": {"b": 1}}), r"^variables\[ratio\]: found"),
        (lambda: lw.evaluate(_study(), {"other": [9.5]}), "^variables: found other, .* of the study: ratio$"),
        (lambda: lw.evaluate(_study(), {"ratio": [np.nan]}), r"^variables\[ratio\]: found nan"),
        (
            lambda: lw.load_cases(_machine("roller_one_cart"), {"a": 1.0}),
            r"^cases\[a\]: found 1.0, .* names$",
        ),
        (
            lambda: lw.mechanism_harmonics(_machine("roller_one_cart"), 1e308, [1.0]),
            r"^speed: found 1e\+308",
        ),
        (
            lambda: lw.mechanism_harmonics(_machine("roller_one_cart"), 1.0, [1e308]),
            r"^orders: found 1e\+308",
        ),
        (
            lambda: lw.mechanism_harmonics(_machine("roller_one_cart"), np.zeros(10**6), [1.0]),
            "^speed: found 0 at index 0, .{0,80}$",
        ),
        (
            lambda: lw.loaded_cam(_machine("roller_one_cart"), _profile(), 1.0),
            '^profile: found that of cam "cart", expected one of the machine: none$',
        ),
        (
            lambda: lw.motion(_machine("roller_one_cart"), (TURN, TURN), [-1e308, 1e308]),
            r"^times: found -?1e\+308",
        ),
        (lambda: lw.read("\ud800.toml"), "^path: found .* name of a file$"),
        (lambda: lw.write(_machine("roller_one_cart"), "\ud800.toml"), "^path: found .* name of a file$"),
    ],
)
def test_what_is_inside_of_mappings_and_lists_is_named(call: Callable[[], Any], words: str) -> None:
    with _strict(), pytest.raises(InputError, match=words):
        call()


def test_a_table_of_another_library_is_no_law() -> None:
    """It has something by the name `at` that is no function."""

    class Frame:
        at = 3

    with pytest.raises(LinkwrightError):
        lw.motion(_machine("roller_one_cart"), Frame(), [0.0, 1.0])


def test_no_inertia_in_a_dwell_is_said_without_a_warning() -> None:
    """The follower of this valve has inertia, its shaft none: in the dwell nothing is there to be turned."""
    valve = lw.read("examples/cam_oscillating_valve/machine.toml")
    with _strict(), pytest.raises(SteadyStateError, match="reduced inertia falls to zero"):
        lw.constant_energy(valve)


@pytest.mark.parametrize("angles", [[7.0], [-1.0], [0.0, 100.0]])
def test_curves_of_a_cycle_are_asked_for_within_it(angles: list[float]) -> None:
    """Beyond its ends the series of a solution are any number."""
    with pytest.raises(InputError, match=r"angles: found .* from 0 to 6\.28319 rad"):
        lw.steady_state(lw.read("roller_one_cart"), angles=np.array(angles))


MISUSES = {
    "angles beside a motion": lambda m: lw.forces(m, lw.steady_state(m), angles=[1.0]),
    "a plane beyond any machine": lambda m: lw.balance(m, links=["A"], planes=[1e300]),
    "no speeds": lambda m: lw.mechanism_harmonics(m, speed=[], orders=1.0),
    "no speeds of damping": lambda m: lw.station_damping(m, speed=[]),
    "a law that is a text": lambda m: lw.motion(m, lambda t: "a", [1.0, 2.0]),
    "a measured curve that is a number": lambda _: lw.torsion_study(lw.read("v8_diesel"), measured={"a": 1}),
}


@pytest.mark.parametrize("misuse", MISUSES)
def test_misuses_are_named(misuse: str) -> None:
    with pytest.raises(InputError):
        MISUSES[misuse](lw.read("roller_one_cart"))


def test_crank_angles_without_digits_and_masks_are_refused() -> None:
    machine = lw.read("roller_one_cart")
    for compute in (partial(lw.kinematics, machine), partial(lw.forces, machine, speed=1.0)):
        name = "angles"
        with pytest.raises(InputError, match=r"found 1e\+300 rad at index 1, expected at most 100000 rad"):
            compute(**{name: [0.0, 1e300]})
        with pytest.raises(ShapeError, match="masked"):
            compute(**{name: np.ma.array([0.0, 1.0], mask=[False, True])})
        compute(**{name: np.ma.array([0.0, 1.0], mask=[False, False])})

"""The scheme of a train as a drawing: everything is there, nothing lies over something else."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.transforms import Bbox
from sizes import cases
from trains import Gear, Shaft, text

import linkwright as lw
from linkwright import scheme
from linkwright.kernel.figure.svg import svg
from linkwright.torsion import Scheme, scheme_figure

THROWS = {"hub": 0.8, **{f"throw_{n}": 1.35 for n in range(1, 13)}, "flywheel": 38.0, "propeller": 52.0}
MARINE = {"engine_1": 420.0, "hub_1": 35.0, "pinion_1": 12.0, "wheel": 310.0, "thrust": 40.0}
MARINE |= {"propeller": 2600.0, "pinion_2": 12.0, "hub_2": 35.0, "engine_2": 420.0, "pinion_3": 4.0}
MARINE |= {"generator": 55.0}

TRAINS = {
    "chain": text(THROWS, [(a, b, 12.35e6) for a, b in zip(THROWS, list(THROWS)[1:], strict=False)]),
    "marine": text(
        MARINE,
        [
            ("engine_1", "hub_1", 4e7),
            ("hub_1", "pinion_1", 1.6e6),
            ("wheel", "thrust", 9e7),
            ("thrust", "propeller", 6e6),
            ("engine_2", "hub_2", 4e7),
            ("hub_2", "pinion_2", 1.6e6),
            ("pinion_3", "generator", 2.2e5),
        ],
        [
            ("pinion_1", "wheel", 3.55, None),
            ("pinion_2", "wheel", 3.55, None),
            ("wheel", "pinion_3", 0.2, 3e6),
        ],
    ),
    "held": text(
        {"a": 2.0, "b": 5.0, "c": 0.3},
        [("ground", "a", 3e4), ("a", "b", 1e5), ("b", "c", 2e4), ("c", "ground", 9e3), ("b", "ground", 1e4)],
    ),
    "ring": text({f"d{n}": 2.0 for n in range(6)}, [(f"d{n}", f"d{(n + 1) % 6}", 5e4) for n in range(6)]),
    "parallel": text({"a": 2.0, "b": 5.0}, [("a", "b", 3e4), ("a", "b", 1e5), ("b", "a", 2e4)]),
    "star": text({"hub": 1.0, **dict.fromkeys("abcde", 2.0)}, [("hub", each, 1e4) for each in "abcde"]),
    "gears in a loop": text(
        {"pinion": 0.1, "left": 0.3, "right": 0.3, "wheel": 5.0, "load": 7.0},
        [("wheel", "load", 2e5)],
        [
            ("pinion", "left", 2.0, 4e5),
            ("pinion", "right", 2.0, 4e5),
            ("left", "wheel", 3.0, 9e5),
            ("right", "wheel", 3.0, 9e5),
        ],
    ),
    "alone": text({"a": 2.0}, []),
    "thirty": text(
        {f"disc_{n}": 1.0 + n % 5 for n in range(30)},
        [(f"disc_{n}", f"disc_{n + 1}", 1e4 * (1 + n % 3)) for n in range(29)],
    ),
    "damped": text({"a": 2.0, "b": 7.0, "c": 3.0}, [("a", "b", 3.4e4), ("b", "c", 3.4e4)])
    + '[train.dampers.houde]\non = "a"\nring_inertia = 0.4\ndamping = 20\n'
    + '[train.dampers.rubber]\non = "b"\nkind = "tuned"\nring_inertia = 0.3\nstiffness = 2e3\n',
}


def found(name: str) -> Scheme:
    return scheme(lw.loads(TRAINS[name]))


def words(figure: Figure) -> dict[str, list[Bbox]]:
    figure.canvas.draw()
    boxes: dict[str, list[Bbox]] = {}
    for each in figure.axes[0].texts:
        if each.get_text():
            box = each.get_window_extent().transformed(figure.dpi_scale_trans.inverted())
            boxes.setdefault(each.get_text(), []).append(box)
    return boxes


def overlaps(figure: Figure) -> list[tuple[str, str]]:
    boxes = [(name, box) for name, listed in words(figure).items() for box in listed]
    to_inches = figure.axes[0].transData + figure.dpi_scale_trans.inverted()
    bars = [each for each in figure.axes[0].patches if isinstance(each, Rectangle)]
    solid = [("a disc", each.get_bbox().transformed(to_inches)) for each in bars]
    pairs = [*combinations(boxes, 2), *((a, b) for a in boxes for b in solid)]
    wrong = []
    for (name, a), (other, b) in pairs:
        shared = Bbox.intersection(a, b)
        # Boxes hold some air above and below the letters.
        if shared is not None and min(shared.width, shared.height) > 0.03:
            wrong.append((name, other))
    return wrong


@pytest.mark.parametrize("name", TRAINS)
def test_nothing_lies_over_something_else(name: str) -> None:
    figure = scheme_figure(found(name))
    assert overlaps(figure) == []
    width, height = figure.get_size_inches()
    for text_, boxes in words(figure).items():
        for box in boxes:
            assert box.x0 > 0, text_
            assert box.y0 > 0, text_
            assert box.x1 < width, text_
            assert box.y1 < height, text_


@pytest.mark.parametrize("name", TRAINS)
def test_everything_is_named_with_its_numbers(name: str) -> None:
    it = found(name)
    written = " ".join(words(scheme_figure(it)))
    for disc, J in zip(it.discs, it.inertia, strict=True):
        assert disc in written
        assert f"{J:.4g} kg m²" in written
    for each in it.connections:
        assert each.name in written


def test_numbers_of_the_scheme() -> None:
    """Behind a gear of 4 inertias and stiffnesses count a sixteenth; L = G I_p/k of a shaft of 100 mm."""
    it = scheme(lw.loads(text({"a": 2.0, "b": 0.5, "c": 8.0}, [("b", "c", 3e5)], [("a", "b", 4.0, None)])))
    assert it.speed == pytest.approx([1, 0.25, 0.25])
    assert it.inertia_referred == pytest.approx([2.0, 0.5 / 16, 0.5])
    shaft, gears = it.connections
    assert (shaft.kind, shaft.stiffness, gears.kind, gears.ratio) == (
        "shaft",
        pytest.approx(3e5),
        "gears",
        4.0,
    )
    assert shaft.stiffness_referred == pytest.approx(3e5 / 16)
    assert shaft.equivalent_length == pytest.approx(79.3e9 * np.pi * 0.1**4 / 32 / (3e5 / 16))
    assert it.to_dict()["connections"][1]["name"] == "g0"


def test_bars_are_as_high_as_discs_of_one_thickness() -> None:
    figure = scheme_figure(scheme(lw.loads(text({"a": 16.0, "b": 1.0}, [("a", "b", 1e4)]))))
    first, second = (each.get_height() for each in figure.axes[0].patches if isinstance(each, Rectangle))
    assert first / second == pytest.approx(2)


def test_soft_shafts_are_longer() -> None:
    """Lengths as the compliances, where words leave room; one that is far softer is cut short."""
    discs = dict.fromkeys("abcdef", 1.0)
    shafts: list[Shaft] = [("a", "b", 9e4), ("b", "c", 3e4), ("c", "d", 2e4), ("d", "e", 1.5e4)]
    shafts.append(("e", "f", 10.0))
    figure = scheme_figure(scheme(lw.loads(text(discs, shafts))))
    x = [each.get_x() for each in figure.axes[0].patches if isinstance(each, Rectangle)]
    ab, bc, cd, de, ef = np.diff(x)
    assert de / cd == pytest.approx(2 / 1.5)
    assert ab <= bc + 1e-9
    assert bc <= cd + 1e-9
    assert ef == pytest.approx(2.5 * cd, rel=0.1)


def test_every_run_draws_the_same() -> None:
    assert svg(scheme_figure(found("marine"))) == svg(scheme_figure(found("marine")))


@st.composite
def branched(draw: st.DrawFn) -> str:
    """Trains without loops, of shafts and gears, some held."""
    n = draw(st.integers(1, 16))
    discs = {f"d{j}": draw(st.sampled_from([0.05, 1.0, 30.0])) for j in range(n)}
    shafts: list[Shaft] = []
    gears: list[Gear] = []
    for j in range(1, n):
        other = f"d{draw(st.integers(max(0, j - 4), j - 1))}"
        if draw(st.integers(0, 2)):
            shafts.append((f"d{j}", other, draw(st.sampled_from([1e3, 3e4, 1e6]))))
        else:
            gears.append((f"d{j}", other, draw(st.sampled_from([0.25, 1.0, 3.0])), None))
    if draw(st.booleans()):
        shafts.append((f"d{draw(st.integers(0, n - 1))}", "ground", 5e4))
    return text(discs, shafts, gears)


@given(branched())
@settings(max_examples=cases(15, 150), deadline=None)
def test_any_tree_is_drawn_clean(case: str) -> None:
    it = scheme(lw.loads(case))
    figure = scheme_figure(it)
    bars = [each for each in figure.axes[0].patches if isinstance(each, Rectangle)]
    places = {(round(each.get_x(), 6), round(each.get_y() + each.get_height() / 2, 6)) for each in bars}
    assert len(places) == len(it.discs)
    assert overlaps(figure) == []

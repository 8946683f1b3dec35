"""The widget of a notebook, without one: its traits, and the module that the browser's tests import."""

import re
import struct
from base64 import b64decode

import numpy as np
import pytest

import linkwright as lw
from linkwright import FindingError, InputError
from linkwright.studio.widget import LAYERS, module


def test_traits_hold_the_scene_of_the_studio() -> None:
    machine = lw.read("roller_two_carts")
    drawing = lw.widget(machine, layers=("forces",), height=300)
    length = struct.unpack_from("<II", drawing.scene)[1]
    text = drawing.scene[8 : 8 + length].decode()
    first, count = map(int, re.search(r'"angles":\{"\$":\[(\d+),(\d+)\]', text).groups())  # type: ignore[union-attr]
    angles = np.frombuffer(drawing.scene, dtype="<f8", offset=8 + length)[first : first + count]
    assert angles[-1] == pytest.approx(2 * np.pi)
    assert (drawing.angle, drawing.playing, drawing.layers, drawing.height) == (0.0, False, ["forces"], 300)
    assert {"scene", "angle", "playing", "layers", "height"} <= set(drawing.keys)


def test_where_nothing_moves_it_is_a_picture() -> None:
    drawing = lw.widget(lw.read("roller_two_carts"))
    shown, _ = drawing._repr_mimebundle_()
    assert "application/vnd.jupyter.widget-view+json" in shown
    assert b64decode(shown["image/png"]).startswith(b"\x89PNG")


def test_another_machine_is_another_scene() -> None:
    machine = lw.read("roller_two_carts")
    drawing = lw.widget(machine)
    scenes: list[bytes] = []
    drawing.observe(lambda change: scenes.append(change["new"]), "scene")
    drawing.machine = lw.replace(machine, {"mechanism.cranks.A1.radius": 0.21})
    assert len(scenes) == 1
    assert drawing.machine.mechanism.cranks["A1"].radius == 0.21


def test_what_does_not_move_is_no_drawing_and_leaves_the_old_one() -> None:
    drawing = lw.widget(lw.read("roller_two_carts"))
    with pytest.raises(FindingError, match="no drawing"):
        drawing.machine = lw.read("topper")
    assert drawing.machine.name == lw.read("roller_two_carts").name


def test_wrong_layers_heights_and_languages_are_refused() -> None:
    machine = lw.read("roller_two_carts")
    with pytest.raises(InputError, match="velocities"):
        lw.widget(machine, layers=("speed",))
    with pytest.raises(InputError, match="height: found 3"):
        lw.widget(machine, height=3)
    with pytest.raises(InputError):
        lw.widget(machine, language="xx")
    assert lw.widget(machine, language="uk").words["angle"] == "Кут кривошипа"


def test_the_module_is_one_and_names_in_it_are_unique() -> None:
    text = module()
    assert not re.search(r"^import ", text, re.MULTILINE)
    assert re.findall(r"^export .*", text, re.MULTILINE) == ["export default { render };"]
    names = re.findall(r"^(?:function|const|let|class) (\w+)", text, re.MULTILINE)
    assert len(names) == len(set(names))
    assert all(f"layers.{layer}" in text or f'"{layer}"' in text for layer in LAYERS)

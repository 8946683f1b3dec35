"""Keys of older files, `least` and `greatest` for `min` and `max`: read with the same meaning."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import linkwright as lw
from linkwright import MachineFileError
from linkwright.kernel.description.place import former_keys
from linkwright.machine import dumps
from linkwright.studies import Distribution
from linkwright.topping.model.scatter import NormalScatter, UniformScatter
from linkwright.torsion import ShaftLimit

FIELD = """
format = 1
name = "topper"
[topper]
edge_angle = "60 deg"
edge_length = "0.2 m"
forward_speed = "1.9 m/s"
knife_speed = "0.55 m/s"
root_diameter = "110 mm"
cut_height = "30 mm"
offset = "20 mm"

[topper.motion]
kind = "harmonic"
stroke = "60 mm"

[topper.field]
kind = "random"
root_diameter = "110 mm"

[topper.field.cut_height]
kind = "uniform"
min = "10 mm"
max = "50 mm"
"""
PAIRS = {"min": "least", "max": "greatest"}


def older(text: str) -> str:
    for key, former in PAIRS.items():
        text = re.sub(rf'\b{key} = "', f'{former} = "', text)
    return text


def test_former_keys_are_declared_with_their_entries() -> None:
    both = {"least": "min", "greatest": "max"}
    assert former_keys(UniformScatter) == former_keys(NormalScatter) == former_keys(Distribution) == both
    assert former_keys(ShaftLimit) == {"stress_greatest": "stress_max"}


def test_files_with_former_keys_are_the_same_machines() -> None:
    """Numbers, addresses and what is written are those of the present keys."""
    now, before = lw.loads(FIELD), lw.loads(older(FIELD))
    assert "least" in older(FIELD)
    assert now == before
    assert "least" not in dumps(before) == dumps(now)
    address = "topper.field.cut_height"
    assert lw.get(before, f"{address}.least") == lw.get(now, f"{address}.min") == 0.01
    changed = lw.replace(before, {f"{address}.greatest": 0.06})
    assert lw.get(changed, f"{address}.max") == 0.06


@pytest.mark.parametrize("text", [FIELD, older(FIELD)])
@pytest.mark.parametrize("key", ["min", "least"])
def test_an_override_replaces_the_entry_by_either_key(text: str, key: str) -> None:
    machine = lw.loads(text, [f"topper.field.cut_height.{key}=20 mm"])
    assert lw.get(machine, "topper.field.cut_height.min") == 0.02


def test_what_is_wrong_with_a_former_key_is_told_where_it_stands() -> None:
    text = older(FIELD).replace('least = "10 mm"', 'least = "10 kg"')
    line = text[: text.index('"10 kg"')].count("\n") + 1
    with pytest.raises(MachineFileError) as caught:
        lw.loads(text, path="field.toml")
    (problem,) = caught.value.problems
    assert (problem.key, problem.line) == ("topper.field.cut_height.least", line)
    assert "length" in problem.expected
    with pytest.raises(MachineFileError, match=r"cut_height\.least\n +found: +an unknown key"):
        lw.loads(FIELD + 'least = "10 mm"\n')


def test_no_page_or_example_has_former_keys() -> None:
    root = Path(__file__).parents[2]
    pages = [
        *root.glob("docs/**/*.md"),
        *root.glob("examples/**/*.toml"),
        *root.glob("examples/**/*.py"),
        *root.glob("python/**/templates/*"),
    ]
    former = re.compile(r'[`"](stress_greatest|least|greatest)[`"]|[{,] (least|greatest) = ["\d-]')
    assert [page for page in pages if former.search(page.read_text(encoding="utf-8"))] == []

"""Units by K in place of H and G, and from tables of their makers."""

from __future__ import annotations

import math

import pytest

import linkwright as lw

INCH = 0.0254
TABLE = """\
# A maker's table.
type, A [in], C [in], I [in], K [in], P [in], R [in], structural_unbalance [lbf]
C-320-305-120, 136, 118, 125.63, 188.25, 142.63, 50 44 38, 1200
"""


def unit(entries: str) -> lw.Machine:
    return lw.loads(f'format = 1\nname = "unit"\n[pumping_unit]\n{entries}\n')


def test_the_published_unit_by_k_has_its_stroke():
    """C-320-305-120: A 136, C 118, I 125.63, K 188.25, P 142.63, R 50 in give 120.14 in."""
    machine = unit('A="136 in"\nC="118 in"\nI="125.63 in"\nK="188.25 in"\nP="142.63 in"\nR="50 in"')
    assert lw.pumping_unit(machine).stroke / INCH == pytest.approx(120.14, abs=0.005)


def test_k_is_the_same_as_h_and_g():
    """K² = I² + (H − G)²: motion and torque factors are the same."""
    letters = 'A="72 in"\nC="64 in"\nI="64 in"\nP="74.5 in"\nR="24 in"\n'
    first = lw.pumping_unit(unit(letters + 'H="116 in"\nG="41 in"'))
    second = lw.pumping_unit(unit(letters + f'K="{math.hypot(64, 75)!r} in"'))
    assert second.torque_factor == pytest.approx(first.torque_factor, abs=1e-9)
    assert second.stroke == pytest.approx(first.stroke, rel=1e-12)


def test_a_table_of_a_maker_gives_the_unit_with_its_crank_hole(tmp_path):
    """The type and the hole choose; entries of the machine file go first."""
    (tmp_path / "units.csv").write_text(TABLE, encoding="utf-8")
    text = 'format = 1\nname = "unit"\n[pumping_unit]\nfile = "units.csv"\ncatalogue = "C-320-305-120"\n'
    path = tmp_path / "machine.toml"
    path.write_text(text, encoding="utf-8")
    assert lw.pumping_unit(lw.read(path)).stroke / INCH == pytest.approx(120.14, abs=0.005)
    path.write_text(text + "hole = 2\n", encoding="utf-8")
    read = lw.read(path).pumping_unit
    assert pytest.approx(44 * INCH) == read.R
    assert read.structural_unbalance == pytest.approx(1200 * 4.4482216152605)
    path.write_text(text + 'R = "40 in"\n', encoding="utf-8")
    assert pytest.approx(40 * INCH) == lw.read(path).pumping_unit.R
    path.write_text(text + "hole = 4\n", encoding="utf-8")
    with pytest.raises(lw.MachineFileError, match="a crank hole from 1, the outermost, to 3"):
        lw.read(path)
    path.write_text(text.replace("C-320", "C-230"), encoding="utf-8")
    with pytest.raises(lw.MachineFileError, match="C-320-305-120"):
        lw.read(path)


def test_contradictions_are_refused():
    """K beside H, K shorter than I, or nothing of them."""
    letters = 'A="72 in"\nC="64 in"\nI="64 in"\nP="74.5 in"\nR="24 in"\n'
    with pytest.raises(lw.MachineError, match="nothing beside K"):
        unit(letters + 'K="90 in"\nH="116 in"')
    with pytest.raises(lw.MachineError, match="at least I"):
        unit(letters + 'K="60 in"')
    with pytest.raises(lw.MachineError, match="or K in their place"):
        unit(letters)

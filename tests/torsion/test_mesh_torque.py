"""Torque of gear stages: closed forms, stiff meshes in the limit, free bodies."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import linkwright as lw
from linkwright import mesh_torques
from linkwright.torsion import excited_train, torsion_response
from linkwright.torsion.excitation.excited_train import loaded
from linkwright.torsion.response.mesh_torque import MeshTorque, meshed

TRAIN = """
format = 1
name = "A motor, a gear stage, a mill"
[train.discs]
motor = {{ inertia = 2, damping = 0.5 }}
pinion = {{ inertia = 0.3, damping = 0.2 }}
wheel = {{ inertia = 4, damping = 1.5 }}
mill = {{ inertia = 30 }}
[train.shafts]
fast = {{ between = ["motor", "pinion"], stiffness = 4e4, damping = 3, loss_factor = 0.01 }}
slow = {{ between = ["wheel", "mill"], stiffness = 3e5, loss_factor = 0.02 }}
[train.gears]
stage = {{ between = ["pinion", "wheel"], ratio = 3{mesh} }}
[train.loads.mill]
on = "mill"
torque = {load}
speed = 30
exponent = 1
harmonics = [{{ order = 4, share = 0.3 }}]
[train.excitations.motor]
on = "motor"
harmonics = [{{ order = 1, torque = 60, phase = 0.4 }}, {{ order = 2, torque = 25 }}]
[train.excitations.wheel]
on = "wheel"
harmonics = [{{ order = 24, torque = 10 }}]
[train.run]
speed_min = 20
speed_max = 120
points = 41
"""


def of(mesh: str = "", load: float = 900.0, **changes: str) -> MeshTorque:
    """Torques of the train with changes of its text."""
    text = TRAIN.format(mesh=mesh, load=load)
    for old, new in changes.items():
        text = text.replace(old, new)
    return mesh_torques(lw.loads(text))


def test_rigid_stage_carries_what_a_very_stiff_mesh_does() -> None:
    rigid, stiff = of(), of(", stiffness = 1e13")
    scale = np.abs(rigid.torques).max()
    # A mesh of 10¹³ N m/rad beside shafts of 10⁵ leaves 10⁻⁸.
    np.testing.assert_allclose(rigid.torques, stiff.torques, atol=3e-7 * scale)
    np.testing.assert_allclose(rigid.mean, stiff.mean, rtol=1e-6)


def test_stage_alone_shares_a_torque_by_inertia() -> None:
    """T = M i²… of two geared discs: what the second one needs, J_b/i² over all."""
    text = """
format = 1
name = "Two geared discs"
[train.discs]
a = { inertia = 2 }
b = { inertia = 45 }
[train.gears]
stage = { between = ["a", "b"], ratio = 3 }
[train.excitations.pulse]
on = "a"
harmonics = [{ order = 2, torque = 70, phase = 0.3 }]
"""
    found = mesh_torques(lw.loads(text), np.array([10.0, 50.0]))
    wanted = 70 * np.exp(0.3j) * 5 / (2 + 5)
    np.testing.assert_allclose(found.torques[0, 0], wanted, rtol=1e-12)


def test_mean_torque_is_that_of_the_load_over_the_ratio() -> None:
    found = of()
    # 900 N m at 30 rad/s, in proportion to the speed, at a third of the motor's.
    np.testing.assert_allclose(found.mean[0], 900 * (found.speeds / 3 / 30) / 3, rtol=1e-9)


def test_sense_of_writing_a_stage_turns_its_torque() -> None:
    there, back = (
        of(),
        of(**{'["pinion", "wheel"], ratio = 3': '["wheel", "pinion"], ratio = "0.333333333333333"'}),
    )
    np.testing.assert_allclose(back.torques, -3 * there.torques, rtol=1e-9)
    # Seen from the wheel the drive is against its sense; the drop below the mean is the same torque.
    np.testing.assert_allclose(back.drop, 3 * there.drop, rtol=1e-9)


def test_teeth_part_where_the_least_torque_passes_zero() -> None:
    found = of()
    np.testing.assert_array_equal(found.contact_lost, found.least < 0)
    assert found.contact_lost.any()
    assert not found.contact_lost.all()


def test_a_train_without_load_hammers_everywhere() -> None:
    found = of(load=1e-12)
    assert found.contact_lost.all()


def test_belts_are_tight() -> None:
    found = of(**{"ratio = 3": 'ratio = 3, kind = "belt"'})
    assert found.toothed == (False,)
    assert not found.contact_lost.any()
    np.testing.assert_allclose(found.torques, of().torques)


def test_loop_of_rigid_stages_is_left_open_and_the_rest_is_told() -> None:
    text = """
format = 1
name = "Two ways round"
[train.discs]
a = { inertia = 1 }
b = { inertia = 1 }
c = { inertia = 1 }
d = { inertia = 6 }
[train.gears]
ab = { between = ["a", "b"], ratio = 2, kind = "internal" }
bc = { between = ["b", "c"], ratio = 2, kind = "internal" }
ac = { between = ["a", "c"], ratio = 4, kind = "internal" }
cd = { between = ["c", "d"], ratio = 1 }
[train.excitations.pulse]
on = "a"
harmonics = [{ order = 1, torque = 100 }]
"""
    found = mesh_torques(lw.loads(text), np.array([10.0]))
    assert found.stages == ("ab", "bc", "ac", "cd")
    assert np.isnan(found.torques[0, :3]).all()
    # Referred to a: 1 + 1/4 + (1 + 6)/16; d takes 6/16 of it, counted at c four times as large.
    assert found.torques[0, 3, 0] == pytest.approx(4 * 100 * (6 / 16) / (1 + 1 / 4 + 7 / 16), rel=1e-12)


def test_a_train_that_speeds_up_passes_on_what_the_rest_needs() -> None:
    """100 N m on the motor that nothing takes off: the stage passes the share of what lies behind it."""
    machine = lw.loads(TRAIN.format(mesh="", load=900.0))
    at = excited_train(machine)
    mean = np.zeros_like(at.torques.mean)
    mean[0] = 100.0
    driven = loaded(machine, at.train, at.referred, replace(at.torques, mean=mean))
    found = meshed(driven, torsion_response(driven))
    before, behind = 2 + 0.3, (4 + 30) / 3**2
    np.testing.assert_allclose(found.mean[0], 100 * behind / (before + behind), rtol=1e-9)

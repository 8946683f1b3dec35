"""Joints of a URDF that follow the transmission table put all bodies where the mechanism has them."""

from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest

import linkwright as lw
from linkwright.multibody import Urdf

EXAMPLES = Path(__file__).parents[2] / "examples"
NAMES = ["four_bar_counterweights", "gears_and_guides", "jansen_leg", "quick_returns", "six_bar_chains"]


def starts(machine: lw.Machine, made: Urdf) -> dict[str, str]:
    """Links whose frame is at their start, with the point there."""
    places = {
        joint.find("child").get("link"): joint.get("name")  # type: ignore[union-attr]
        for joint in ElementTree.fromstring(made.text).iter("joint")
    }
    links = machine.linkage.links()
    return {
        name: link.start
        for name, link in links.items()
        if name in places and places[name].partition(":")[0] == link.start
    }


@pytest.mark.parametrize("name", NAMES)
def test_bodies_follow_the_table(name: str) -> None:
    """MuJoCo reads the URDF; with the table's positions its links start where the mechanism has them."""
    machine = lw.read(EXAMPLES / name / "machine.toml")
    made = lw.urdf(machine, angle=0.2, n=24)
    model = mujoco.MjModel.from_xml_string(made.text)
    data = mujoco.MjData(model)
    table = made.transmission
    motion = lw.kinematics(machine, table.angles)
    checked = starts(machine, made)
    assert len(checked) >= 3
    for i in range(len(table.angles)):
        for joint, values in table.joints.items():
            data.joint(joint).qpos[0] = values.position[i]
            data.joint(joint).qvel[0] = values.d1[i]
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        for link, point in checked.items():
            assert data.body(link).xpos[:2] == pytest.approx(motion.points[point].position[i], abs=1e-12)
            velocity = np.zeros(6)
            body = model.body(link).id
            mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_XBODY, body, velocity, 0)
            assert velocity[2] == pytest.approx(motion.links[link].d1[i], abs=1e-10)
            assert velocity[3:5] == pytest.approx(motion.points[point].d1[i], abs=1e-10)


@pytest.mark.parametrize("name", NAMES)
def test_second_derivatives_are_those_of_the_first(name: str) -> None:
    """Central differences of order four of each joint's first derivative give its second."""
    machine = lw.read(EXAMPLES / name / "machine.toml")
    made = lw.urdf(machine, angle=0.2, n=1440)
    h = made.transmission.angles[1] - made.transmission.angles[0]
    for values in made.transmission.joints.values():
        d = values.d1
        expected = (8 * (d[3:-1] - d[1:-3]) - (d[4:] - d[:-4])) / (12 * h)
        assert values.d2[2:-2] == pytest.approx(expected, abs=1e-5)


def test_a_gear_mimics_the_other() -> None:
    """A gear of the same size outside mimics the crank with the factor −1; the next one that gear."""
    machine = lw.read(EXAMPLES / "geared_five_bar" / "machine.toml")
    joints = {
        joint.get("name"): joint
        for joint in ElementTree.fromstring(lw.urdf(machine, n=12).text).iter("joint")
    }
    mimics = {name: joint.find("mimic") for name, joint in joints.items()}
    found = {n: (m.get("joint"), m.get("multiplier")) for n, m in mimics.items() if m is not None}
    assert found == {"M": ("O", "-1"), "B": ("M", "-1")}


def test_slides_have_their_range_as_limits() -> None:
    """The range of a slider-crank's slide is twice the crank radius."""
    machine = lw.read(EXAMPLES / "press_motion" / "machine.toml")
    limit = next(ElementTree.fromstring(lw.urdf(machine).text).iter("limit"))
    low, high = float(limit.get("lower") or 0), float(limit.get("upper") or 0)
    radius = next(iter(machine.mechanism.cranks.values())).radius
    assert high - low == pytest.approx(2 * radius, rel=1e-4)

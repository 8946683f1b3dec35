r"""Parts of a train in motion beyond springs and dampers: stages, joints, pendulums, speed controllers.

| part | in motion |
| --- | --- |
| mesh on a carrier | its twist joins three discs |
| mesh with backlash | its damping acts in contact alone |
| stage with an efficiency | its ends carry unequal torques; if it is rigid, two masses that move as one |
| Hooke's joint | tan ψ = tan φ/cos α, exactly |
| centrifugal pendulum | exact for any swing; its disc is the ring of linear vibration |
| driver with `control` | a torque by the deviation of the speed |
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.kernel.core.curve import straight
from linkwright.kernel.errors import MachineError, Problem
from linkwright.torsion.core.train import ReferredTrain
from linkwright.torsion.core.transient import PLAIN, Controller, Manner, MovingPendulum, MovingTrain
from linkwright.torsion.in_time.friction_parts import start_speeds
from linkwright.torsion.model.train import GROUND, Train
from linkwright.torsion.model.train_transient import TrainTransient
from linkwright.torsion.model.whole_train import parts_of


def link_manner(expanded: Train, referred: ReferredTrain, name: str) -> Manner:
    """What a shaft or elastic mesh has beyond a spring and a damper."""
    shaft, gear = expanded.shafts.get(name), expanded.gears.get(name)
    if shaft is not None and shaft.joint_angle is not None:
        return Manner(joint=(shaft.joint_angle, shaft.joint_phase))
    if gear is None:
        return PLAIN
    if gear.carrier is None or referred.twist is None:
        return Manner(contact=bool(gear.backlash), loss=gear.losses)
    twist, place = referred.twist[referred.shafts.index(name)], referred.discs.index
    parts = [0.0 if end == GROUND else float(twist[place(end)]) for end in (*gear.between, gear.carrier)]
    return Manner(carrier=(place(gear.carrier), (parts[0], parts[1], parts[2])))


def with_parts(moving: MovingTrain, train: Train, expanded: Train, manoeuvre: TrainTransient) -> MovingTrain:
    """A train in motion with its rigid stages that lose power, its pendulums and its controllers."""
    moving = _with_lossy_stages(moving, expanded)
    bobs = {name: moving.shafts.index(name) for name in train.pendulums}
    stiffness = np.array(moving.stiffness)
    # What holds a pendulum is its inertia.
    stiffness[list(bobs.values())] = 0.0
    place = moving.discs.index
    pendulums = tuple(
        MovingPendulum(place(one.on), place(name), one.mass, one.radius, one.length)
        for name, one in train.pendulums.items()
    )
    controllers = tuple(
        _controller(name, moving, train, manoeuvre)
        for name, driver in train.drivers.items()
        if driver.control is not None
    )
    return replace(moving, stiffness=stiffness, pendulums=pendulums, controllers=controllers)


def joint_leads(moving: MovingTrain, angle: Floats) -> Floats:
    """ψ − φ by which the joint at its end twists each shaft, at angles of the masses, (shafts,) [rad]."""
    leads = np.zeros(len(moving.shafts))
    for s, manner in enumerate(moving.manners):
        if manner.joint is not None:
            cosine, disc = np.cos(manner.joint[0]), moving.tip[s, 0]
            phi = moving.speed[disc] * angle[moving.mass[disc]] + manner.joint[1]
            sine, along = np.sin(phi), np.cos(phi)
            leads[s] = np.arctan2((1 - cosine) * sine * along, cosine * along**2 + sine**2)
    return leads


def _with_lossy_stages(moving: MovingTrain, expanded: Train) -> MovingTrain:
    """Discs behind a rigid stage that loses power are a mass of their own."""
    rigid = {name: gear for name, gear in expanded.gears.items() if gear.stiffness is None}
    lossy = {name: gear for name, gear in rigid.items() if gear.losses is not None}
    if not lossy:
        return moving
    if moving.modal_damping is not None:
        name, remedy = next(iter(lossy)), "give the stiffness of its mesh"
        expected = "no rigid stage with an efficiency beside damping ratios of modes in a motion in time"
        raise MachineError([Problem("train.transient", f"the stage {name}", expected, remedy)])
    joined = [gear.between for name, gear in rigid.items() if name not in lossy]
    number = {name: n for n, part in enumerate(parts_of(moving.discs, joined)) for name in part}
    place, more = moving.discs.index, len(lossy)
    tips = np.array([[place(end) for end in gear.between] for gear in lossy.values()], np.int32)
    none = np.zeros(more)
    manners = moving.manners or (PLAIN,) * len(moving.shafts)
    return replace(
        moving,
        mass=np.array([number[name] for name in moving.discs], np.int32),
        shafts=(*moving.shafts, *lossy),
        tip=np.concatenate([moving.tip, tips]),
        stiffness=np.concatenate([moving.stiffness, none]),
        shaft_damping=np.concatenate([moving.shaft_damping, none]),
        curves=(*moving.curves, *[None] * more),
        manners=(*manners, *[Manner(rigid=True, loss=gear.losses) for gear in lossy.values()]),
    )


def _controller(name: str, moving: MovingTrain, train: Train, manoeuvre: TrainTransient) -> Controller:
    driver = train.drivers[name]
    control, disc = driver.control, moving.discs.index(driver.on)
    assert control is not None
    if control.times is not None and control.speeds is not None:
        course = straight(control.times, control.speeds)
    else:
        start = float(moving.speed[disc] * start_speeds(moving, manoeuvre)[moving.mass[disc]])
        course = straight([0.0], [start if control.speed is None else control.speed])
    return Controller(
        name,
        disc,
        control.proportional,
        control.integral / control.proportional,
        np.inf if control.torque_max is None else control.torque_max,
        course,
        driver.torque or 0.0,
    )

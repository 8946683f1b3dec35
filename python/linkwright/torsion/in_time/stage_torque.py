r"""Torque in the gear stages of a train that moves in time, at the samples of its motion.

What a rigid stage carries follows from the discs that it joins, each referred to the first disc,

.. math:: f_d = n_d\,(M_d - J_d \ddot\theta_d - c_d \dot\theta_d) + \sum_s \pm n_s T_s, \qquad
    \sum_g B_{dg}\, n_g T_g = f_d

as in `linkwright.torsion.response.mesh_torque`, with the accelerations of the motion. What is left over at a
mass is that of given damping ratios, which act by inertia. An elastic mesh carries the torque of its twist.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from linkwright.kernel.arrays import Floats
from linkwright.torsion.core.transient import MovingTrain
from linkwright.torsion.in_time.friction_parts import part_numbers
from linkwright.torsion.model.train import TrainGear
from linkwright.torsion.response.mesh_torque import passed_on


def stage_torques(
    train: MovingTrain,
    gears: dict[str, TrainGear],
    time: Floats,
    angle: Floats,
    speed: Floats,
    torque: Floats,
    friction: Floats,
) -> Floats:
    """Torque of each stage at its first disc, (stages, n) [N m]; NaN where statics does not tell it.

    `time`: (n,) [s]; `angle`, `speed`: (masses, n), at the speed of the first disc [rad, rad/s]; `torque`:
    (shafts, n) [N m]; `friction`: (elements, n), of clutches, brakes and freewheels [N m].
    """
    rigid = [name for name in gears if name not in train.shafts]
    leads = np.concatenate([train.lead, friction_lead(train)])[:, None]
    # A list of none has no samples either.
    flows = leads * np.concatenate([one.reshape(-1, len(time)) for one in (torque, friction)])
    left = _left_over(train, _joined(train, gears, rigid), time, angle, speed, flows) if rigid else None
    # Discs whose inertia changes share none by its mean.
    open_masses = {int(train.mass[rotor.on]) for rotor in train.inertias}
    rows = []
    for name, gear in gears.items():
        first = train.discs.index(gear.between[0])
        if left is None or name not in rigid:
            rows.append(_at_first(train, train.shafts.index(name), speed, torque))
            continue
        passed = passed_on(train.discs, [gears[name].between for name in rigid], left[None])[0].real
        known = int(train.mass[first]) not in open_masses
        rows.append(passed[rigid.index(name)] / train.speed[first] if known else np.full(len(time), np.nan))
    return np.array(rows).reshape(len(gears), len(time))


def _at_first(train: MovingTrain, shaft: int, speed: Floats, torque: Floats) -> Floats:
    """Torque of the first disc, where friction of the teeth adds to what they carry, (n,) [N m]."""
    loss = train.manners[shaft].loss if train.manners else None
    if loss is None:
        alone: Floats = torque[shaft]
        return alone
    power = torque[shaft] * speed[train.mass[train.tip[shaft, 0]]]
    at_first: Floats = torque[shaft] * np.where(power > 0, loss[0], np.where(power < 0, loss[1], 1.0))
    return at_first


def _joined(train: MovingTrain, gears: dict[str, TrainGear], rigid: list[str]) -> list[int]:
    masses = {int(train.mass[train.discs.index(end)]) for name in rigid for end in gears[name].between}
    return [disc for disc, mass in enumerate(train.mass.tolist()) if mass in masses]


def _left_over(
    train: MovingTrain, joined: list[int], time: Floats, angle: Floats, speed: Floats, flows: Floats
) -> Floats:
    """What rigid stages have to pass on at each disc, referred to the first, (discs, n) [N m].

    `flows`: torques of shafts, then of elements with friction, referred likewise.
    """
    n = train.speed[:, None]
    # The ground is a last disc.
    net = np.zeros((len(train.discs) + 1, len(time)))
    tips = [*train.tip.tolist(), *(friction.tip for friction in train.frictions)]
    for (first, second), flow in zip(tips, flows, strict=True):
        net[first] -= flow
        net[second] += flow
    net = net[:-1]
    swing = train.swing_damping[:, None] * (speed[train.mass] - _together(train, speed))
    net -= n**2 * (train.damping[:, None] * speed[train.mass] + swing)
    loaded = {disc: own for disc in joined if (own := tuple(one for one in train.torques if one.on == disc))}
    bare = _net(replace(train, torques=()), time, angle, speed) if loaded else net
    for disc, own in loaded.items():
        alone = _net(replace(train, torques=own), time, angle, speed)
        net[disc] += (alone - bare)[train.mass[disc]]
    return _shared(train, joined, net)


def _together(train: MovingTrain, speed: Floats) -> Floats:
    """Speed of each disc as it turns with its part as a whole, (discs, n); a train that is held stands."""
    turning = train.turning[train.mass]
    together = np.zeros((len(turning), speed.shape[1]))
    parts = np.array(part_numbers(train))[train.mass] if train.is_free else np.zeros(0)
    for part in set(parts.tolist()):
        inertia = np.where(parts == part, train.mean_inertia * train.speed**2 * turning, 0.0)
        if inertia.any():
            together[parts == part] = inertia @ speed[train.mass] / inertia.sum()
    together *= turning[:, None]
    return together


def friction_lead(train: MovingTrain) -> Floats:
    """Speed of each element with friction over that of the first disc, (elements,)."""
    return np.array([train.speed[max(friction.tip)] for friction in train.frictions])


def _shared(train: MovingTrain, joined: list[int], net: Floats) -> Floats:
    """Less the inertia torque, the sum of all others on a mass, by inertia."""
    shared = np.zeros_like(net)
    weight = train.speed**2 * train.mean_inertia
    for mass in {int(train.mass[disc]) for disc in joined}:
        discs = [disc for disc in joined if train.mass[disc] == mass]
        total = net[discs].sum(axis=0)
        shared[discs] = net[discs] - total * (weight[discs] / weight[discs].sum())[:, None]
    return shared


def _net(train: MovingTrain, time: Floats, angle: Floats, speed: Floats) -> Floats:
    """Net torque on each mass, instant by instant, (masses, n) [N m]."""
    instants = zip(time.tolist(), angle.T, speed.T, strict=True)
    return np.array([train.net_torques(t, at[None], turning).torque[0] for t, at, turning in instants]).T

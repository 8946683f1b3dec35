"""A train with all that stands for discs and shafts written out: couplings and dampers.

A coupling is a shaft with the slope of its curve without torque; a damper is a disc, its ring, on a shaft
without stiffness or with that of its spring.
"""

from __future__ import annotations

from linkwright.machine.coupling import Coupling
from linkwright.machine.damper import Damper
from linkwright.machine.train import Disc, Shaft, Train


def whole_train(train: Train) -> Train:
    """A train of discs, shafts and gears alone.

    Parameters
    ----------
    train : Train
        With couplings and dampers.

    Returns
    -------
    Train
        Of the same vibration: discs, then rings of dampers; shafts, then couplings, then what holds the
        rings.
    """
    if not (train.couplings or train.dampers):
        return train
    rings = {name: Disc(inertia=each.ring_inertia) for name, each in train.dampers.items()}
    couplings = {name: _coupling(each) for name, each in train.couplings.items()}
    held = {name: _spring(name, each) for name, each in train.dampers.items()}
    return train.model_copy(
        update={
            "discs": {**train.discs, **rings},
            "shafts": {**train.shafts, **couplings, **held},
            "couplings": {},
            "dampers": {},
        }
    )


def _coupling(coupling: Coupling) -> Shaft:
    """What a coupling without mean torque does."""
    return Shaft(
        between=coupling.between,
        stiffness=float(coupling.slope()),
        damping=coupling.damping,
        loss_factor=coupling.loss_factor,
    )


def _spring(name: str, damper: Damper) -> Shaft:
    """What joins the ring of a damper with its disc."""
    # No shaft of a file has the stiffness 0, which a fluid has: unchecked.
    return Shaft.model_construct(
        between=(damper.on, name),
        stiffness=damper.stiffness or 0.0,
        damping=damper.damping,
        loss_factor=damper.loss_factor,
    )

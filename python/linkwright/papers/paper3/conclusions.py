"""What the numbers of paper 3 say, in sentences that carry their numbers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from linkwright.papers.paper3.rows import share

if TYPE_CHECKING:
    from linkwright.papers.paper3.paper import Paper3


def conclusions(paper: Paper3) -> list[str]:
    """What the numbers say.

    Parameters
    ----------
    paper : Paper3
        Printed and exact formulas.

    Returns
    -------
    list of str
        A few sentences each.
    """
    return [
        _about_disc(paper),
        _about_articulated(paper),
        _about_share(paper),
        _about_swing(paper),
        _about_throw(paper),
        _about_unevenness(paper),
        _about_delta(paper),
        _about_weak(paper),
        _about_diagnosis(paper),
    ]


def _rpm(speed: float) -> str:
    return f"{speed * 30 / math.pi:.0f} rpm"


def _about_disc(paper: Paper3) -> str:
    found = paper.inertia
    return (
        "For a rod on the crank pin (1) to (7) give the disc of equal mean energy within "
        f"{100 * max(abs(found.one_rod), abs(found.series)):.2g} %: the two masses keep m and I_w, and what "
        "they do to the centre of mass and what (3) leaves out hardly count in the mean. (9) is off by "
        f"{share(found.simple)} since it drops R²/(4L²). A frequency follows the disc by half of that at "
        "most."
    )


def _about_articulated(paper: Paper3) -> str:
    literal, reduced = paper.inertia.shifts[:2]
    trial = paper.trial
    return (
        "(12) carries I_w over to the articulated rod as its moment of inertia about its own small end, "
        "and (7) adds that to the disc of the crank as it is. Taken so, the disc of a throw is "
        f"{1 + literal.deviation:.2f} times the exact one, and the first mode of the crankshaft falls from "
        f"{trial.frequencies[1]:.1f} to {literal.frequencies[1]:.1f} Hz; order {trial.order:g} would meet "
        f"it at {_rpm(literal.critical)} in place of {_rpm(trial.critical(float(trial.frequencies[1])))}. "
        "The articulated rod does not turn with the crank: reduced to the crank pin as in (7), its disc is "
        f"right within {100 * abs(reduced.deviation):.1g} %, pin beside the crank pin and longer stroke "
        "included."
    )


def _about_share(paper: Paper3) -> str:
    low, high = paper.published["printed"]["k"]
    of = {each.name: each for each in paper.inertia.shifts}
    least = of[f"(9), both rods with k = {low:.2f}"]
    return (
        f"With I_w about the small end, as (1) needs it, the master rod has k = {paper.inertia.share:.2f}. "
        f"The range {low:g}…{high:g} printed as usual fits the small end's share 1 − k. Used in (9), {low:g} "
        f"takes {share(least.deviation)} off the disc and moves the first mode of the crankshaft by "
        f"{share(least.changes[1])}."
    ).replace("takes −", "takes ")


def _about_swing(paper: Paper3) -> str:
    found = paper.swing
    return (
        f"358000 for g (60/π)² = 357826 makes moments about the edge {100 * found.edge:.2g} % too large, "
        f"about the centre of mass {100 * found.centre:.2g} %, and I_w {100 * found.axis:.2g} %: less than "
        "counting swings for a minute does."
    )


def _about_throw(paper: Paper3) -> str:
    trial, found = paper.trial, paper.throw
    shifts = [each for each in found.shifts if each.what == "k"]
    low = min(shifts, key=lambda each: each.critical)
    high = max(shifts, key=lambda each: each.critical)
    return (
        "The compliance decides. With (17) as rebuilt the first mode of the crankshaft has "
        f"{trial.frequencies[1]:.1f} Hz; by {low.name} it has {low.frequencies[1]:.1f} Hz, by {high.name} "
        f"{high.frequencies[1]:.1f} Hz, and order {trial.order:g} meets it anywhere from "
        f"{_rpm(low.critical)} to {_rpm(high.critical)}. A stiffness that was measured, or computed by "
        "finite elements, is worth more than all of (1) to (16)."
    )


def _about_unevenness(paper: Paper3) -> str:
    found = paper.uneven
    free, wheel, last = (found.N[at] for at in (0, found.flywheel, -1))
    rigid = found.N_rigid
    return (
        f"At {_rpm(found.speed)} the sound engine would turn with N = {rigid:.4f} everywhere if nothing "
        f"twisted. With torsion N is {free:.4f} at the free end, {wheel:.4f} at the flywheel and {last:.5f} "
        f"behind the coupling: {free / rigid:.0f} times, {wheel / rigid:.0f} times and {last / rigid:.2f} "
        "times as much."
    )


def _about_delta(paper: Paper3) -> str:
    found, weak = paper.uneven, paper.published["chosen"]["weak"]
    free, wheel = found.rise[:, 0] - 1, found.rise[:, found.flywheel] - 1
    return (
        f"A cylinder at {100 * weak:.0f} % would raise the unevenness δ over the whole cycle by "
        f"{share(found.rise_rigid.min() - 1)} to {share(found.rise_rigid.max() - 1)} if nothing twisted. "
        f"With torsion it changes δ by {share(free.min())} to {share(free.max())} at the free end, where "
        f"{int((free < 0).sum())} of {len(free)} weak cylinders make it smaller, and by "
        f"{share(wheel.min())} to {share(wheel.max())} at the flywheel."
    )


def _about_weak(paper: Paper3) -> str:
    found, factor = paper.weak, paper.published["chosen"]["weak"]
    at, order = found.cylinder - 1, f"{paper.trial.order:g}"
    off = float(abs(found.elastic[:2, at] - factor).max())
    free, wheel, last = found.against_sound[:, at]
    return (
        f"Cylinder {found.cylinder} at {factor:g}, told from the orders below {order}: the elastic train "
        f"finds it to {off:.0e} from either end of the crankshaft. The train taken as rigid makes "
        f"{found.rigid[0].min():.1f} to {found.rigid[0].max():.1f} of all cylinders from the free end. "
        "Compared with the engine as it was sound, it points at the weak cylinder from both ends, but "
        f"takes {factor:g} for {free:.2f} and {wheel:.2f}, and from behind the coupling it sees {last:.2f}."
    ).replace(" -", " −")


def _about_diagnosis(paper: Paper3) -> str:
    return (
        "The paper's conclusion holds: whoever judges cylinders by the unevenness and neglects torsion "
        "takes a sound engine for a bad one, may see a weak cylinder make it better, and is told a wrong "
        "share by the orders."
    )

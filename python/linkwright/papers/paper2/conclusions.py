"""What the numbers of paper 2 say, in sentences that carry their numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from linkwright.papers.paper2.checks import breadth_of

if TYPE_CHECKING:
    from linkwright.cam.profile.profile import CamProfile
    from linkwright.papers.paper2.alternatives import Alternative
    from linkwright.papers.paper2.paper import Paper2


def conclusions(paper: Paper2) -> list[str]:
    """What the numbers say.

    Parameters
    ----------
    paper : Paper2
        Published and computed values.

    Returns
    -------
    list of str
        A few sentences each.
    """
    return [
        _about_formulas(paper),
        _about_profile(paper),
        _about_rollers(paper),
        _about_pair(paper),
        _about_minimum(paper),
        _about_jerk(paper),
        _about_turn(paper),
        _about_crank(paper),
        _about_other_laws(paper),
        _about_course(paper),
    ]


def named(paper: Paper2, short: str) -> Alternative:
    """A drive by its short name."""
    return next(each for each in paper.alternatives if each.short == short)


def _about_formulas(paper: Paper2) -> str:
    far = [row.name for row in paper.rows if row.kind == "far"]
    formulas, profile = paper.formulas, paper.profile
    verdict = f"but for {', '.join(far)} agree" if far else "all agree"
    return (
        f"The printed formulas (1) to (10) and (17) to (22) {verdict} with one another and with the general "
        f"synthesis, to rounding. v = {formulas.speed:.10f} m/s, "
        f"ẍ_max = 16/9 v/t_p = {profile.acceleration_max:.6f} m/s², "
        f"jerk_max = 12 v/t_p² = {profile.jerk_max:.6f} m/s³; constant speed over 10/13 of the stroke, "
        f"{1e3 * formulas.travels['steady']:.1f} of {1e3 * formulas.stroke:.0f} mm."
    )


def _about_profile(paper: Paper2) -> str:
    profile, b = paper.profile, breadth_of(paper.profile)
    hollow = profile.curvature_radius_concave_min
    assert hollow is not None
    even = profile.opposite is not None and profile.opposite.is_constant
    return (
        f"b is not printed. With b = {b:g} m the base circle has {1e3 * profile.base_radius:.0f} mm, the "
        f"pressure angle reaches {np.degrees(profile.pressure_angle_max):.1f}°, and "
        f"{np.degrees(profile.cam.limit):.0f}° at b = {1e3 * paper.rollers.breadth_for_limit:.0f} mm. The "
        f"diameter is {'constant to rounding' if even else 'not constant'}. Near the base circle, "
        f"{_hollows(profile)}, in the start of the forward stroke and the braking of the return, the profile "
        f"is hollow, with {1e3 * hollow:.0f} mm least radius of curvature."
    )


def _hollows(profile: CamProfile) -> str:
    """From where to where the profile is hollow."""
    sides = np.flatnonzero(np.diff(np.sign(profile.curvature_radius)))
    edges = np.degrees(profile.angle[sides])
    return " and ".join(f"at {low:.0f}° to {high:.0f}°" for low, high in edges.reshape(-1, 2))


def _about_rollers(paper: Paper2) -> str:
    found = paper.rollers
    assert found.largest_in_hollow is not None
    assert found.largest_inside is not None
    return (
        "(17) to (22) are for points, which no cam bears. A roller on the printed profile would have to be "
        f"smaller than {1e3 * found.largest_in_hollow:.0f} mm in radius to reach into the hollows, and even "
        f"then the distance of two rollers of {1e3 * found.radius:.0f} mm would not be constant: it changes "
        f"by {1e3 * found.play:.2f} mm over a turn, and each is up to {1e3 * found.lift_error:.2f} mm beside "
        "its law. With rollers the printed curve must be that of their centres, the profile lying a radius "
        f"inside: then the diameter is constant again, the least convex radius of the profile is "
        f"{1e3 * (found.offset.curvature_radius_convex_min or 0):.0f} mm, and rollers up to "
        f"{1e3 * found.largest_inside:.0f} mm do not undercut it."
    )


def _about_pair(paper: Paper2) -> str:
    found = paper.pair
    left = "nothing" if found.left_over < 1e-9 * found.side_force else f"{found.left_over:.3g} N"
    return (
        f"One cam alone would push the cart across its travel with up to {1e-3 * found.side_force:.2f} kN, "
        f"the contact itself carrying {1e-3 * found.contact_force:.2f} kN at most. Of two cams that turn in "
        f"opposite directions and share the work {left} of it is left for the guide, as is said."
    )


def _about_minimum(paper: Paper2) -> str:
    printed, free = paper.starts.printed, paper.starts.free_travel
    saved = 1 - free.over_stroke(1 / 6) / printed.over_stroke(1 / 6)
    return (
        "The start section is not the minimum of ∫ jerk² that it is said to be. With zero velocity and "
        f"acceleration at rest, and v and zero acceleration at its end, the minimum is ẋ = v (3u² − 2u³) "
        f"with a travel of {free.travel:g} v t_p and ∫ jerk² = {free.cost:.4g} v²/t_p³, against "
        f"{printed.cost:.4g}. (1) is the minimum for the travel {printed.travel:.4g} v t_p, which is the "
        "travel that makes its jerk end in zero; but the jerk at an end cannot be a condition of this "
        f"minimum. Over a whole stroke of the same length and time the minimum saves {100 * saved:.0f} %, "
        f"has {free.acceleration_max:g} instead of {printed.acceleration_max:.4g} v/t_p of acceleration and "
        f"{free.jerk_max:g} instead of {printed.jerk_max:g} v/t_p² of jerk, but a step of "
        f"{free.jerk_max:g} v/t_p² where constant speed begins."
    )


def _about_jerk(paper: Paper2) -> str:
    drive, jump = paper.alternatives[0], 2 * paper.starts.printed.jerk_max
    return (
        "At the stroke ends the acceleration passes through zero without a step, but the jerk steps from +12 "
        f"to −12 v/t_p², by {jump:.4g} v/t_p² = {drive.jerk_step:.2f} m/s³: soft, not smooth."
    )


def _about_turn(paper: Paper2) -> str:
    free, printed, drive = paper.starts.free_acceleration, paper.alternatives[0], _free(paper)
    return (
        "As the cart turns back at once, zero acceleration at the stroke ends serves nothing: braking and "
        "the start of the return accelerate in one direction. With this acceleration free the minimum is "
        f"ẋ = v (3u − u³)/2, travel {free.travel:g} v t_p, ∫ jerk² = {free.cost:.4g} v²/t_p³, a sixth of the "
        f"printed start. ẍ and jerk are then {drive.acceleration_max:.3f} m/s² and {drive.jerk_max:.2f} "
        f"m/s³ instead of {printed.acceleration_max:.3f} and {printed.jerk_max:.2f}, the jerk has no step at "
        f"the stroke ends and one of {drive.jerk_step:.2f} m/s³ at the joints, and v, torque and δ are a "
        "little lower too."
    )


def _free(paper: Paper2) -> Alternative:
    return named(paper, "free at the turn")


def _about_crank(paper: Paper2) -> str:
    cam, crank = paper.alternatives[0], named(paper, "crank")
    less = 1 - cam.torque_max / crank.torque_max
    return (
        "Beside the crank drive with the same motor, gearbox, cart and stroke the cam buys constant rolling "
        f"speed over {100 * cam.steady_share:.0f} % of the stroke and, as rolling resistance is most of "
        f"the load, {100 * less:.0f} % less peak torque ({cam.torque_max:.0f} against "
        f"{crank.torque_max:.0f} N m) and a lower δ ({cam.steady.unevenness:.4f} against "
        f"{crank.steady.unevenness:.4f}). It costs {cam.acceleration_max / crank.acceleration_max:.1f} "
        f"times the acceleration ({cam.acceleration_max:.3f} against {crank.acceleration_max:.3f} m/s²), "
        f"{cam.jerk_max / crank.jerk_max:.0f} times the jerk, "
        f"{100 * (cam.force_max / crank.force_max - 1):.0f} % more force on the cart, and "
        f"{cam.steady.dynamism / crank.steady.dynamism:.1f} times the angular "
        f"acceleration of the shaft (H = {cam.steady.dynamism:.3f} against {crank.steady.dynamism:.3f})."
    )


def _about_other_laws(paper: Paper2) -> str:
    printed, smooth = paper.alternatives[0], named(paper, "continuous jerk")
    short, long, none = (named(paper, f"1/{n} each") for n in (10, 4, 2))
    whole, sine = named(paper, "polynomial 4-5-6-7"), named(paper, "harmonic")
    return (
        "A combined law with continuous jerk needs "
        f"{100 * (smooth.acceleration_max / printed.acceleration_max - 1):.0f} % more acceleration, "
        f"{100 * (smooth.torque_max / printed.torque_max - 1):.0f} % more torque, and half the jerk. "
        f"Shorter start and braking, 1/10 each, lower v and the torque ({short.torque_max:.0f} N m) for "
        f"{short.acceleration_max:.2f} m/s² and {short.jerk_max:.0f} m/s³; 1/4 each gives "
        f"{long.acceleration_max:.2f} m/s² for {long.torque_max:.0f} N m and {100 * long.steady_share:.0f} % "
        f"at constant speed; 1/2 each leaves none and asks {none.torque_max:.0f} N m. Laws over the whole "
        f"stroke are softer and ask more torque, from {sine.torque_max:.0f} N m (harmonic, "
        f"δ = {sine.steady.unevenness:.3f}) to {whole.torque_max:.0f} N m (4-5-6-7, "
        f"δ = {whole.steady.unevenness:.3f})."
    )


def _about_course(paper: Paper2) -> str:
    found = paper.course
    low, high = found.steady_range
    where = "start" if 2 * found.deviation_time / found.time[-1] % 1 < 0.5 else "braking"
    return (
        f"In steady motion the shaft turns at {found.speed_mean:.4f} rad/s in the mean, "
        f"{100 * (found.speed_mean / found.speed_design - 1):.1f} % faster than designed, and runs ahead at "
        "the stroke ends, where the cart hardly loads it. At constant speed the cart keeps "
        f"{50 * (low + high):.2f} % of the intended {found.speed_constant:.4f} m/s, even to "
        f"{_rounded_up(100 * (high - low))} %: the steep motor holds the speed, as load and inertia do not "
        f"change there. The greatest deviation, {100 * found.deviation_max:.1f} % of the constant speed, "
        f"lies in {where}, at {found.deviation_time:.2f} s of the turn of {found.time[-1]:.2f} s."
    )


def _rounded_up(value: float) -> str:
    """To one digit, upwards."""
    digit = 10.0 ** np.floor(np.log10(value))
    return f"{digit * np.ceil(value / digit):.1g}"

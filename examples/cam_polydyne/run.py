"""Which lift makes an elastic follower move exactly as wanted, and what is left of that at other speeds?

The polydyne lift of Dudley (1948): s = (x + 2ζ(ω/Ω) x′ + (ω/Ω)² x″)/κ with κ = k/(k + k_r).
"""

from pathlib import Path

import numpy as np

import linkwright as lw

FOLLOWER = lw.OneMass(0.5, 4e5, damping_ratio_frame=0.03, spring_rate=2e4, preload=250.0)
DESIGN = 900 * np.pi / 30


def study(machine: lw.Machine) -> dict[str, float]:
    """The follower on the polydyne cam and on a cam cut by the wanted motion itself."""
    wanted = machine.mechanism.cams["tappet"].lift
    made = lw.polydyne(wanted, FOLLOWER, DESIGN, "turn")
    turn = lw.follower_vibration(made.lift, FOLLOWER, DESIGN)
    rigid = lw.follower_vibration(wanted, FOLLOWER, DESIGN)
    aside = lw.follower_vibration(made.lift, FOLLOWER, 1.2 * DESIGN)
    return {
        "error_at_design_speed_m": float(np.abs(turn.position - wanted.at(turn.cam_angle)).max()),
        "error_at_120_percent_mm": 1e3 * float(np.abs(aside.position - wanted.at(aside.cam_angle)).max()),
        "error_of_the_plain_cam_mm": 1e3
        * float(np.abs(rigid.position / FOLLOWER.share - wanted.at(rigid.cam_angle)).max()),
        "lift_max_mm": 1e3 * made.lift_max,
        "force_min": turn.force_min,
    }


def figure(machine: lw.Machine):
    """Residual vibration of the rise over the speed, for both cams."""
    from linkwright.cam.figures.cam import residual_figure

    wanted = machine.mechanism.cams["tappet"].lift.stretch(0.0, np.radians(80))
    made = lw.polydyne(wanted, FOLLOWER, DESIGN).lift
    speeds = DESIGN * np.linspace(0.5, 2.0, 120)
    cams = {"polydyne at 900 rpm": made, "the wanted motion as lift": wanted}
    return residual_figure(
        {name: lw.residual_over_speed(law, FOLLOWER, speeds) for name, law in cams.items()}
    )


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    for name, value in study(example).items():
        print(f"{name:28} {value:.6g}")
    figure(example).savefig(here / "figure.png", dpi=120)
    print(f"{here / 'figure.png'}")

"""Which linkage about two bearings that are there already guides a tool along a path, or through three poses?

With task files: `linkwright synthesise path task.toml`, `linkwright synthesise motion task.toml`.
"""

from pathlib import Path

import numpy as np

import linkwright as lw
from linkwright.synthesis.task import FixedPivot, PathTask, Poses, PoseTask

PIVOTS = {"crank_pivot": FixedPivot(x=0.0, y=0.0), "rocker_pivot": FixedPivot(x=0.16, y=0.0)}
ANGLES = np.radians([10, 55, 100, 145, 190, 235, 280, 325])
POSES = np.radians([20, 70, 120])


def along_path(machine: lw.Machine, **timing: object):
    """The linkage for points of the tool, with crank angles or without."""
    x, y = lw.kinematics(machine, ANGLES).points["K"].position.T
    return lw.path_generator(PathTask(x=tuple(x), y=tuple(y), **PIVOTS, **timing))


def through_poses(machine: lw.Machine):
    """The linkage for three poses of the coupler."""
    moved = lw.kinematics(machine, POSES)
    (x, y), angle = moved.points["K"].position.T, moved.links["C.coupler"].angle
    poses = Poses(x=tuple(x), y=tuple(y), angle=tuple(angle))
    return lw.pose_guide(PoseTask(poses=poses, **PIVOTS))


def study(machine: lw.Machine) -> dict[str, float]:
    """Lengths of crank and rocker by each task."""
    timed, free = along_path(machine, crank_angle=tuple(ANGLES)), along_path(machine)
    poses = lw.linkage(through_poses(machine).machine).elements[-1].four_bar
    return {
        "timed_path_crank": timed.crank,
        "timed_path_rocker": timed.rocker,
        "path_crank": free.crank,
        "path_rocker": free.rocker,
        "poses_crank": poses.driver,
        "poses_rocker": poses.follower,
    }


def figure(machine: lw.Machine):
    """The points, and the path of the linkage that was found."""
    from linkwright.linkages.figures import linkage_figures

    same = along_path(machine, crank_angle=tuple(ANGLES)).machine
    drawing = list(linkage_figures(same, lw.linkage(same)))[-1].figure
    drawing.axes[0].plot(*lw.kinematics(machine, ANGLES).points["K"].position.T, "o")
    return drawing


if __name__ == "__main__":
    here = Path(__file__).parent
    example = lw.read(here / "machine.toml")
    print(*(f"{name:28} {value:.6g}" for name, value in study(example).items()), sep="\n")
    figure(example).savefig(here / "figure.png", dpi=120)

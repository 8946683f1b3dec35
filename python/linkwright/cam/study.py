"""What is known of all cams of a machine: which can be made, and how they work under load and at speed."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.cam.dynamics.follower_vibration import FollowerVibration, follower_vibration
from linkwright.cam.dynamics.loaded import LoadedCam, loaded_cam
from linkwright.cam.dynamics.one_mass import one_mass
from linkwright.cam.profile.faults import cam_cautions, cam_faults
from linkwright.cam.profile.profile import CamProfile, cam_profile
from linkwright.kernel.findings import Findings, sentence
from linkwright.kinetostatics.result import Forces
from linkwright.machine.machine import Machine


def sound_cams(machine: Machine, findings: Findings) -> tuple[tuple[CamProfile, ...], tuple[CamProfile, ...]]:
    """All cams, and those that can be made; what makes one impossible is a finding."""
    looked = [findings.of(cam_profile, machine, name) for name in machine.mechanism.cams]
    judged = [(name, cam_faults(name)) for name in looked if name is not None]
    findings.add(text for _, faults in judged for text in faults)
    return tuple(profile for profile, _ in judged), tuple(profile for profile, faults in judged if not faults)


def loaded_cams(
    machine: Machine, cams: tuple[CamProfile, ...], borne: Forces | None, findings: Findings
) -> tuple[LoadedCam, ...]:
    """The cams that can be made under load; a follower that leaves its cam is a finding."""
    speed = None if machine.drive is None else machine.drive.speed
    if not (machine.bodies or machine.loads) or (borne is None and speed is None):
        return ()
    along = None if borne is not None else speed
    loaded = [findings.of(loaded_cam, machine, cam, along) for cam in cams]
    return tuple(cam for cam in loaded if cam is not None)


def cam_vibrations(
    cams: tuple[CamProfile, ...], findings: Findings
) -> tuple[tuple[str, FollowerVibration], ...]:
    """Names of the cams whose follower vibrates, and how at the design speed."""
    return tuple(vibration for cam in cams for vibration in _vibration(cam, findings))


def _vibration(profile: CamProfile, findings: Findings) -> Iterator[tuple[str, FollowerVibration]]:
    """Vibration of a follower at the design speed; strikes and loss of contact are findings."""
    train, speed = profile.cam.train, profile.speed
    leaps = any(joint.order < 0 for joint in profile.cam.motion.joints)
    if train is None or not speed or leaps:
        return
    about = findings.about(f"cam {profile.name}: ")
    shaken = about.of(follower_vibration, profile.cam.lift, one_mass(train), abs(speed))
    if shaken is not None:
        yield profile.name, shaken


def cam_warnings(cams: tuple[CamProfile, ...]) -> tuple[str, ...]:
    """What the designer of cams should know, in sentences."""
    return tuple(sentence(text) for cam in cams for text in cam_cautions(cam))

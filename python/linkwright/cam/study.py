"""What is known of all cams of a machine: which can be made, and how they work under load and at speed."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.cam.dynamics.follower_vibration import FollowerVibration, follower_vibration
from linkwright.cam.dynamics.loaded import LoadedCam, loaded_cam
from linkwright.cam.dynamics.one_mass import one_mass
from linkwright.cam.profile.faults import cam_cautions, cam_faults
from linkwright.cam.profile.least_sizes import LeastSizes, least_sizes
from linkwright.cam.profile.profile import CamProfile, cam_profile
from linkwright.drive.model.motor import ConstantSpeedMotor
from linkwright.kernel.findings import Findings, sentence
from linkwright.machine.analysis import Results
from linkwright.machine.machine import Machine


def made_cams(known: Results, findings: Findings) -> dict[str, CamProfile]:
    """All cams by name; what makes one impossible is a finding, the others are its `sound_cams`."""
    looked = [findings.of(cam_profile, known.machine, name) for name in known.machine.mechanism.cams]
    judged = [(cam, cam_faults(cam)) for cam in looked if cam is not None]
    findings.add(text for _, faults in judged for text in faults)
    known.sound_cams = tuple(cam for cam, faults in judged if not faults)
    return {cam.name: cam for cam, _ in judged}


def made_sizes(known: Results, findings: Findings) -> dict[str, LeastSizes]:
    """How small each cam might be."""
    return {cam.name: least_sizes(cam) for cam in known.each("cam")}


def made_forces(known: Results, findings: Findings) -> dict[str, LoadedCam]:
    """The cams that can be made under load; a follower that leaves its cam is a finding."""
    machine = known.machine
    speed = machine.design_speed
    if not (machine.bodies or machine.all_loads) or (known.forces is None and speed is None):
        return {}
    along = None if known.steady_state is not None else speed
    loaded = [findings.of(loaded_cam, machine, cam, along) for cam in known.sound_cams]
    return {cam.name: cam for cam in loaded if cam is not None}


def made_vibrations(known: Results, findings: Findings) -> dict[str, FollowerVibration]:
    """How followers vibrate at the design speed."""
    return dict(vibration for cam in known.each("cam") for vibration in _vibration(cam, findings))


def check_cams(machine: Machine, findings: Findings) -> Iterator[str]:
    """Whether cams can be made, and at a known speed keep their followers."""
    known = Results(machine)
    made_cams(known, findings)
    yield "cams: undercut, self-intersection, pressure angle of 90°, concave parts, second followers"
    if known.sound_cams and _keeps_its_speed(machine) and (machine.bodies or machine.all_loads):
        for cam in known.sound_cams:
            findings.of(loaded_cam, machine, cam)
        yield "cams at constant speed: loss of contact"


def _keeps_its_speed(machine: Machine) -> bool:
    """Whether the speed is known without solving: that of its motor, or the design speed without one."""
    motor = None if machine.drive is None else machine.drive.motor
    return machine.design_speed is not None if motor is None else isinstance(motor, ConstantSpeedMotor)


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

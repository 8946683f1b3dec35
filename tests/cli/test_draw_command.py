"""``linkwright draw``: poses to scale, and motions."""

from __future__ import annotations

import os
import signal
import sys
import time
from io import BytesIO
from pathlib import Path
from subprocess import PIPE, STDOUT, Popen

import ezdxf
import numpy as np
import pytest
from click.testing import Result
from command_line import invoke
from PIL import Image

import linkwright as lw
from linkwright.app.report.moving import gif, mp4
from linkwright.app.report.scene import moving_scene

ROOT = Path(__file__).parents[2]
CARTS = str(ROOT / "machines" / "roller_two_carts.toml")


def called(*words: str) -> Result:
    return invoke("draw", *words)


def test_dxf_has_the_joints_where_the_motion_has_them(tmp_path: Path) -> None:
    place = tmp_path / "pose.dxf"
    result = called(CARTS, "--out", str(place), "--at", "33.3 deg")
    assert result.exit_code == 0, result.output
    drawn = ezdxf.readfile(place).modelspace()  # type: ignore[attr-defined]
    found = {tuple(np.round(point.dxf.location, 9)[:2]) for point in drawn.query("POINT")}
    motion = lw.kinematics(lw.read(CARTS), np.radians([33.3]))
    # In millimetres; the file has the digits of a double.
    assert motion.points
    for point in motion.points.values():
        assert tuple(np.round(1e3 * point.position[0], 9)) in found


def test_dxf_has_the_horsehead_and_the_faces_of_followers(tmp_path: Path) -> None:
    place = tmp_path / "pose.dxf"
    unit = "examples/pumping_unit_torque/machine.toml"
    assert called(unit, "--out", str(place)).exit_code == 0
    (arc,) = ezdxf.readfile(place).modelspace().query("ARC")  # type: ignore[attr-defined]
    # The horsehead is an arc about the saddle with the length A of the beam as its radius, 72 in.
    assert arc.dxf.radius == pytest.approx(72 * 25.4)
    assert called("examples/cam_constant_breadth/machine.toml", "--out", str(place), "--force").exit_code == 0
    lines = ezdxf.readfile(place).modelspace().query('LINE[layer=="LINKS"]')  # type: ignore[attr-defined]
    # Two flat faces, upright and 0.1 m apart.
    upright = sorted(line.dxf.start.x for line in lines if abs(line.dxf.start.x - line.dxf.end.x) < 1e-9)
    assert upright[-1] - upright[0] == pytest.approx(100)


def test_gif_lasts_as_long_as_asked_and_moves() -> None:
    scene = moving_scene(lw.read(CARTS), None)
    assert scene is not None
    with Image.open(BytesIO(gif(scene, 0.4))) as picture:
        assert picture.n_frames == 10
        assert picture.info["duration"] == 40
        first = np.asarray(picture.convert("L"), int)
        picture.seek(5)
        assert np.abs(np.asarray(picture.convert("L"), int) - first).max() > 50


def test_mp4_is_one() -> None:
    scene = moving_scene(lw.read(CARTS), None)
    assert scene is not None
    assert mp4(scene, 0.2)[4:8] == b"ftyp"


def _encoder(folder: Path, lines: str) -> Path:
    place = folder / "encoder"
    place.write_text(f"#!/bin/sh\n{lines}\n")
    place.chmod(0o755)
    return place


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="needs the processes of Linux")
def test_an_interrupted_mp4_says_nothing_and_leaves_nothing(tmp_path: Path) -> None:
    # It takes nothing for a while, so that Ctrl-C comes in the midst of a picture.
    encoder = _encoder(tmp_path, "sleep 3; cat > /dev/null; echo corrupt input packet >&2")
    words = ["draw", CARTS, "--out", str(tmp_path / "motion.mp4")]
    call = f"import sys; from linkwright.app import main; sys.argv[1:] = {words}; main()"
    process = Popen(
        [sys.executable, "-c", call],
        stdout=PIPE,
        stderr=STDOUT,
        start_new_session=True,
        # Whatever started the tests may have it ignored.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        env={**os.environ, "IMAGEIO_FFMPEG_EXE": str(encoder)},
    )
    begun = Path(f"/proc/{process.pid}/task/{process.pid}/children")
    end = time.monotonic() + 120
    while not begun.read_text() and time.monotonic() < end:
        time.sleep(0.02)
    time.sleep(0.3)
    os.killpg(process.pid, signal.SIGINT)
    assert process.communicate(timeout=120) == (b"", None)
    assert process.returncode == 130
    assert list(tmp_path.iterdir()) == [encoder]


@pytest.mark.skipif(os.name == "nt", reason="needs a shell of Unix")
def test_what_an_encoder_says_is_read_when_it_fails(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    encoder = _encoder(tmp_path, "echo no such codec >&2; exit 3")
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", str(encoder))
    result = called(CARTS, "--out", str(tmp_path / "motion.mp4"), "--seconds", "0.2")
    assert (result.exit_code, "made no MP4: no such codec" in result.output) == (2, True), result.output


@pytest.mark.parametrize(
    ("words", "said", "code"),
    [
        (("--out", "a.txt"), "expected a file that ends in .svg", 2),
        (("--at", "30"), "which may be deg or rad", 2),
        (("--seconds", "1 h"), "expected 0.1 s to 120 s", 2),
        (("--at", "90 deg", "--set", "mechanism.sliders.cart1.rod=0.1"), "closes only at crank angles", 1),
    ],
)
def test_what_cannot_be_drawn_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], said: str, code: int
) -> None:
    monkeypatch.chdir(tmp_path)
    result = called(CARTS, *words)
    assert (result.exit_code, said in result.output) == (code, True), result.output
    assert not list(tmp_path.iterdir())


def test_a_pose_is_that_of_the_angle_given(tmp_path: Path) -> None:
    """Of a screw, whose motion never repeats, and of one that repeats after six revolutions."""
    place = tmp_path / "pose.dxf"
    for machine, angle, name in (("scissor_lift", "49680 deg", "post"), ("gears_and_guides", "450 deg", "Q")):
        file = f"examples/{machine}/machine.toml"
        done = called(file, "--at", angle, "--out", str(place), "--force")
        assert done.exit_code == 0, done.output
        drawn = ezdxf.readfile(place).modelspace()  # type: ignore[attr-defined]
        found = {tuple(np.round(point.dxf.location, 6)[:2] + 0.0) for point in drawn.query("POINT")}
        # In millimetres, to what a rotation of many revolutions leaves of its digits.
        pose = lw.pose(lw.read(file), np.radians(float(angle.split()[0])))
        assert tuple(np.round(1e3 * np.array(pose.points[name].position), 6) + 0.0) in found


@pytest.mark.parametrize(
    ("machine", "angle", "code", "words"),
    [
        ("examples/scissor_lift/machine.toml", "-5000 deg", 1, "closes only at drive angles"),
        ("machines/topper.toml", "0 deg", 2, "has no mechanism"),
    ],
)
def test_what_cannot_be_drawn(machine: str, angle: str, code: int, words: str) -> None:
    done = called(machine, "--at", angle)
    assert done.exit_code == code
    assert words in done.stderr

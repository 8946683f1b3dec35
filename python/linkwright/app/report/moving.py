"""The motion of a mechanism as GIF or MP4, and one pose of it as DXF."""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO, StringIO
from itertools import chain
from pathlib import Path
from subprocess import PIPE, Popen
from tempfile import TemporaryDirectory, TemporaryFile
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from linkwright.app.report.sketch import Pose, paint
from linkwright.kernel.arrays import Floats
from linkwright.kernel.errors import InputError
from linkwright.kernel.extras import require
from linkwright.kernel.figure.style import WIDTH, styled
from linkwright.kernel.system import apart, is_unread

if TYPE_CHECKING:
    from ezdxf.layouts.layout import Modelspace

Bytes = NDArray[np.uint8]
Scene = dict[str, Any]

# Pictures a second, and dots an inch: 710 dots across.
_RATE, _DOTS = 25, 100

# Layers of a DXF file with their colours of AutoCAD; lengths there are millimetres.
_LAYERS = {"LINKS": 5, "JOINTS": 7, "GUIDES": 8, "PATHS": 9, "GEARS": 3, "CAMS": 1, "TEXT": 8}
_MM = 1e3


def gif(scene: Scene, seconds: float) -> bytes:
    """The motion as GIF, again and again; ``seconds`` for all of it."""
    from PIL import Image

    pictures = [Image.fromarray(frame).quantize(64) for frame in _frames(scene, seconds)]
    data = BytesIO()
    first, *rest = pictures
    first.save(data, "GIF", save_all=True, append_images=rest, duration=1000 // _RATE, loop=0)
    return data.getvalue()


def mp4(scene: Scene, seconds: float) -> bytes:
    """The motion as MP4 (H.264); ``seconds`` for all of it. An `InputError` without the encoder."""
    encoder = require("imageio_ffmpeg", "video", "an MP4 needs an encoder, imageio-ffmpeg")
    with TemporaryDirectory() as folder:
        place = Path(folder) / "motion.mp4"
        _encode(encoder.get_ffmpeg_exe(), _frames(scene, seconds), place)
        return place.read_bytes()


def _encode(encoder: str, frames: Iterator[Bytes], place: Path) -> None:
    """Write pictures as H.264. What the encoder says is read if it fails, and never printed."""
    # It takes even numbers of dots alone.
    even = (frame[: len(frame) // 2 * 2, : frame.shape[1] // 2 * 2] for frame in frames)
    first = next(even)
    height, width, _ = first.shape
    taken = ("-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", str(_RATE), "-i", "-")
    made = ("-an", "-c:v", "libx264", "-pix_fmt", "yuv420p", "-v", "error", str(place))
    words = (encoder, *taken, *made)
    with TemporaryFile("w+", encoding="utf-8") as log:
        # Ctrl-C is for this process alone, which ends the encoder in the midst of a picture.
        with Popen(words, stdin=PIPE, stderr=log, bufsize=0, **apart()) as process:
            try:
                for frame in chain((first,), even):
                    _write(process.stdin, frame.tobytes())
            except BaseException as error:
                if not (isinstance(error, OSError) and is_unread(error)):
                    process.kill()
                    raise
                # It has ended by itself, and its words say why.
                process.wait()
        if process.returncode:
            log.seek(0)
            reason = log.read().strip() or f"it ended with code {process.returncode}"
            raise InputError(f"{encoder} made no MP4: {reason}")


def _write(pipe: Any, data: bytes) -> None:
    left = memoryview(data)
    while left:
        left = left[pipe.write(left) :]


@styled
def _drawn(scene: Scene, places: Floats) -> Iterator[Bytes]:
    """Pictures at places of the motion, from 0 to 1; all show the same part of the plane."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    left, bottom, right, top = scene["box"]
    room = 0.1 * max(right - left, top - bottom)
    shape = (top - bottom + 2 * room) / (right - left + 2 * room)
    across = WIDTH if shape <= 1 else WIDTH / shape
    figure = Figure(figsize=(across, across * shape), dpi=_DOTS)
    # Its types do not tell of drawing.
    canvas: Any = FigureCanvasAgg(figure)
    axes = figure.add_axes((0, 0, 1, 1))
    for place in places:
        axes.clear()
        axes.set_axis_off()
        paint(axes, scene, float(place))
        axes.set_xlim(left - room, right + room)
        axes.set_ylim(bottom - room, top + room)
        canvas.draw()
        yield np.asarray(canvas.buffer_rgba())[:, :, :3].copy()


def _frames(scene: Scene, seconds: float) -> Iterator[Bytes]:
    """Frames at equal times of the motion; one that swings goes forth and back."""
    times = np.asarray(scene["times"])
    count = max(round(_RATE * seconds), 2)
    way = np.arange(count) / count
    if scene["swings"]:
        way = 1 - np.abs(1 - 2 * way)
    shares = np.linspace(0, 1, len(times))
    yield from _drawn(scene, np.interp(way * times[-1], times, shares))


def dxf(scene: Scene, place: float) -> str:
    """One pose as DXF in millimetres: links, joints, guides, paths, gears and cams, each on its layer."""
    from linkwright.cam.manufacture.dxf import new_document

    document = new_document()
    for layer, colour in _LAYERS.items():
        document.layers.add(layer, color=colour)
    _Drawing(document.modelspace(), Pose(scene, place)).draw()
    left, bottom, right, top = (_MM * end for end in scene["box"])
    document.set_modelspace_vport(
        height=1.3 * (top - bottom), center=((left + right) / 2, (bottom + top) / 2)
    )
    text = StringIO()
    document.write(text)
    return text.getvalue()


class _Drawing:
    """Draws the parts of a pose that have a shape in the plane."""

    def __init__(self, space: Modelspace, pose: Pose) -> None:
        self.space, self.pose = space, pose
        left, bottom, right, top = pose.scene["box"]
        self.size = 0.008 * _MM * max(right - left, top - bottom)

    def draw(self) -> None:
        for part in self.pose.scene["parts"]:
            kind = getattr(self, f"_{part['kind']}", None)
            if kind is not None:
                kind(part)

    def _line(self, points: Any, layer: str, *, close: bool = False) -> None:
        rows = (_MM * np.asarray(points)).tolist()
        if len(rows) == 2:
            self.space.add_line(rows[0], rows[1], dxfattribs={"layer": layer})
        else:
            self.space.add_lwpolyline(rows, format="xy", close=close, dxfattribs={"layer": layer})

    def _link(self, part: Scene) -> None:
        self._line([self.pose.at(part["from"]), self.pose.at(part["to"])], "LINKS")

    def _plate(self, part: Scene) -> None:
        self._line([self.pose.at(name) for name in part["corners"]], "LINKS", close=True)

    def _slot(self, part: Scene) -> None:
        y, (a, b) = part["offset"], part["bar"]
        self._line(self.pose.carried(part, [[a, y], [b, y]]), "LINKS")

    def _guide(self, part: Scene) -> None:
        self._line(part["ends"], "GUIDES")

    def _trace(self, part: Scene) -> None:
        self._line(self.pose.scene["points"][part["name"]], "PATHS")

    def _gear(self, part: Scene) -> None:
        centre = (_MM * self.pose.at(part["at"])).tolist()
        self.space.add_circle(centre, _MM * part["radius"], dxfattribs={"layer": "GEARS"})

    def _cam(self, part: Scene) -> None:
        for outline in part["outlines"]:
            self._line(self.pose.carried(part, outline), "CAMS", close=True)

    def _arc(self, part: Scene) -> None:
        low, high = part["span"]
        ends = [[part["radius"] * np.cos(angle), part["radius"] * np.sin(angle)] for angle in (low, high)]
        centre, start, end = _MM * self.pose.carried(part, [[0, 0], *ends])
        first, last = (float(np.degrees(np.arctan2(*(tip - centre)[::-1]))) for tip in (start, end))
        layer = {"layer": "LINKS"}
        self.space.add_arc(centre.tolist(), _MM * part["radius"], first, last, dxfattribs=layer)
        for tip in (start, end):
            self.space.add_line(centre.tolist(), tip.tolist(), dxfattribs=layer)

    def _face(self, part: Scene) -> None:
        self._rod(part)
        along = np.array([np.cos(part["along"]), np.sin(part["along"])])
        ends = [np.asarray(part["place"]) + end * along for end in part["ends"]]
        self._line(self.pose.carried(part, ends), "LINKS")

    def _rod(self, part: Scene) -> None:
        if part["rod"]:
            self._line(self.pose.carried(part, [part["place"], part["rod"]]), "LINKS")

    def _roller(self, part: Scene) -> None:
        self._rod(part)
        centre = (_MM * self.pose.carried(part, [part["place"]])[0]).tolist()
        self.space.add_circle(centre, _MM * part["radius"], dxfattribs={"layer": "JOINTS"})

    def _ground(self, part: Scene) -> None:
        self._joint(part["name"])

    def _point(self, part: Scene) -> None:
        self._joint(part["name"])

    def _joint(self, name: str) -> None:
        centre = (_MM * self.pose.at(name)).tolist()
        self.space.add_point(centre, dxfattribs={"layer": "JOINTS"})
        self.space.add_circle(centre, self.size, dxfattribs={"layer": "JOINTS"})
        words = self.space.add_text(name, height=2 * self.size, dxfattribs={"layer": "TEXT"})
        words.set_placement((centre[0] + 2 * self.size, centre[1] + 2 * self.size))

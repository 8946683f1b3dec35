"""Imports point down within a room, and lead to other rooms along listed edges alone."""

from __future__ import annotations

import ast
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest
from tests.style.layers import ROOT, circles, imported

# Files that may import each other in a circle.
_CIRCLE_MAX = 2

# Parts of the house from below. What is in no named part of a room computes.
KERNEL, LAWS, MODEL, MACHINE, COMPUTES, SHOWS, STUDY, COMMANDS, PAPERS, APP = range(10)

PARTS = {
    "laws": LAWS,
    "model": MODEL,
    "tables": SHOWS,
    "figures": SHOWS,
    "scene": SHOWS,
    "page": SHOWS,
    "analyses": STUDY,
    "commands": COMMANDS,
}

# Rooms that are not subjects, and where their parts stand.
HOUSE = {
    "kernel": KERNEL,
    "machine": MACHINE,
    "app.subjects": STUDY,
    "app.study": STUDY,
    "app.feasibility": STUDY,
    "app.report": STUDY,
    # Studies stand above all subjects; what they draw and print stands above what they compute.
    "studies": STUDY,
    "studies.model": MODEL,
    "studies.figures": COMMANDS,
    "studies.tables": COMMANDS,
    "studies.commands": COMMANDS,
    # So do derivatives.
    "sensitivity": STUDY,
    "sensitivity.commands": COMMANDS,
    "papers": PAPERS,
    # Tables and figures of a topper show what a published length suffices for.
    "papers.published_lengths": COMPUTES,
    "app": APP,
    "studio": APP,
    "__main__": APP,
}

SUBJECTS = (
    "linkages",
    "drive",
    "driveline",
    "kinetostatics",
    "outlines",
    "finite_elements",
    "cam",
    "torsion",
    "pumping",
    "rods",
    "topping",
    "turning",
    "axes",
    "synthesis",
    "sizing",
    "fmi",
    "multibody",
)

# What a part of a subject may use of another subject, and why. Every subject may use the model of any that it
# is listed with; `machine`, which puts all models together, and the kernel are open to all.
EDGES = {
    # A cam is a driver of the linkage: a mechanism lists cams, a cam stands on the mechanism's points.
    ("linkages.model", "cam.model"),
    ("linkages.scene", "cam.scene"),
    # The sketch of a mechanism shows its bodies and springs.
    ("linkages.scene", "kinetostatics.model"),
    # Commands say at which speed of the crank they compute.
    ("linkages.commands", "drive"),
    ("cam.model", "linkages.model"),
    ("cam.profile", "linkages.model"),
    ("cam.scene", "linkages.model"),
    # The contact force of a cam comes from the equilibrium of its machine in steady motion, ...
    ("cam.dynamics", "drive"),
    ("cam.dynamics", "kinetostatics"),
    ("cam.study", "drive.model"),
    # ... where it acts along the normal of the contact.
    ("kinetostatics", "cam.model"),
    ("kinetostatics", "cam.profile"),
    # Bodies and loads hang on points and links.
    ("kinetostatics.model", "linkages.model"),
    ("kinetostatics", "linkages"),
    ("kinetostatics", "linkages.model"),
    ("kinetostatics.commands", "linkages.model"),
    # Forces are asked for along the motion of a drive.
    ("kinetostatics", "drive"),
    ("kinetostatics", "drive.model"),
    ("kinetostatics.commands", "drive"),
    # Crank angles are counted from a dead centre of the linkage.
    ("kinetostatics.commands", "linkages"),
    # The loads on one link are part of the equilibrium of all.
    ("finite_elements", "drive"),
    ("finite_elements", "kinetostatics"),
    ("finite_elements", "kinetostatics.model"),
    ("finite_elements.commands", "drive"),
    ("finite_elements.commands", "kinetostatics"),
    ("finite_elements.commands", "kinetostatics.commands"),
    ("finite_elements.commands", "linkages"),
    # A drive moves a linkage against its loads; its shafts are those of torsion.
    ("drive", "linkages"),
    ("drive.commands", "linkages"),
    # The forces along a motion in time tell whether followers and cables keep contact.
    ("drive.commands", "kinetostatics"),
    ("drive", "kinetostatics.model"),
    ("drive.model", "torsion.model"),
    # A torsionally flexible driveline is a train, and drives a mechanism against its loads.
    ("driveline", "drive"),
    ("driveline", "drive.model"),
    ("driveline", "linkages"),
    ("driveline", "torsion.model"),
    ("driveline", "torsion.core"),
    ("driveline", "torsion.excitation"),
    ("driveline", "torsion.in_time"),
    # The motion in time of a drive is that of its driveline where this is flexible.
    ("driveline.commands", "drive.commands"),
    ("driveline.commands", "linkages"),
    # A machine without a motor has no forces in steady motion and no vibration of its driveline.
    ("kinetostatics.analyses", "drive"),
    ("torsion.analyses", "drive"),
    # A torsionally flexible driveline is a train.
    ("torsion.model", "drive.model"),
    ("torsion.core", "drive.model"),
    ("torsion.excitation", "drive"),
    ("torsion.excitation", "drive.model"),
    ("torsion.in_time", "drive.model"),
    ("torsion.excitation", "linkages"),
    ("torsion.model", "linkages.model"),
    ("torsion.core", "linkages.model"),
    # A pumping unit is a linkage.
    ("pumping.model", "linkages.model"),
    ("pumping", "linkages"),
    ("pumping", "linkages.model"),
    # An axis moves a driver of the linkage by sections of cams, through gears as a drive has them, ...
    ("axes.model", "cam.laws"),
    ("axes.model", "cam.model"),
    ("axes.model", "drive.model"),
    ("axes.model", "linkages.model"),
    # ... with the torque that kinetostatics finds along the motion of its master, a crankshaft perhaps.
    ("axes", "drive"),
    ("axes", "kinetostatics"),
    ("axes", "linkages"),
    ("axes.commands", "drive"),
    # A knife moves by a law, or by a mechanism, and takes a force.
    ("topping", "cam.laws"),
    ("topping", "kinetostatics"),
    ("topping", "linkages"),
    ("topping.model", "linkages.model"),
    # A rod string hangs on the polished rod of a unit, at the speed that the drive has under its load.
    ("rods", "drive"),
    ("rods", "kinetostatics.model"),
    ("rods", "pumping"),
    ("rods", "pumping.model"),
    ("rods.model", "pumping.model"),
    ("rods.tables", "pumping"),
    ("rods.figures", "pumping"),
    ("rods.figures", "pumping.figures"),
    ("rods.scene", "pumping.model"),
    # What is found is verified by analysis.
    ("synthesis", "linkages"),
    # A path of a task and of a study is described alike.
    ("synthesis", "linkages.model"),
    ("sizing", "drive"),
    ("sizing", "drive.model"),
    # A motor is to drive a machine that keeps its contacts.
    ("sizing", "kinetostatics"),
    ("sizing", "linkages"),
    ("sizing.commands", "drive.model"),
    # An FMU is a drive with its mechanism.
    ("fmi", "drive"),
    ("fmi", "drive.model"),
    ("fmi", "driveline"),
    ("fmi", "linkages"),
    ("fmi", "torsion.model"),
    ("fmi.commands", "drive.commands"),
    ("fmi.commands", "driveline.commands"),
    # A model of multibody dynamics has the bodies of the equilibrium, and the driveline.
    ("multibody", "drive.model"),
    ("multibody", "kinetostatics"),
    ("multibody", "kinetostatics.model"),
    ("multibody", "linkages"),
    ("multibody", "linkages.model"),
    ("multibody.commands", "drive.commands"),
    # A law that goes to a controller is a motion law.
    ("axes.export", "cam.laws"),
}

# Folders of the room of trains, each of which uses those before it.
TRAINS = (
    "model",
    "core",
    "excitation",
    "modes",
    "response",
    "limits",
    "in_time",
    "damper",
    "diagnosis",
    "gradient",
    "study",
    "tables",
    "figures",
    "page",
    "commands",
)

# The modules that may import the compiled core.
CORE = ("machine.program", "cam.core", "torsion.core", "topping.core", "rods.core", "fmi.core")


@cache
def imports(path: Path, root: Path = ROOT) -> tuple[tuple[str, ...], ...]:
    """Dotted names below linkwright that a file imports, also inside its functions."""
    return tuple(tuple(name.split(".")) for name in imported(path, root, types=True))


def level(name: tuple[str, ...]) -> int:
    for length in (2, 1):
        if ".".join(name[:length]) in HOUSE:
            return HOUSE[".".join(name[:length])]
    return PARTS.get(name[1], COMPUTES) if len(name) > 1 else COMPUTES


@cache
def part(name: tuple[str, ...]) -> str:
    """The part of a subject that a module is in: a folder of its own, or the room."""
    folder = len(name) > 1 and (ROOT / name[0] / name[1]).is_dir()
    return ".".join(name[:2]) if folder or (len(name) > 1 and name[1] in PARTS) else name[0]


def is_allowed(own: tuple[str, ...], target: tuple[str, ...]) -> bool:
    if target[0] == "_core":
        return any(".".join(own).startswith(each) for each in CORE)
    if level(target) > level(own):
        return False
    apart = own[0] != target[0] and own[0] in SUBJECTS and target[0] in SUBJECTS
    return not apart or _is_edge(own, target)


def _is_edge(own: tuple[str, ...], target: tuple[str, ...]) -> bool:
    """Whether an edge of the list joins two modules; one of a room holds for the files beside its folders."""
    names = {part(own), ".".join(own[:2]) if len(own) > 1 else own[0]}
    return any((name, part(target)) in EDGES for name in names)


def wrong_imports(root: Path) -> list[str]:
    """Imports that do not point down, or leave their room without an edge."""
    wrong = []
    for path in sorted(root.rglob("*.py")):
        own = path.relative_to(root).with_suffix("").parts
        if own == ("__init__",):
            continue
        for target in imports(path, root):
            if target[0] not in (*SUBJECTS, *HOUSE, "_core"):
                continue
            if not is_allowed(own, target):
                wrong.append(f"{path.relative_to(root)} imports {'.'.join(target)}")
    return wrong


def test_imports_point_down_and_keep_to_their_room() -> None:
    wrong = wrong_imports(ROOT)
    assert not wrong, "\n".join(wrong)


def test_no_circle_of_imports_has_more_than_a_few_files() -> None:
    assert [circle for circle in circles() if len(circle) > _CIRCLE_MAX] == []


def test_folders_of_trains_use_those_before_them() -> None:
    room = ROOT / "torsion"
    assert {path.stem for path in room.iterdir() if not path.stem.startswith("_")} == {*TRAINS, "analyses"}
    wrong = [
        f"{path.relative_to(ROOT)} imports {'.'.join(target)}"
        for path in sorted(room.rglob("*.py"))
        for target in imports(path)
        if target[0] == "torsion" and path.parts[len(room.parts)] not in ("__init__.py", "analyses.py")
        if TRAINS.index(target[1]) > TRAINS.index(Path(path.parts[len(room.parts)]).stem)
    ]
    assert not wrong, "\n".join(wrong)


def test_every_room_is_listed() -> None:
    rooms = {path.name for path in ROOT.iterdir() if (path / "__init__.py").exists()}
    assert rooms == {*SUBJECTS, "kernel", "machine", "studies", "sensitivity", "papers", "app", "studio"}


def test_every_room_has_its_map() -> None:
    missing = []
    for folder in sorted({path.parent for path in ROOT.rglob("*.py")} - {ROOT}):
        told = ast.get_docstring(ast.parse((folder / "__init__.py").read_text(encoding="utf-8"))) or ""
        inside = {f"`{path.stem}`" for path in folder.glob("*.py") if not path.stem.startswith("_")}
        inside |= {f"`{path.parent.name}/`" for path in folder.glob("*/__init__.py")}
        if len(inside) > 1:
            missing += [f"{folder.relative_to(ROOT)}: {name}" for name in sorted(inside) if name not in told]
    assert not missing, "\n".join(missing)


@pytest.mark.parametrize("stub", sorted(ROOT.rglob("__init__.pyi")), ids=lambda path: path.parent.name)
def test_a_room_exports_what_its_stub_lists(stub: Path) -> None:
    """Each name is listed once, is none of a module beside the stub, and is imported on first use."""
    names = [line.split()[3] for line in stub.read_text(encoding="utf-8").splitlines() if line[:5] == "from "]
    assert len(names) == len(set(names))
    assert not {path.stem for path in stub.parent.iterdir() if stub.parent != ROOT} & set(names)
    room = import_module(".".join(("linkwright", *stub.parent.relative_to(ROOT).parts)))
    assert all(getattr(room, name).__name__ == name for name in names if name[:1].islower())
    with pytest.raises(AttributeError, match="has no attribute 'nothing_like_it'"):
        room.nothing_like_it  # noqa: B018


def test_every_edge_is_used() -> None:
    used = set()
    for path in ROOT.rglob("*.py"):
        own = path.relative_to(ROOT).with_suffix("").parts
        for target in imports(path, ROOT):
            names = {part(own), ".".join(own[:2])} if own[0] in SUBJECTS else set()
            used |= {(name, part(target)) for name in names if target[0] in SUBJECTS}
    assert used >= EDGES, EDGES - used


def test_a_wrong_import_is_found(tmp_path: Path) -> None:
    files = {
        "kernel/units.py": "from linkwright.machine.machine import Machine",
        "machine/read.py": "def f():\n    from linkwright.drive import steady_state",
        "sizing/motor.py": "from ..synthesis import cam\nfrom .shaft import x\nfrom linkwright import _core",
        "topping/model/topper.py": "from ..tables import topper\nimport linkwright.topping.core",
        "linkages/pose.py": "from linkwright.app.study import study",
        "drive/figures.py": "from linkwright.drive.steady_state import SteadyState\nimport numpy",
    }
    for name, text in files.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    assert wrong_imports(tmp_path) == [
        "kernel/units.py imports machine.machine.Machine",
        "linkages/pose.py imports app.study.study",
        "machine/read.py imports drive.steady_state",
        "sizing/motor.py imports synthesis.cam",
        "sizing/motor.py imports _core",
        "topping/model/topper.py imports topping.tables.topper",
        "topping/model/topper.py imports topping.core",
    ]

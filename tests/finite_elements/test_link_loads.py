"""Loads on single links: m a by differences, closed forms, and the text of steps read back."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from command_line import invoke
from zoo import ZOO, animal

import linkwright as lw
from linkwright import InputError
from linkwright.finite_elements import LinkLoads, Model, NodeSet, read_mesh, step_text
from linkwright.kinetostatics.places import structure_of

CRANK_ROCKER = """
format = 1
name = "Crank-rocker"
[drive]
speed = "30 rad/s"
[mechanism]
points = { D = { x = "400 mm" } }
cranks.A = { radius = "100 mm" }
rockers.R = { crank = "A", pivot = "D", coupler = "350 mm", rocker = "250 mm", assembly = "left" }
[bodies]
A = { mass = 2 }
"R.coupler" = { mass = 1.5, inertia = 0.03, along = "150 mm", across = "20 mm" }
"R.rocker" = { mass = 1.2 }
[loads]
gravity = { kind = "gravity" }
work = { kind = "torque", on = "R.rocker", torque = 25 }
"""

SPEED, ACCELERATION = 3.0, 1.5

# By the file format.
GRAVITY = np.array([0.0, -9.81])


@cache
def four_bar() -> lw.Machine:
    return lw.loads(CRANK_ROCKER)


@pytest.mark.parametrize("name", ZOO)
def test_every_link_is_in_balance(name: str) -> None:
    """Forces, weight and inertia of every member of every mechanism add up to nothing."""
    machine = animal(name)
    for link in structure_of(machine).members:
        loads = lw.link_loads(machine, link, speed=SPEED, acceleration=ACCELERATION, n=24)
        assert loads.residual < 1e-10, link


@pytest.mark.parametrize("link", ["A", "R.coupler", "R.rocker"])
def test_joint_forces_are_mass_times_acceleration(link: str) -> None:
    """Positions of the links alone, differentiated twice by splines: m a − m g and J α, about the start."""
    from scipy.interpolate import CubicSpline

    machine, omega = four_bar(), 30.0
    loads = lw.link_loads(machine, link, n=720)
    motion = lw.kinematics(machine, loads.crank_angle)
    start = {"A": np.zeros((721, 2)), "R.coupler": motion.points["A"].position}.get(
        link, np.broadcast_to((0.4, 0.0), (721, 2))
    )
    angle = np.unwrap(motion.links[link].angle)
    length, mass = {"A": (0.1, 2), "R.coupler": (0.35, 1.5), "R.rocker": (0.25, 1.2)}[link]
    along, across, inertia = 0.5 * length, 0.0, mass * length**2 / 12
    if link == "R.coupler":
        along, across, inertia = 0.15, 0.02, 0.03
    e = np.column_stack([np.cos(angle), np.sin(angle)])
    n = np.column_stack([-e[:, 1], e[:, 0]])
    time = loads.crank_angle / omega
    centre = start + along * e + across * n
    acceleration = CubicSpline(time, centre, axis=0)(time, 2)
    alpha = CubicSpline(time, angle)(time, 2)
    force = mass * (acceleration - GRAVITY)
    moment = inertia * alpha + (centre - start)[:, 0] * force[:, 1] - (centre - start)[:, 1] * force[:, 0]
    joints = sum(load.force for load in loads.loads.values())
    turning = sum(
        load.moment + load.place[:, 0] * load.force[:, 1] - load.place[:, 1] * load.force[:, 0]
        for load in loads.loads.values()
    )
    inner = slice(20, -20)
    own = np.column_stack([(force * e).sum(axis=1), (force * n).sum(axis=1)])
    assert joints[inner] == pytest.approx(own[inner], abs=2e-4 * np.abs(own).max())
    assert turning[inner] == pytest.approx(moment[inner], abs=2e-4 * np.abs(moment).max())


def test_acceleration_field() -> None:
    """a₀ + α × r − ω² r at the far end is the acceleration of the next joint."""
    machine = four_bar()
    loads = lw.link_loads(machine, "R.coupler")
    joint = lw.kinematics(machine, loads.crank_angle).points["R"]
    e = np.column_stack([np.cos(loads.angle), np.sin(loads.angle)])
    acceleration = joint.d2 * 30.0**2
    own = np.column_stack(
        [(acceleration * e).sum(1), acceleration[:, 1] * e[:, 0] - acceleration[:, 0] * e[:, 1]]
    )
    field = loads.origin_acceleration + 0.35 * np.column_stack([-(loads.speed**2), loads.acceleration])
    assert field == pytest.approx(own, rel=1e-10, abs=1e-9)


def test_bending_of_a_lever_with_a_force_at_its_end() -> None:
    """A lever at rest under F across its end: M = F l at the pivot; with its own weight m g l/2 more."""
    machine = lw.loads(
        """
        format = 1
        name = "Lever"
        [mechanism.cranks.A]
        radius = 0.5
        [bodies]
        A = { mass = 4 }
        [loads]
        gravity = { kind = "gravity", acceleration = 10 }
        pull = { kind = "force", on = "A", force = 70, direction = "-90 deg" }
        """
    )
    loads = lw.link_loads(machine, "A", speed=0.0, angles=[0.0])
    assert abs(loads.bending[0]) == pytest.approx(70 * 0.5 + 4 * 10 * 0.25, rel=1e-6)
    assert loads.bending_place[0] == pytest.approx(0, abs=1e-6)


def test_bending_of_a_swinging_rod() -> None:
    """A uniform rod that is accelerated by a torque at its pivot: M = J α there, about the pivot."""
    machine = lw.loads(
        """
        format = 1
        name = "Rod"
        [mechanism.cranks.A]
        radius = 0.6
        [bodies]
        A = { mass_per_length = 5 }
        """
    )
    loads = lw.link_loads(machine, "A", speed=2.0, acceleration=7.0, angles=[0.3])
    assert abs(loads.bending[0]) == pytest.approx(5 * 0.6**3 / 3 * 7, rel=1e-6)


def test_whip_of_a_connecting_rod() -> None:
    """m r ω² l/(9√3) in a uniform rod square to its crank (Khurmi, Gupta, Theory of Machines, chapter 15)."""
    length, radius, omega = 10.0, 0.1, 20.0
    machine = lw.loads(
        f"""
        format = 1
        name = "Long rod"
        [mechanism.cranks.A]
        radius = {radius}
        [mechanism.sliders.S]
        crank = "A"
        rod = {length}
        [bodies]
        "S.rod" = {{ mass_per_length = 3 }}
        """
    )
    loads = lw.link_loads(machine, "S.rod", speed=omega, angles=[np.arctan(length / radius)])
    whip = 3 * length * radius * omega**2 * length / (9 * np.sqrt(3))
    # The slider end is accelerated across the rod by (r/l)² of the crank's.
    assert abs(loads.bending[0]) == pytest.approx(whip, rel=1e-3)
    assert loads.bending_place[0] == pytest.approx(length * (1 - 1 / np.sqrt(3)), abs=0.05)


def test_instants_are_where_curves_peak() -> None:
    """Each named instant is the crank angle of the largest value of its curve."""
    loads = lw.link_loads(four_bar(), "R.coupler")
    at = {name: instant.place for instant in loads.instants for name in instant.names}
    assert at["maximum force at A"] == int(np.argmax(loads.loads["A"].size))
    assert at["maximum bending moment"] == int(np.argmax(np.abs(loads.bending)))
    assert at["maximum angular acceleration"] == int(np.argmax(np.abs(loads.acceleration)))


def test_an_unknown_link_is_refused() -> None:
    """With a name that was meant."""
    with pytest.raises(InputError, match=r'did you mean "R.coupler"'):
        lw.link_loads(four_bar(), "R.couple")


# -- steps of finite elements --------------------------------------------------------------------------------


def read_back(text: str) -> list[dict[str, list[list[str]]]]:
    """Data lines of each step by keyword."""
    steps: list[dict[str, list[list[str]]]] = []
    keyword = ""
    for line in text.splitlines():
        if line.startswith("**"):
            continue
        if line.startswith("*"):
            keyword = line.partition(",")[0]
            if keyword == "*STEP":
                steps.append({})
        else:
            steps[-1].setdefault(keyword, []).append([cell.strip() for cell in line.split(",")])
    return steps


def rod_grid(cells: int, across: float = 0.0) -> tuple[np.ndarray, float]:
    """Points [mm] of a uniform strip of 100 mm from the start, and the mass of each [t]."""
    x = (np.arange(cells) + 0.5) / cells * 100
    return np.column_stack([x, np.full(cells, across), np.zeros(cells)]), 2e-3 / cells


def body_force(line: list[str], points: np.ndarray) -> np.ndarray:
    """Force per unit mass [mm/s²] at points, as the manuals define the loads of elements."""
    kind, size, *rest = line[1], *(float(cell) for cell in line[2:])
    if kind == "GRAV":
        return np.broadcast_to(size * np.array(rest), points.shape)
    arm = points - rest[:3]
    axis = np.array(rest[3:])
    if kind == "CENTRIF":
        return size * (arm - (arm @ axis)[:, None] * axis)
    assert kind == "ROTA"
    return -size * np.cross(axis, arm)


@pytest.mark.parametrize("length", [1e-3, 1.0])
def test_steps_of_abaqus_are_in_balance(length: float) -> None:
    """Forces of the text, and body forces on a fine uniform rod of the crank's mass, add up to nothing."""
    loads = lw.link_loads(four_bar(), "A", speed=30.0, acceleration=200.0)
    steps = read_back(step_text(loads, Model("abaqus", length)))
    assert len(steps) == len(loads.instants)
    points, mass = rod_grid(2000)
    points, mass = points * 1e-3 / length, mass * (1.0 if length == 1e-3 else 1e3)
    places = {name: np.array([*load.place[0], 0]) / length for name, load in loads.loads.items()}
    sets = {"N_O": places["O"], "N_A": places["A"], "N_A_DRIVE": places["A drive"]}
    for step in steps:
        force, moment, scale = np.zeros(3), 0.0, 0.0
        for name, dof, value in step["*CLOAD"]:
            if int(dof) == 6:
                moment += float(value)
                continue
            own = np.zeros(3)
            own[int(dof) - 1] = float(value)
            force += own
            moment += np.cross(sets[name], own)[2]
            scale = max(scale, abs(float(value)))
        for line in step["*DLOAD"]:
            own = mass * body_force(line, points)
            force += own.sum(axis=0)
            moment += np.cross(points, own)[:, 2].sum()
        assert np.abs(force).max() < 1e-9 * scale
        # The grid has J up to 1/n².
        assert abs(moment) < 1e-6 * scale * 0.1 / length


def test_steps_of_calculix_with_a_mesh(tmp_path: Path) -> None:
    """GRAV of each element by its centre: with CENTRIF, the acceleration field at all centres."""
    rows = [
        f"{n + 1}, {x}, {y}, 0."
        for n, (x, y) in enumerate((x, y) for x in range(0, 101, 10) for y in (-5, 5))
    ]
    elements = [f"{k}, {2 * k - 1}, {2 * k + 1}, {2 * k + 2}, {2 * k}" for k in range(1, 11)]
    path = tmp_path / "mesh.inp"
    path.write_text("\n".join(["*NODE, NSET=ALL", *rows, "*ELEMENT, TYPE=CPS4, ELSET=E", *elements]) + "\n")
    loads = lw.link_loads(four_bar(), "A", speed=30.0, acceleration=200.0)
    mesh = read_mesh(path)
    for step, instant in zip(
        read_back(step_text(loads, Model("calculix", mesh=mesh))), loads.instants, strict=True
    ):
        i = instant.place
        assert [line[0] for line in step["*DLOAD"]] == [*map(str, range(1, 11)), "EALL"]
        for line in step["*DLOAD"][:-1]:
            x = 10 * int(line[0]) - 5
            point = np.array([[x, 0.0, 0.0]])
            force = body_force(line, point) + body_force(step["*DLOAD"][-1], point)
            b = (loads.gravity[i] - loads.origin_acceleration[i]) * 1e3
            expected = [b[0] + 30.0**2 * x, b[1] - 200.0 * x, 0]
            assert force[0] == pytest.approx(expected, rel=1e-9, abs=1e-6)
        assert ["N_A_DRIVE_ROT", "3"] in [line[:2] for line in step["*CLOAD"]]


def test_elements_of_higher_order_count_by_their_corners(tmp_path: Path) -> None:
    """A tetrahedron of ten nodes over two lines, a quadrilateral of eight nodes."""
    path = tmp_path / "mesh.inp"
    corners = [(0, 0), (4, 0), (0, 4), (0, 0)]
    nodes = [f"{n}, {x}, {y}, 0" for n, (x, y) in enumerate(corners, start=1)]
    nodes += [f"{n}, 99, 99, 0" for n in range(5, 11)]
    path.write_text(
        "*Node\n" + "\n".join(nodes) + "\n*Element, type=C3D10\n7, 1, 2, 3, 4, 5, 6, 7,\n 8, 9, 10\n"
    )
    assert read_mesh(path).centres == {7: (1.0, 1.0)}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("*NODE\n1, 0, 0\n", r"no \*ELEMENT"),
        ("*ELEMENT\n1, 2, 3, 4\n", "no node 2"),
        ("*NODE\n1, x\n", r"inp:2"),
    ],
)
def test_a_wrong_mesh_is_refused(text: str, words: str, tmp_path: Path) -> None:
    """With file, line and what is missing."""
    (tmp_path / "mesh.inp").write_text(text)
    with pytest.raises(InputError, match=words):
        read_mesh(tmp_path / "mesh.inp")


def test_nodes_share_a_force_and_take_no_moment() -> None:
    """A set of four nodes has a quarter of the force each; a moment needs a reference node."""
    loads = lw.link_loads(four_bar(), "R.coupler")
    one, four = (read_back(step_text(loads, Model("abaqus", sets={"A": NodeSet("PIN", n)}))) for n in (1, 4))
    for a, b in zip(one, four, strict=True):
        pairs = [(x, y) for x, y in zip(a["*CLOAD"], b["*CLOAD"], strict=True) if x[0] == "PIN"]
        assert pairs
        assert all(float(y[2]) == pytest.approx(float(x[2]) / 4, rel=1e-11) for x, y in pairs)
    with pytest.raises(InputError, match=r"A drive has a moment of .* which 4 nodes cannot take"):
        step_text(lw.link_loads(four_bar(), "A"), Model("abaqus", sets={"A drive": NodeSet("HUB", 4)}))


# -- the command ---------------------------------------------------------------------------------------------


@pytest.fixture
def path(tmp_path: Path) -> Path:
    (tmp_path / "machine.toml").write_text(CRANK_ROCKER)
    return tmp_path / "machine.toml"


def test_csv_has_the_curves(path: Path, tmp_path: Path) -> None:
    """One file for each link, whose columns are the forces of the analysis."""
    out = tmp_path / "out"
    assert invoke("loads", str(path), "--out", str(out)).exit_code == 0
    for link in ("A", "R.coupler", "R.rocker"):
        head, *rows = (out / f"{link}.csv").read_text(encoding="utf-8").splitlines()
        table = dict(zip(head.split(","), np.array([row.split(",") for row in rows], float).T, strict=True))
        loads: LinkLoads = lw.link_loads(four_bar(), link)
        for name, load in loads.loads.items():
            assert table[f"{name}: F_y [N]"] == pytest.approx(load.force[:, 1], abs=1e-9)
    assert not list(out.glob("*.inp"))


def test_steps_are_written_for_the_solver(path: Path, tmp_path: Path) -> None:
    """One file for each link; CalculiX says what it leaves out."""
    words = ["--solver", "calculix", "--nodes", "R: PIN_R, 8", "--out", str(tmp_path / "out")]
    done = invoke("loads", str(path), *words)
    assert done.exit_code == 0
    assert "leave out its angular acceleration" in " ".join(done.stdout.split())
    assert re.search("^PIN_R, 1, ", (tmp_path / "out" / "R.coupler.inp").read_text(), re.MULTILINE)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--link", "nobody"], '--link: found "nobody"'),
        (["--solver", "abaqus"], "--solver: found without --out"),
        (["--elements", "E"], "--elements: it belongs to --solver"),
        (["--solver", "abaqus", "--nodes", "A", "--out", "{out}"], '--nodes: found "A"'),
        (["--solver", "abaqus", "--nodes", "X: PIN", "--out", "{out}"], '--nodes: found "X"'),
        (["--solver", "abaqus", "--mesh", "m.inp", "--out", "{out}"], "--mesh: it belongs to"),
        (["--solver", "calculix", "--link", "A", "--mesh", "m.inp", "--out", "{out}"], "no such file"),
        (["--acceleration", "3 rad/s^2"], "--acceleration: it belongs to --speed"),
    ],
)
def test_wrong_options_are_refused(words: list[str], said: str, path: Path, tmp_path: Path) -> None:
    """With exit code 2 and the option."""
    done = invoke("loads", str(path), *(word.replace("{out}", str(tmp_path / "out")) for word in words))
    assert done.exit_code == 2
    assert said in done.stderr

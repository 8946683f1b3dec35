"""Cases of studies and options: study files, measured records and command lines with mistakes."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import chdir
from pathlib import Path

from commands import call
from mutations import MACHINE_FILE, TABLE, VALUES, mutated
from numpy.random import Generator
from texts import folder, machine_files, some_file

# Tables of studies, small enough that a mistake costs little.
RANGES = """machine = "machine.toml"
[variables.phase]
address = "mechanism.cranks.A2.phase"
range = ["45 deg", "135 deg"]
steps = 3
[variables.mass]
address = ["bodies.cart1.mass", "bodies.cart2.mass"]
range = ["900 kg", "1100 kg"]
steps = 2
scale = "log"
[variables.type]
address = "drive.motor"
values = [{ kind = "induction", catalogue = "4A160S6U3" }, { kind = "induction", catalogue = "4A180M6U3" }]
"""

SCATTER = """machine = "machine.toml"
[variables.rod]
address = "mechanism.sliders.cart1.rod"
tolerance = "± 0.6 mm"
cost = 8.0
[variables.radius]
address = "mechanism.cranks.A1.radius"
tolerance = "H7"
cost = 2.0
[variables.force]
address = "loads.rolling1.force"
distribution = { kind = "normal", mean = "3562 N", deviation = "10 N" }
"""

ASKED = """[derived]
total = "2*{name}"
other = { formula = "0.8 + 0*{name}", address = "mechanism.sliders.cart2.rod" }
[responses]
delta = "steady_state.unevenness"
H = "steady_state.dynamism"
k_p = { formula = "delta^2 + H" }
peak = { curve = "steady_state.speed", extreme = "max" }
place = { curve = "motion.cart1.x", at = "30 deg" }
[constraints]
delta = { max = 0.2 }
"""

SWEEP = """[sweep]
method = "latin_hypercube"
rows = 4
seed = 1
"""

GOAL = """[goals]
H = "minimise"
"""

TWO_GOALS = """[goals]
H = "minimise"
place = "maximise"
"""

# What a study is asked, with few rows, and the tables that this needs.
STUDY_COMMANDS: tuple[tuple[str, tuple[str, ...]], ...] = (
    (RANGES + ASKED.replace("{name}", "mass") + SWEEP, ("sweep", "--out", "rows")),
    (SCATTER + ASKED.replace("{name}", "rod"), ("tolerance", "--rows", "8")),
    (SCATTER + ASKED.replace("{name}", "rod"), ("tolerance", "--rows", "8", "--indices", "2", "--json")),
    (SCATTER + ASKED.replace("{name}", "rod"), ("tolerance", "--rows", "100", "--allocate", "0.9")),
    (
        RANGES + ASKED.replace("{name}", "mass") + GOAL,
        ("optimise", "--evaluations", "12", "--method", "global"),
    ),
    (
        RANGES.split("[variables.type]")[0] + ASKED.replace("{name}", "mass") + TWO_GOALS,
        ("optimise", "--evaluations", "10", "--method", "global", "--points", "3", "--json"),
    ),
)

FIT = """machine = "machine.toml"
[variables.flywheel]
address = "drive.flywheel.inertia"
range = ["20 kg m^2", "500 kg m^2"]
[variables.guide]
address = "loads.guide.force"
[fit]
record = "run_down.csv"
motion = "coast"
angle_start = "40 deg"
"""


def study(random: Generator) -> None:
    """A study with mistakes: every command of studies answers, or says what is wrong."""
    base, (word, *options) = STUDY_COMMANDS[random.integers(len(STUDY_COMMANDS))]
    text = mutated(base, random, MACHINE_FILE, most=1 + int(random.integers(2)))
    with folder() as here:
        (here / "machine.toml").write_text(
            machine_files()["machines/roller_two_carts.toml"], encoding="utf-8"
        )
        (here / "study.toml").write_text(text, encoding="utf-8", newline="")
        options = [str(here / option) if option == "rows" else option for option in options]
        call([word, str(here / "study.toml"), *options], {"study.toml": text})
        if word == "sweep" and (here / "rows").exists():
            call(["sweep", "show", str(here / "rows"), "--out", str(here / "shown")], {"study.toml": text})


def record(random: Generator) -> None:
    """A fit whose record or study has mistakes: it answers, or says what is wrong."""
    rows = (_example("fit_from_run_down") / "run_down.csv").read_text(encoding="utf-8").split("\n")
    # Every tenth of the samples tells as much of a mistake.
    csv, text = "\n".join(rows[:1] + rows[1::10]), FIT
    if random.random() < 0.7:
        csv = mutated(csv, random, TABLE)
    else:
        text = mutated(text, random, MACHINE_FILE)
    machine = machine_files()[str(Path("examples/fit_from_run_down/machine.toml"))]
    with folder() as here:
        (here / "machine.toml").write_text(machine, encoding="utf-8")
        (here / "study.toml").write_text(text, encoding="utf-8", newline="")
        (here / "run_down.csv").write_text(csv, encoding="utf-8", newline="")
        call(["fit", str(here / "study.toml")], {"study.toml": text, "run_down.csv": csv})


def _example(name: str) -> Path:
    return Path(__file__).parents[2] / "examples" / name


# Words that are nearly right for options, by what the option wants.
_ANGLES = ("30 deg", "-400 deg", "1e6 rad", "0", "30", "nan deg", "90 rpm")
_SPEEDS = ("90 rpm", "-90 rpm", "0 rpm", "1e9 rpm", "90", "1 m/s")
_TIMES = ("0.1 s", "0 s", "-1 s", "1e9 s", "1 ms", "0.1")
_COUNTS = ("1", "0", "-3", "7", "1e3", "99999999999999999999", "2.5")
_SHARES = ("0.5", "0", "1", "-1", "1e-9", "inf", "nan", "50 %")
_UNITS = ("mm, rpm, kN", "mm mm", "kg/s", ",", "mm,mm", "parsec", "deg, t, kW", "m" * 500)
_ZEROS = ("outer", "inner", "top", "bottom", "cart1 outer", "ram top", "C top", "x", "")
_FILES = ("x.svg", "x.png", "x.dxf", "x.csv", "x.json", "x.toml", "x.exe", ".svg", "folder", "x.SVG", "x.")
_NAMES = (
    *(
        "steady_state.unevenness",
        "steady_state.speed",
        "steady_state",
        "free_vibration",
        "run_up.time",
        "motion",
    ),
    *(
        "drive.motor",
        "drive.gearbox.ratio",
        "mechanism",
        "bodies",
        "time",
        "cart1.place",
        "reduction.inertia",
    ),
)
_VARIED = (
    *(
        "drive.gearbox.ratio=1:20",
        "drive.gearbox.ratio",
        "drive.flywheel.inertia=0:1",
        "a=b",
        "=",
        "name=1:2",
    ),
    *("drive.gearbox.ratio=5:1", "bodies.ram.mass=1 kg:900 kg", "bodies.ram.mass=inf:nan"),
)
_LAWS = (
    "2*pi*t",
    "t",
    "1/t",
    "exp(t^9)",
    "where(t>0.5,1,0)",
    "t +",
    "x",
    "run_down.csv",
    "none.csv",
    "nan*t",
)

# Options by command.
OPTIONS: dict[str, dict[str, Sequence[str]]] = {
    "motion": {
        "--at": _ANGLES,
        "--speed": _SPEEDS,
        "--law": _LAWS,
        "--duration": _TIMES,
        "--zero": _ZEROS,
        "--steps": _COUNTS,
        "--units": _UNITS,
        "--out": _FILES,
    },
    "transient": {
        "--from-angle": _ANGLES,
        "--from-speed": _SPEEDS,
        "--duration": _TIMES,
        "--zero": _ZEROS,
        "--revolutions": _SHARES,
        "--accuracy": _SHARES,
        "--steps": _COUNTS,
        "--units": _UNITS,
        "--out": _FILES,
    },
    "plot": {"--over": _NAMES, "--zero": _ZEROS, "--out": _FILES, "--units": _UNITS},
    "draw": {"--out": _FILES, "--at": _ANGLES, "--seconds": _TIMES},
    "forces": {"--speed": _SPEEDS, "--units": _UNITS, "--out": _FILES},
    "size": {
        "--power-reserve": _SHARES,
        "--unevenness": _SHARES,
        "--by": ("power", "all", "x"),
        "--inertia": ("4A132S6U3=0.04", "x=1", "="),
        "--units": _UNITS,
        "--out": _FILES,
    },
    "sensitivity": {"--of": _NAMES, "--by": _NAMES, "--units": _UNITS, "--out": _FILES},
    "torsion": {"--holzer": _SHARES, "--units": _UNITS, "--out": _FILES},
    "cam": {"--units": _UNITS, "--out": _FILES},
    "run": {"--accuracy": _SHARES, "--step": _ANGLES, "--units": _UNITS, "--out": _FILES},
    "fit": {
        "--record": ("run_down.csv", "roots.csv"),
        "--vary": _VARIED,
        "--level": _SHARES,
        "--motion": ("run_up", "coast", "steady_state", "manoeuvre"),
        "--units": _UNITS,
    },
}


def options(random: Generator) -> None:
    """A command of a sound machine with options that somebody might have given by mistake."""
    text = some_file(random)
    word = list(OPTIONS)[random.integers(len(OPTIONS))]
    with folder() as here:
        path = here / "machine.toml"
        path.write_text(text, encoding="utf-8")
        arguments = [word, str(path)]
        if word == "plot" and random.random() < 0.9:
            arguments.append(_NAMES[random.integers(len(_NAMES))])
        if word == "fit":
            arguments += ["--record", str(here / "run_down.csv"), "--vary", _VARIED[random.integers(3)]]
        for _ in range(random.integers(1, 4)):
            option = list(OPTIONS[word])[random.integers(len(OPTIONS[word]))]
            words = OPTIONS[word][option] if random.random() < 0.9 else [value.strip('"') for value in VALUES]
            given = words[random.integers(len(words))]
            # Files are written below the folder of the case alone.
            if option == "--out" or given.endswith(".csv"):
                given = str(here / given.replace("/", "_").replace("\0", "")[:300])
            arguments += [option, given]
        # Where no place is given, pictures and reports go into the present folder.
        with chdir(here):
            call(arguments, {"machine.toml": text, "arguments": repr(arguments)})

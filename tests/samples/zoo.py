"""Machines with one of each element, with masses and loads everywhere, for laws that hold for all of them."""

from __future__ import annotations

import linkwright as lw

_CRANK = """
[mechanism.cranks.A]
radius = 0.1
phase = 0.3
[bodies]
A = { mass = 2, inertia = 0.02, along = 0.03, across = 0.01 }
"""

ZOO: dict[str, str] = {
    "slider-crank with offset": _CRANK
    + """
S = { mass = 3 }
"S.rod" = { mass = 1.5, inertia = 0.02, along = 0.12, across = 0.02 }
[mechanism.sliders.S]
crank = "A"
rod = 0.35
offset = 0.05
angle = "20 deg"
[loads]
gravity = { kind = "gravity" }
dry = { kind = "dry", on = "S", force = 50 }
work = { kind = "force_position", on = "S", position = [0, 0.5], forward = [10, 90], return = [5, 5] }
viscous = { kind = "viscous", on = "S", damping = 12 }
shaft = { kind = "torque_angle", angle = [0, 2, 4], torque = [1, 3, 2] }
gas = { kind = "force_angle", on = "S", angle = [0, 2, 4], force = [30, -50, 10] }
fan = { kind = "torque_speed", speed = [0, 10], torque = [0.5, 2] }
""",
    "four-bar with coupler point": _CRANK
    + """
"R.coupler" = { mass = 1, inertia = 0.01, along = 0.1, across = 0.05 }
"R.rocker" = { mass_per_length = 6 }
K = { mass = 0.7 }
[mechanism.points]
D = { x = 0.4, y = 0.05 }
F = { x = 0.2, y = 0.5 }
[mechanism.rockers.R]
crank = "A"
pivot = "D"
coupler = 0.35
rocker = 0.25
[mechanism.rigid_points.K]
link = "R.coupler"
along = 0.2
across = 0.1
[loads]
gravity = { kind = "gravity" }
pull = { kind = "force", on = "K", force = 40, direction = "75 deg" }
spring = { kind = "spring", between = ["F", "K"], stiffness = 300, free_length = 0.2 }
brake = { kind = "dry", on = "R.rocker", torque = 2 }
air = { kind = "viscous", on = "K", damping = 3 }
oil = { kind = "viscous", on = "R.coupler", damping_torsional = 0.4 }
rub = { kind = "dry", on = "K", force = 7 }
motor = { kind = "torque", on = "R.rocker", torque = 3 }
pump = { kind = "torque_swing", on = "R.rocker", angle = [0, 2, 4], forward = [2, 6, 3], return = [1, 1, 2] }
""",
    "cylinders that drive and push": """
[mechanism.points]
T = { y = 0.35 }
F = { x = 1.9 }
G = { x = 2.3, y = -0.05 }
[mechanism.cylinders.Z]
start = "T"
end = "P"
start_length = 1.75
law = "0.1*(1 - cos(phi)) + 0.01*sin(2*phi)"
bore = 0.09
rod = 0.06
friction = 300
[mechanism.cylinders.Y]
start = "G"
end = "P"
bore = 0.05
pressure = 2e5
pressure_rod = 1e5
damping = 40
friction = 20
[mechanism.cylinders.X]
start = "F"
end = "Q"
stiffness = 900
free_length = 0.5
[mechanism.joints]
P = { x = 1.75, y = 0.45 }
Q = { x = 2.45, y = 0.35 }
[mechanism.bars]
lever = { start = "F", end = "P", length = 0.48 }
link = { start = "P", end = "Q", length = 0.55 }
bucket = { start = "G", end = "Q", length = 0.42 }
[bodies]
Z = { mass = 30, inertia = 4, along = 0.5, across = 0.01 }
"Z.rod" = { mass = 12, inertia = 1, along = 0.4, across = -0.01 }
lever = { mass = 8, inertia = 0.3 }
bucket = { mass = 120, inertia = 3, along = 0.3, across = -0.2 }
Y = { mass = 3, inertia = 0.1, along = 0.2 }
"Y.rod" = { mass = 2 }
[loads]
gravity = { kind = "gravity" }
""",
    "two cranks, one pin with two rods": _CRANK
    + """
B = { mass = 1, inertia = 0.01, along = 0.02, across = 0 }
S = { mass = 3 }
T = { mass = 2 }
U = { mass = 1 }
"S.rod" = { mass = 1 }
"U.rod" = { mass = 1 }
[mechanism.cranks.B]
radius = 0.08
phase = 2
pivot = "P"
[mechanism.points]
P = { x = 0.1, y = 0.4 }
[mechanism.sliders]
S = { crank = "A", rod = 0.4 }
T = { crank = "A", rod = 0.3, angle = "90 deg" }
U = { crank = "B", rod = 0.3 }
[loads]
gravity = { kind = "gravity" }
dry = { kind = "dry", on = "T", force = 50 }
""",
    "slotted lever moving a slider": _CRANK
    + """
L = { mass = 2, inertia = 0.1, along = 0.3, across = 0.02 }
S = { mass = 4 }
"S.rod" = { mass = 1 }
[mechanism.points]
D = { x = 0, y = -0.3 }
[mechanism.slotted_levers.L]
pin = "A"
pivot = "D"
offset = 0.03
length = 0.6
[mechanism.rigid_points.E]
link = "L"
along = 0.6
[mechanism.sliders.S]
crank = "E"
rod = 0.3
offset = 0.3
[loads]
gravity = { kind = "gravity" }
dry = { kind = "dry", on = "S", force = 50 }
""",
    "yoke": _CRANK
    + """
Y = { mass = 2, inertia = 0.01, along = 0, across = 0 }
[mechanism.yokes.Y]
pin = "A"
guide = { angle = "10 deg", offset = 0.02 }
slot = "80 deg"
[loads]
gravity = { kind = "gravity" }
dry = { kind = "dry", on = "Y", force = 50 }
""",
    "crossing of a fixed guide and a guide on a coupler": _CRANK
    + """
X = { mass = 2 }
"R.coupler" = { mass = 1 }
"R.rocker" = { mass = 1 }
[mechanism.points]
D = { x = 0.4, y = 0.05 }
[mechanism.rockers.R]
crank = "A"
pivot = "D"
coupler = 0.35
rocker = 0.25
[mechanism.crossings.X]
first = { angle = "90 deg", offset = -0.2 }
second = { on = "R.coupler", offset = 0.02 }
[loads]
gravity = { kind = "gravity" }
push = { kind = "force", on = "X", force = 30, direction = "90 deg" }
""",
    "slider on a moving link": _CRANK
    + """
S = { mass = 2 }
B = { mass = 1, inertia = 0.01, along = 0, across = 0 }
"R.coupler" = { mass = 1 }
"R.rocker" = { mass = 1 }
"S.rod" = { mass = 1 }
[mechanism.points]
D = { x = 0.4, y = 0.05 }
P = { x = 0.4, y = 0.4 }
[mechanism.cranks.B]
radius = 0.05
pivot = "P"
[mechanism.rockers.R]
crank = "A"
pivot = "D"
coupler = 0.35
rocker = 0.25
[mechanism.sliders.S]
crank = "B"
rod = 0.5
on = "R.rocker"
offset = 0.05
angle = "15 deg"
[loads]
gravity = { kind = "gravity" }
dry = { kind = "dry", on = "S", force = 20 }
viscous = { kind = "viscous", on = "S", damping = 20 }
""",
    "linear driver with a guide on a carriage": """
[mechanism.linear_drivers.D]
per_turn = 0.3
guide = { angle = "10 deg" }
[mechanism.cranks.A]
radius = 0.1
[mechanism.crossings.X]
first = { through = "D", angle = "80 deg" }
second = { angle = "170 deg", offset = -0.3 }
[mechanism.yokes.Y]
pin = "A"
guide = { through = "D", angle = "45 deg" }
slot = "80 deg"
[bodies]
D = { mass = 3 }
X = { mass = 2 }
A = { mass = 2 }
Y = { mass = 1, inertia = 0.1, along = 0.1, across = 0 }
[loads]
gravity = { kind = "gravity" }
dry = { kind = "dry", on = "D", force = 20 }
rub = { kind = "dry", on = "Y", force = 20 }
""",
    "gears and a rack": _CRANK
    + """
G = { mass = 3, inertia = 0.02, along = 0.01, across = 0.02 }
H = { inertia = 0.03 }
T = { mass = 5 }
V = { mass = 2 }
[mechanism.points]
P = { x = 0.3, y = 0 }
Q = { x = 0.3, y = 0.5 }
[mechanism.gears]
G = { pivot = "P", meshes = "A", size = 40, size_other = 20 }
H = { pivot = "Q", meshes = "G", size = 20, size_other = 40, kind = "belt" }
[mechanism.racks]
T = { gear = "G", radius = 0.1, guide = { angle = "30 deg", offset = -0.2 } }
V = { gear = "G", radius = 0.1, side = "left", guide = { angle = "100 deg" } }
[loads]
gravity = { kind = "gravity" }
dry = { kind = "dry", on = "T", force = 20 }
load = { kind = "torque", on = "H", torque = 3 }
""",
    "planetary train with a crank on the planet": _CRANK
    + """
G = { mass = 3, inertia = 0.02, along = 0.01, across = 0.02 }
W = { inertia = 0.05 }
S = { mass = 4 }
"S.rod" = { mass = 1 }
[mechanism.gears.G]
pivot = "A"
carrier = "A"
kind = "internal"
size = 20
size_other = 60
[mechanism.gears.W]
pivot = "O"
carrier = "A"
meshes = "G"
size = 20
size_other = 20
[mechanism.rigid_points.E]
link = "G"
along = 0.03
[mechanism.sliders.S]
crank = "E"
rod = 0.4
[loads]
gravity = { kind = "gravity" }
dry = { kind = "dry", on = "S", force = 20 }
load = { kind = "torque", on = "W", torque = -2 }
""",
    "sun and planet": """
[mechanism.points]
D = { x = 0.7, y = 0.1 }
[mechanism.cranks.A]
radius = 0.1
[mechanism.rockers.R]
crank = "A"
pivot = "D"
coupler = 0.6
rocker = 0.3
[mechanism.gears.G]
pivot = "O"
carrier = "A"
meshes = "R.coupler"
size = 20
size_other = 20
[bodies]
A = { mass = 1 }
G = { inertia = 0.02 }
"R.coupler" = { mass = 1 }
"R.rocker" = { mass = 1 }
[loads]
load = { kind = "torque", on = "G", torque = -2 }
""",
    "cable on an arc": _CRANK
    + """
"R.coupler" = { mass = 1 }
"R.rocker" = { mass = 1 }
H = { mass = 30 }
[mechanism.points]
D = { x = 0.4, y = 0.05 }
[mechanism.rockers.R]
crank = "A"
pivot = "D"
coupler = 0.35
rocker = 0.25
[mechanism.cables.H]
link = "R.rocker"
radius = 0.2
length = 0.5
reference = "90 deg"
side = "left"
[loads]
gravity = { kind = "gravity" }
dry = { kind = "dry", on = "H", force = 20 }
""",
    "bars, one of them redundant": """
[mechanism.points]
D = { x = 0.4, y = 0 }
[mechanism.cranks.A]
radius = 0.1
[mechanism.joints]
J = { x = 0.3, y = 0.25 }
[mechanism.bars]
AJ = { start = "A", end = "J", length = 0.35 }
JD = { start = "J", end = "D", length = 0.25 }
N = { start = "O", end = "A", length = 0.1, redundant = true }
[bodies]
AJ = { mass = 2 }
JD = { mass = 1 }
N = { mass = 1 }
A = { mass = 1 }
J = { mass = 1 }
[loads]
gravity = { kind = "gravity" }
load = { kind = "torque", on = "JD", torque = -2 }
""",
    "a triad of joints and bars": """
[mechanism.points]
D = { x = 0.5, y = -0.1 }
E = { x = 0.8, y = -0.1 }
[mechanism.cranks.A]
radius = 0.05
[mechanism.joints]
J = { x = 0.35, y = 0.25 }
K = { x = 0.5, y = 0.15 }
L = { x = 0.82, y = 0.16 }
[mechanism.bars]
AJ = { start = "A", end = "J", length = 0.391 }
JK = { start = "J", end = "K", length = 0.18 }
KL = { start = "K", end = "L", length = 0.32 }
LJ = { start = "J", end = "L", length = 0.479 }
DK = { start = "K", end = "D", length = 0.25 }
EL = { start = "E", end = "L", length = 0.26 }
[mechanism.rigid_points.M]
link = "KL"
along = 0.1
across = 0.05
[bodies]
AJ = { mass = 1 }
JK = { mass = 2 }
DK = { mass = 1 }
KL = { mass = 1 }
J = { mass = 1 }
M = { mass = 2 }
[loads]
gravity = { kind = "gravity" }
pull = { kind = "force", on = "M", force = 40, direction = "75 deg" }
""",
    "cam in a groove that moves a rod": """
[mechanism.cams.C]
closure = "groove"
roller_radius = 0.02
base_radius = 0.15
offset = 0.03
direction = "70 deg"
phase = "25 deg"
rotation = "opposite"
sections = [
  { angle = "140 deg", lift = 0.06, law = "modified_sine" },
  { angle = "40 deg" },
  { angle = "180 deg", lift = -0.06, law = { kind = "combined", start = 0.3, stop = 0.2 } },
]
[mechanism.sliders.S]
crank = "C"
rod = 0.3
through = "C"
[bodies]
C = { mass = 2 }
"S.rod" = { mass_per_length = 3 }
S = { mass = 1 }
[loads]
gravity = { kind = "gravity" }
dry = { kind = "dry", on = "C", force = 30 }
spring = { kind = "spring", between = ["O", "S"], stiffness = 300, free_length = 0.2 }
""",
    "cams with an arm under a flat face and a second roller": """
[mechanism.points]
P = { x = 0.3, y = 0.05 }
Q = { x = -0.28, y = -0.02 }
[mechanism.cams.F]
follower = "oscillating"
contact = "flat"
arm_pivot = "P"
base_radius = 0.12
offset = 0.01
sections = [
  { angle = "140 deg", swing = "25 deg", law = "modified_sine" },
  { angle = "40 deg" },
  { angle = "180 deg", swing = "-25 deg", law = { kind = "combined", start = 0.3, stop = 0.2 } },
]
[mechanism.cams.R]
follower = "oscillating"
closure = "conjugate"
arm_pivot = "Q"
arm_length = 0.2
side = "right"
roller_radius = 0.02
base_radius = 0.12
second = { angle = "110 deg", roller_radius = 0.025 }
sections = [
  { angle = "140 deg", swing = "25 deg", law = "modified_sine" },
  { angle = "40 deg" },
  { angle = "180 deg", swing = "-25 deg", law = { kind = "combined", start = 0.3, stop = 0.2 } },
]
[bodies]
F = { mass = 2, inertia = 0.03, along = 0.1 }
R = { mass = 1, inertia = 0.01, along = 0.12, across = 0.02 }
[loads]
gravity = { kind = "gravity" }
torque = { kind = "torque", on = "F", torque = 5 }
oil = { kind = "viscous", on = "R", damping_torsional = 0.3 }
""",
    "every other load": _CRANK
    + """
"R.coupler" = { mass = 1, inertia = 0.01, along = 0.1, across = 0.05 }
"R.rocker" = { mass_per_length = 6 }
S = { mass = 2 }
[mechanism.points]
D = { x = 0.4, y = 0.05 }
F = { x = 0.2, y = 0.5 }
[mechanism.rockers.R]
crank = "A"
pivot = "D"
coupler = 0.35
rocker = 0.25
[mechanism.rigid_points.K]
link = "R.coupler"
along = 0.2
across = 0.1
[mechanism.sliders.S]
crank = "R"
rod = 0.6
[loads]
follows = { kind = "force", on = "K", force = 40, direction = "75 deg", along = "R.coupler" }
preloaded = { kind = "spring", between = ["F", "K"], stiffness = 300, free_length = 0.2, preload = 20 }
curve = { kind = "spring", between = ["A", "D"], length = [0.2, 0.4, 0.6], force = [-3, 5, 9] }
damper = { kind = "damper", between = ["A", "S"], damping = 30 }
valve = { kind = "damper", between = ["F", "K"], velocity = [-1, 0, 1], force = [-30, 0, 10] }
twist = { kind = "torsional_spring", on = "R.rocker", against = "R.coupler", stiffness = 4, free_angle = 0.5 }
oil = { kind = "torsional_damper", on = "R.rocker", against = "A", damping_torsional = 0.4 }
jet = { kind = "formula", on = "K", along = "R.coupler", force = "5*cos(psi) - psi_dot" }
fan = { kind = "formula", on = "A", torque = "-0.12*omega^2 - min(psi, 1, 2)*pow(2, 0.5) + atan2(1, 2)" }
[loads.gas]
kind = "gas_spring"
between = ["F", "R"]
force_extended = 100
length_extended = 0.8
length_compressed = 0.2
progression = 1.5
[loads.press]
kind = "formula"
on = "S"
force = "-120*max(0, sin(phi))^2 - k*max(0, s - s0) - 3*v - 2*v*abs(v)"
constants = { k = 20, s0 = 0.5 }
[loads.wind]
kind = "formula"
on = "K"
direction = 0.4
force = "-3*(vx - 1)*where(y < 0.2, 1, 2) + x/2 + step(v)"
""",
}


def animal(name: str, drive: str = "") -> lw.Machine:
    tables = ZOO[name].split("[bodies]")
    # Bodies stand where they read best; TOML wants their keys below one head.
    return lw.loads(f'format = 1\nname = "{name}"\n' + "[bodies]".join(tables) + drive)

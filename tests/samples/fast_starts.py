"""A crank that runs away from fast starts where its dry resistance is small."""

# From 19.5 rad/s the load drives with 1 N m on average, which a dry resistance of more takes up.
FILE = """format = 1
name = "Crank"
mechanism.cranks.A.radius = "1 m"
bodies.A = { on = "A", inertia = 0.3 }
[drive]
motor = { kind = "table", speed = [0, 36], torque = [30, 0], inertia = 0 }
gearbox = { ratio = 1, efficiency = 1 }
[loads.L]
kind = "formula"
on = "A"
torque = "-(15 + 7*cos(phi) - 16*where(omega > 19.5, 1, 0))"
[loads.D]
kind = "dry"
on = "A"
torque = 0.5
"""

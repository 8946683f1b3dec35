"""Tasks of a synthesis, for several tests."""

POSES = """
[poses]
x = "0, 40, 60 mm"
y = "0, 20, 60 mm"
angle = "0, 20, 50 deg"
[crank_point]
x = "-20 mm"
y = "-50 mm"
[rocker_point]
x = "60 mm"
y = "-40 mm"
"""

FUNCTION = """
name = "log"
function = "log10(x)"
range = [1, 2]
crank_range = "60 deg"
rocker_range = "90 deg"
points = 5
"""

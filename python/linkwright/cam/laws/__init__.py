"""Motion laws: how a follower moves from one place to another, as mathematics.

| module | holds |
| --- | --- |
| `boundary` | Velocities and accelerations at the ends of a section, and laws that meet them |
| `catalogue` | All laws by name, with their sources, and the theoretical bounds of their factors |
| `handbook` | Laws in closed form: parabola, harmonics, sine series, modified sine and trapezoid |
| `limited` | Trapezoidal velocity and S-curve by limits of velocity, acceleration and jerk |
| `motion_law` | A motion law: lift over angle, or over time, in pieces that are polynomials and harmonics |
| `optimal` | Laws with minimum mean square or minimum peak of a derivative |
| `piece` | One stretch of a law, polynomial and harmonics, and where it is zero |
| `polynomial` | Polynomials by conditions at their ends |
| `programme` | sections over one revolution, and how smoothly they meet |
| `ramps` | Ramps of the velocity, and laws that start, keep a velocity and stop |
| `spline` | Splines through points; a smooth function as polynomials, within a measured error |
"""

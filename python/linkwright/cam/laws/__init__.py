"""Motion laws: how a follower moves from one place to another, as mathematics.

| module | holds |
| --- | --- |
| `piece`, `motion_law` | a polynomial with harmonics; laws in pieces: values, derivatives, extremes, sums |
| `zeros` | all zeros of a smooth function |
| `linear_system` | exact linear equations for the unknowns of a law |
| `rest_to_rest` | a law from the course of its acceleration |
| `parabolic`, `harmonic`, `sine_series` | laws of one power, of cosines, of a few sines |
| `modified_sine`, `modified_trapezoid` | accelerations of sines and constants |
| `polynomial`, `optimal`, `least_peak` | by boundary conditions; of minimum integral; of minimum peak |
| `ramps`, `start_and_stop`, `limited` | ramps; start, constant velocity and braking; by limits |
| `spline` | through points |
| `catalogue`, `bounds` | all laws by name; theoretical lower bounds |
| `boundary`, `half_law`, `shapes` | what a section has to do, and how a law does it |
| `programme` | sections over one revolution, and how smoothly they meet |
| `polydyne` | the lift that moves an elastic follower by a law |
"""

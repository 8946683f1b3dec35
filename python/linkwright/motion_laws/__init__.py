"""Motion laws: how a follower moves from one place to another, as mathematics.

| module | what |
| --- | --- |
| `motion_law` | laws in pieces: values, derivatives, extremes, sums |
| `zeros` | all zeros of a smooth function |
"""

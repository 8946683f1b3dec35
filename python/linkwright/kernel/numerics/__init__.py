"""Numerics that no library has as it is needed here.

| module | |
| --- | --- |
| `confidence` | How far estimates may be from the truth |
| `differences` | Derivatives of what has no rules for them, by extrapolated differences |
| `extreme` | Extremes with derivatives: which rivals tie, whose derivatives differ, kinks that move |
| `formula_value` | The value of a formula: its tree worked through with numpy |
| `implicit` | Derivatives of what an equation is solved for |
| `least_squares` | Linear least squares with what it can tell; damped steps for many problems |
| `zeros` | Zeros and extremes of smooth functions of the crank angle, many at once, to rounding |
| `tangent` | Numbers and arrays that carry their derivatives by entries through arithmetic |
| `taylor` | Numbers that carry their first three derivatives by time, for functions written with numpy |
| `turn_curve` | Quantities over a revolution as Chebyshev series, piece by piece |
| `turn_fit` | Quantities over a revolution |
"""

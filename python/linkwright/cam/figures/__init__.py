"""Figures of cams.

| module | |
| --- | --- |
| `cam` | Lift diagrams, profile, pressure angle, curvature, contact force, motion laws, residual vibration |
| `captions` | The figures of cams with their captions |
"""

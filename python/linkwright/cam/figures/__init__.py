"""Figures of cams.

| module | |
| --- | --- |
| `cam` | Lift diagrams, profile, pressure angle, curvature, contact force |
| `captions` | The figures of cams with their captions |
| `dynamics` | Contact force, pressure and vibration of cams and followers |
"""

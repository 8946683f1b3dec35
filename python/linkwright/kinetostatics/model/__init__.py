"""Masses on links and points; loads.

| module | |
| --- | --- |
| `body` | Masses; forces and torques |
| `loads/` | Loads: forces and torques of the work, of friction, of weight, of springs |
"""

"""Masses on links and points; loads.

| module | |
| --- | --- |
| `body` | Masses; forces and torques |
| `cylinder_loads` | What a cylinder does to its points, as loads |
| `loads/` | Loads: forces and torques of the work, of friction, of weight, of springs |
| `plate` | A link cut from a plate, by its outline |
"""

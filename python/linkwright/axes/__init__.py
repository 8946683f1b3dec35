"""Servo axes: drivers with a law and a motor of their own.

| module | |
| --- | --- |
| `export/` | Laws as cam tables of motion controllers, read back and compared |
"""

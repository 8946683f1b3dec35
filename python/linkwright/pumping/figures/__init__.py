"""Figures of pumping units and rotators.

| module | |
| --- | --- |
| `captions` | The figures of pumping units and rotators with their captions |
| `unit` | Pumping units and rotators |
"""

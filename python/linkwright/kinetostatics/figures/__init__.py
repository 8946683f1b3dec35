"""Figures of forces.

| module | |
| --- | --- |
| `captions` | The figures of forces with their captions |
| `forces` | Forces over the crank angle: sizes, hodographs, polar diagrams, and load cases in one picture |
"""

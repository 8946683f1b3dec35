"""Figures of linkages.

| module | |
| --- | --- |
| `captions` | The figures of a linkage: transmission angles, and coupler curves drawn with the links |
| `linkage` | Transmission angles, coupler curves with the links |
"""

"""Cams: motion laws, profiles, followers in motion, manufacture.

| module | |
| --- | --- |
| `analyses` | Its analyses, as study, report, studio, studies and derivatives read them |
| `commands/` | ``linkwright cam`` |
| `core` | The core's cam: one contact of a follower with a cam, its law and its dimensions |
| `dynamics/` | What presses on a cam, and how its follower really moves |
| `figures/` | Figures of cams |
| `gradient` | Derivatives of motion and geometry of a cam by its sizes, sections and laws |
| `law_factors` | How hard a motion law is on the follower: factors of a law of rest to rest |
| `laws/` | Motion laws: how a follower moves from one place to another, as mathematics |
| `manufacture/` | Drawings and tables for manufacture |
| `model/` | Cams, their followers and motion programmes in a machine file |
| `profile/` | Which followers touch which cam, the curves that follow, and what is wrong with them |
| `scene` | Cams in the moving sketch: outlines that turn, rollers, edges and faces that they move |
| `search` | Thousands to millions of cams that differ in law, radii, offset or lift |
| `study` | What is known of all cams of a machine |
| `tables` | Tables of cams, of laws compared, and their theoretical bounds |
"""

from linkwright import exports

__getattr__ = exports(globals())

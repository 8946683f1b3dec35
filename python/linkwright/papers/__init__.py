"""Papers: published numbers against computed ones, cell by cell, with the reason where they differ.

| module | holds |
| --- | --- |
| `published` | the published values, read from ``paper1.toml`` and the like; the papers that there are |
| `cell` | one published value beside a computed one, and the verdict |
| `row` | one printed statement beside what comes out, in words |
| `page` | what the pages of all papers share |
| `paper1` | paper 1 computed anew: the four drives in three ways, and what follows |
| `paper1_scheme` | the published scheme of paper 1, with its factor 1/i |
| `paper1_limit` | the constant-energy limit of a drive, and the inertia that would fit a published row |
| `paper1_figures` | the figures of paper 1, computed anew |
| `paper1_conclusions`, `paper1_page` | what its numbers say; its page |
| `paper2` | paper 2 computed anew: the cam drive of a cart |
| `paper2_formulas`, `paper2_checks` | its closed forms, a second way; these against the general synthesis |
| `paper2_start` | which start section has the least ∫ jerk² |
| `paper2_roller`, `paper2_pair` | rollers on the printed profile; two cams that turn in opposite directions |
| `paper2_alternatives`, `paper2_table` | other laws and the crank drive; these as a table |
| `paper2_course` | the cart in steady motion |
| `paper2_rows` | every printed number and formula of paper 2 with its verdict |
| `paper2_conclusions`, `paper2_figures`, `paper2_page` | what its numbers say; its figures; its page |
| `paper3` | paper 3 computed anew: its formulas on a V-12 with articulated rods |
| `paper3_engine` | the V-12, and what another inertia or stiffness does to its frequencies |
| `paper3_inertia`, `paper3_swing`, `paper3_throw` | (1) to (12); (13) to (15); (16) and (17) |
| `paper3_uneven`, `paper3_weak` | unevenness along the shaft, rigid and not; which cylinder is weak |
| `paper3_rows`, `paper3_table` | every formula with its verdict; what it does to the frequencies as a table |
| `paper3_conclusions`, `paper3_figures`, `paper3_page` | what its numbers say; its figures; its page |
| `paper4` | paper 4 computed anew: the rotator in both regimes |
| `paper4_unit` | the pumping unit of paper 4, as far as its numbers leave it open |
| `paper4_rows` | every printed number of paper 4 with its verdict |
| `paper4_formulas` | the closed forms of paper 4, a second way beside the core |
| `paper4_conclusions`, `paper4_figures`, `paper4_page` | what its numbers say; its figures; its page |
| `paper5` | paper 5 computed anew: the length of a topper's knife |
| `paper5_head`, `paper5_step`, `paper5_short` | its head; from (4) to (5); how much its lengths fall short |
| `paper5_surface`, `paper5_verdict` | its figure 3; for which angles and heads its result holds |
| `paper5_rows`, `paper5_table` | every formula with its verdict; where its result holds, as tables |
| `paper5_conclusions`, `paper5_figures`, `paper5_page` | what its numbers say; its figures; its page |
"""

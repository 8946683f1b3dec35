"""Linkages: how points, links and slides of a mechanism move.

| module | |
| --- | --- |
| `analyses` | Its analyses, as study, report, studio, studies and derivatives read them |
| `centrodes` | About which point does a link turn, and what does that point trace on frame and link? |
| `circuits` | In which assembly modes does it close, and which form one circuit? |
| `closure` | At which crank angles does the mechanism close? |
| `warnings` | What the designer of a linkage should know although it moves |
| `commands` | `linkwright motion FILE`: poses at one crank angle, over one revolution or over time |
| `coupler_curve` | What path does a point draw? |
| `cycle` | What are its extreme positions, transmission angles, dead points, its Grashof class? |
| `dyads` | Dyads as the core has them, and the angle at which each passes on its force |
| `figures` | Figures of a linkage over its cycle, with their captions |
| `figures_of_motion` | A motion over time as tables and figures of a report |
| `gradient` | Derivatives of strokes, swings, time ratios and transmission angles by the entries |
| `grashof` | Four-bar loops of a mechanism and their class after Grashof |
| `idle_parts` | Parts that no driver moves although W = 1 |
| `kinematics` | How do points, links and slides move? |
| `law` | Laws of the driver: the crank angle over time with three derivatives |
| `law_jumps` | Jumps of velocity and acceleration in the laws of drivers, and what they move |
| `model/` | Elements of a mechanism, how they refer to each other, and in which order they are built |
| `motion` | Where is everything under a law of time? |
| `nearest_places` | Where on a curve are the places nearest to given points, in their order? |
| `obstacle` | Why an element does not close, in words, and what to change |
| `path_error` | How far does a point pass from given points of a path? |
| `period` | After how many revolutions of the crank a mechanism is again where it was |
| `pose` | Where is everything at one crank angle? |
| `scene` | Sketch of a mechanism: points, links, slides, gears, bodies, springs over the crank angle |
| `straight_portion` | The longest portion of a path that is straight: that hardly leaves its chord |
| `study` | Its part of the study of a machine |
| `sweep` | A linkage swept over its cycle: crank angles, curves, exact extremes |
| `tables` | A linkage as tables of text: travel, transmission angles, four-bar loops, dead points |
| `whole_cycle` | After how many revolutions do masses, loads and forces repeat? |
| `zero` | Crank angles counted from a dead centre |
"""

"""What a machine is: frozen descriptions in SI, checked, without any analysis.

| module | holds |
| --- | --- |
| `machine` | `Machine`: drive, mechanism, bodies, loads, run-up |
| `drive`, `drive_train` | gearbox, coupling, flywheel, brake; a drive line whose shafts twist, as a train |
| `motor` | the kinds of motor, and how their entries follow from one another |
| `catalogue` | published motors |
| `element` | cranks, dyads, gears, cables, joints and bars |
| `mechanism` | all elements by name |
| `cam`, `cam_follower`, `follower_train` | cams, their followers as drivers, and what vibrates behind them |
| `motion_section`, `motion_law`, `point_law` | sections of a cam's motion, and their laws |
| `follower_motion`, `section_faults` | the motion over a turn; what is wrong with sections |
| `assembly` | in which order a mechanism is built; what is missing or too much |
| `pumping_unit`, `polished_rod_load`, `rod_rotator` | beam pumping units, and the rotator of the rod string |
| `unit_catalogue` | published pumping units |
| `shaft_section`, `shaft_row` | sections of a shaft, and several in a row |
| `shaft_flexibility`, `shaft_step` | closed forms of cones and rings; what a step adds |
| `shaft_limit`, `propulsion_shaft`, `crankshaft_limit` | what shafts bear, given or by the rules of ships |
| `reciprocating/` | parts of reciprocating engines |
| `topper`, `topper_motion` | knives of root-crop toppers, and how they move |
| `topper_field`, `scatter`, `topper_limits` | roots of a field, lengths that scatter; limits of a knife |
| `train`, `train_speeds`, `train_faults` | torsional trains, speeds of their discs, faults |
| `train_transient`, `train_event` | manoeuvres of trains, what happens in them |
| `coupling`, `damper`, `train_torques`, `train_run` | couplings, dampers, torques on a train, its run |
| `whole_train` | engine, couplings and dampers written out as discs and shafts |
| `linkage` | the whole mechanism: elements of the file, and what cams and a pumping unit expand into |
| `body`, `loads` | masses; forces and torques |
| `formula` | formulas as texts |
| `curve` | curves given by points |
| `outline` | names in a mechanism: what refers to what, in which order it is built |
| `address`, `text` | entries by address |
| `base`, `plain` | what all descriptions share; reading checked and raw ones alike |
| `schema_walk`, `problems` | what belongs where; errors in the words of the file |
"""

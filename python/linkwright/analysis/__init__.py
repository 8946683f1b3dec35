"""Analyses: from a machine to a result, one question a module.

| module | answers |
| --- | --- |
| `closure` | at which crank angles does the mechanism close? |
| `linkage` | what are its extreme positions, transmission angles, dead points, its Grashof class? |
| `circuits` | in which assemblies can it be put together, and which hang together? |
| `coupler_curve` | what path does a point draw? |
| `pose` | where is everything at one crank angle? |
| `motion` | where is everything under a law of time? |
| `kinematics` | how do points, links and slides move? |
| `reduction` | what inertia and what load does the crank feel? |
| `constant_energy` | how unevenly would it turn without motor and load? |
| `steady_state` | how does it turn in the long run? |
| `transient` | how does it move from here on? |
| `run_up` | does it start, and how long does that take? |
| `run_down` | how long until it stands? |
| `step_method` | what does the published step method give instead? |
| `pumping_unit`, `gear_torque` | how does the polished rod move, and what does its gearbox carry? |
| `rod_rotator`, `lever` | how does the lever turn the rod string? |
| `topper` | how long must the knife of a topper be, and what does it leave? |
| `forces`, `kinetostatics` | what do its pairs bear, what must the drive give, what does the frame feel? |
| `envelope` | how large does each force become, and under which loads? |
| `harmonics` | of which harmonics does a force consist? |
| `balancing` | which counterweights make the force on the frame small? |
| `result` | scalars, curves and tables of a result |
"""

"""Forces: joint reactions, driving torque, shaking force and moment.

| module | |
| --- | --- |
| `analyses` | Its analyses, as study, report, studio, studies and derivatives read them |
| `applied` | What each load does |
| `balancing` | Which counterweights make the shaking force small? |
| `cam_contact` | The force with which a cam drives its follower |
| `collect` | From the unknowns to the result |
| `commands` | ``linkwright forces`` and ``linkwright balance`` |
| `cylinder` | Force, pressures, flow and power of a hydraulic cylinder |
| `cylinder_gradient` | Their derivatives by entries of the machine |
| `cylinder_report` | Tables and figures of cylinders |
| `envelope` | Peaks, root mean squares, means and harmonics of forces; load cases side by side |
| `contact` | Contacts that can be lost, and whether they are in steady motion |
| `contact_in_time` | Where does a motion in time lose the contact of a follower, the tension of a cable? |
| `couple` | Forces of inertia along the crankshaft: shaking couples |
| `equilibrium` | The linear system, its solution, and the iteration over friction |
| `figures` | Figures of forces over the crank angle, with their captions |
| `forces` | Which are its joint reactions, its driving torque, its shaking force? |
| `gradient` | Derivatives of the largest forces by entries of the machine |
| `friction` | Friction in pins, guides and slots, as given by the user |
| `model/` | Masses on links and points; loads |
| `motion` | Crank angle, speed, acceleration and time at which forces are asked for |
| `pairs` | What each pair can do: directions of its unknown forces, and its friction |
| `places` | Where members, points and guides are, and how they move |
| `result` | The forces by name |
| `shaking_orders` | Primary and secondary shaking forces and couples, and those of higher orders |
| `study` | Its part of the study of a machine |
| `tables` | Forces as tables of text |
| `words` | Assumptions of a report |
| `wrench` | Forces and couples on members |
"""

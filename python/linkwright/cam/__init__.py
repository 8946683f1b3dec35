"""Cam and follower: what presses on what, and how the follower really moves.

| module | answers |
| --- | --- |
| `contact` | which followers touch which cam, and the curves that follow from it |
| `profile` | what is known of a cam: lift, pressure angle, curvature over a turn, and their extremes |
| `opposite` | do two followers touch one cam at every angle? |
| `faults` | is it undercut, pointed, crossed, too hollow for its cutter, too steep? |
| `loaded` | what presses on the cam in its machine, how hard, and when contact is lost |
| `least_sizes` | the smallest base circle for its limits, and the largest roller |
| `least_base` | how small may the base circle be, how large the roller? |
| `hertz` | how hard do cam and roller press on each other, and how deep does it reach? |
| `contact_force` | what do cam and follower press on each other, which flank carries, what torque? |
| `bearing` | how do guide or pivot hold the follower, and what does their friction take? |
| `follower_load` | what acts on the follower along its way? |
| `backlash` | where does the force change its flank, and how hard does the follower land? |
| `lift_off` | at which speed does the follower leave the cam, and which preload holds it? |
| `one_mass` | what is the follower train, as one mass on one stiffness? |
| `follower_vibration` | how does the follower really move over a turn, and does it stay on the cam? |
| `residual_vibration` | what vibration does a rise leave, and at which speeds none? |
| `polydyne` | which lift moves an elastic follower by a wanted law? |
| `lift_steps` | which derivatives of a lift jump, and where? |
| `oscillator` | the answer of an oscillator to a law in pieces, exactly |
| `checks` | inputs that make no sense, told by name |
"""

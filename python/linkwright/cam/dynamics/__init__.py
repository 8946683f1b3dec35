"""What presses on a cam, and how its follower really moves.

| module | |
| --- | --- |
| `backlash` | Where does the force change its flank, and how hard does the follower land? |
| `bearing` | How do guide or pivot hold the follower, and what does their friction take? |
| `contact_force` | What do cam and follower press on each other, which flank carries, what torque? |
| `follower_load` | What acts on the follower along its way? |
| `follower_vibration` | How does the follower really move over one revolution, and does it stay on the cam? |
| `gradient` | Derivatives of normal force and contact pressure by entries of the machine |
| `hertz` | How hard do cam and roller press on each other, and how deep does it reach? |
| `lift_off` | At which speed does the follower leave the cam, and which preload holds it? |
| `loaded` | What presses on the cam in its machine, how hard, and when contact is lost |
| `one_mass` | What is the follower train, as one mass on one stiffness? |
| `oscillator` | The answer of an oscillator to a law in pieces, exactly |
| `polydyne` | Which lift moves an elastic follower by a wanted law? |
| `residual_vibration` | What vibration does a rise leave, and at which speeds none? |
"""

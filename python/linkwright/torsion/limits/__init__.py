"""Check of a train against its limits.

| module | |
| --- | --- |
| `barred_range` | Speeds that shafts do not bear indefinitely |
| `crank_fatigue` | Fatigue of crankshafts by IACS UR M53 |
| `criteria` | What is asked of the parts of a train, and where over the speed it is exceeded |
| `critical_response` | Synthesis at the critical speeds |
| `misfire` | The worst single misfire |
| `overlay` | A measured curve laid over the computed one |
| `survey` | A train at its speeds, resonances and peaks: limits and largest torques |
| `verdict` | Whether all limits are kept, and how a train may be operated |
"""

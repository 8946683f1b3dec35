"""Whether a train bears its vibration.

| module | |
| --- | --- |
| `barred_range` | Speeds that shafts do not bear indefinitely |
| `criteria` | What is asked of the parts of a train: found against permitted, at any speeds |
| `exceedance` | Where a curve over the speed lies above 1: ranges with their bounds and peaks, refined |
| `peak_judgement` | Whether shafts and couplings bear a manoeuvre |
| `verdict` | Whether all limits are kept |
"""

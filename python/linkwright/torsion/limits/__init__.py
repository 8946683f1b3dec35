"""Whether a train bears its vibration.

| module | |
| --- | --- |
| `barred_range` | Speeds that shafts do not bear for ever |
| `criteria` | What is asked, at which speeds, and where it is not kept |
| `exceedance` | What is asked, at which speeds, and where it is not kept |
| `peak_judgement` | Whether shafts and couplings bear a manoeuvre |
| `verdict` | Whether all limits are kept |
"""

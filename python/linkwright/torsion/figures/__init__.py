"""Figures of trains.

| module | |
| --- | --- |
| `campbell` | Campbell's diagram of a train |
| `captions` | The figures of a study of torsional vibration, with their captions |
| `damper` | Response of a train with the best damper |
| `forced` | Forced vibration of trains over their speeds |
| `modes` | Mode shapes of trains |
| `scheme` | Equivalent schemes of trains, by `scheme_layout`, `scheme_page`, `scheme_words` |
| `scheme_layout` | Where the parts of a train's scheme are drawn |
| `scheme_page` | How large the scheme of a train is drawn |
| `scheme_words` | What is written beside the parts of a train's scheme, and how much room it takes |
| `train_row` | In which order the discs of a train stand beside each other in a figure |
| `transient` | Manoeuvres of trains over time, waterfalls |
"""

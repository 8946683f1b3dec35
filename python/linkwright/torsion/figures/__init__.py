"""Figures of trains.

| module | |
| --- | --- |
| `captions` | The figures of a study of torsional vibration, with their captions |
| `forced` | Forced vibration of trains over their speeds; what a damper leaves of a resonance |
| `friction` | Clutches, brakes and freewheels over time |
| `modes` | Mode shapes of trains, Campbell's diagram |
| `scheme` | Equivalent schemes of trains, by `scheme_layout` and `scheme_page` |
| `equal_planets` | One of the equal planets of a stage, for drawings |
| `scheme_layout` | Where the parts of a train's scheme are drawn |
| `scheme_page` | How large the scheme of a train is drawn, and what is written beside its parts |
| `stars` | Star diagrams of orders |
| `transient` | Manoeuvres of trains over time, waterfalls |
"""

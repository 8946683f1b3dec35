"""A report of a study: one HTML file that needs nothing else.

| module | gives |
| --- | --- |
| `page` | the page: `report_html`, `write_report` |
| `quantities` | words, symbols and units of results; numbers as text |
| `tables` | results as tables, for the page and for the terminal |
| `machine_table` | the entries of a machine as a table |
| `assumptions` | what was taken for granted, as it applies to a machine |
| `formulas` | formulas of the measures, with their sources |
| `figures` | the figures of a study, with captions |
| `scene` | the moving sketch: positions over a turn |
| `scene_topper` | the knife of a topper over a row of heads, to be moved |
| `inline` | SVG that can stand in a page together with others |
| `csv` | curves as text |

Jinja2 and matplotlib are imported when a page is made.
"""

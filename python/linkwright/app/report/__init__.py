"""The report of a study: page, tables, figures, moving sketch, assumptions.

| module | |
| --- | --- |
| `answered` | What a report says of the answer of any command; variants beside each other |
| `assumptions` | What was taken for granted, as it applies to a machine |
| `company` | The head of a report, from a company file |
| `figures` | The figures of a study, with captions |
| `moving` | The motion as GIF or MP4, a pose as DXF |
| `page` | What the report says, and its page: `report_html`, `write_report` |
| `scene` | The moving sketch: positions over one revolution |
| `sketch` | The mechanism at one instant, for paper |
| `tables` | Results as tables, for the page and for the terminal |
"""

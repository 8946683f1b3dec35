"""What all figures share: style, SVG and PNG, captions.

| module | |
| --- | --- |
| `captioned` | A figure of the page with its words |
| `in_units` | Axes in the units that the reader wants |
| `inline` | SVG that can stand in a page together with others |
| `plotted` | The curves of a result as a figure |
| `readout` | What the cursor reads in a figure of a page |
| `style` | Colours, fonts, axes |
| `svg` | A figure as SVG text, or as PNG |
"""

"""What all figures share: style, SVG and PNG, captions.

| module | |
| --- | --- |
| `from_zero` | Axes over the crank angle, from the dead centre that the reader wants |
| `in_language` | Figures with their words in another language |
| `in_units` | Axes in the units that the reader wants |
| `plotted` | The curves of a result as a figure |
| `style` | Colours, fonts, axes |
| `svg` | A figure as SVG, alone and in a page, as PNG, and what the cursor reads in it |
"""

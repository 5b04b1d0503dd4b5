"""
A preset for a CAD part
=======================

A part with creases, whose triangulation has been scrambled by random flips. What does each preset
make of it?
"""

from meshlab_willmore import measures, optimize_flips
from meshlab_willmore.demo.experiments import PART_CAMERA
from meshlab_willmore.demo.models import scrambled, technical_part
from meshlab_willmore.options import PRESET
from meshlab_willmore.report.pictures import Shot, comparison

part = technical_part()
vertices, faces = scrambled(part)

# %%
# The absolute mean curvature M adds up how much the edges are bent, each times its length.
# Scrambling raises it, as it tears creases:

for name, start in (("part", part), ("scrambled", (vertices, faces))):
    print(f"{name}: M {measures(*start).absolute_mean_curvature:.1f}")

# %%

results = {}
for preset in PRESET.choices:
    result = results[preset] = optimize_flips(vertices, faces, preset=preset)
    print(
        f"{preset:8}  {result.flips:5} flips  M {result.absolute_mean_curvature_after:5.1f}  "
        f"mean shape {result.mean_shape_after:.2f}"
    )

# %%
# "faithful" finds the creases back. "smooth" has the best triangles, and cuts corners:

figure = comparison(
    PART_CAMERA,
    Shot("scrambled", vertices, faces),
    Shot("smooth", vertices, results["smooth"].faces),
    Shot("faithful", vertices, results["faithful"].faces),
)

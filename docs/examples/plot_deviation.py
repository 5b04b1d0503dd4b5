"""
Good triangles, and how far the surface may move
================================================

The preset "shape" makes better triangles of a surface that is right, and stays within
``maxdeviation`` of it. What does a larger limit buy?
"""

import matplotlib.pyplot as plt
import numpy as np

from meshlab_willmore import optimize_flips
from meshlab_willmore.demo.models import technical_part

vertices, faces = technical_part()
diagonal = np.linalg.norm(np.ptp(vertices, axis=0))

# %%
# The bound is proved, not estimated: no point of the new surface is farther than ``deviation`` from
# the old one, nor the other way round.

percent = np.array([0.003, 0.01, 0.03, 0.1, 0.3, 1.0])
results = [
    optimize_flips(vertices, faces, preset="shape", maxdeviation=limit / 100 * diagonal)
    for limit in percent
]
for limit, result in zip(percent, results, strict=True):
    moved = 100 * result.deviation / diagonal
    print(f"{limit:5} %: moved by {moved:.4f} %, mean shape {result.mean_shape_after:.3f}")

# %%

figure, axis = plt.subplots(figsize=(7, 3.5))
axis.plot(percent, [result.mean_shape_after for result in results], "o-", label="shape")
axis.axhline(results[0].mean_shape_before, color="0.6", label="as it is")
axis.axvline(0.03, color="0.8", linestyle=":", label="default")
axis.set(xscale="log", xlabel="maxdeviation, % of the diagonal", ylabel="mean shape")
axis.legend()

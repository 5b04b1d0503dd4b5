"""
Where the Willmore energy is
============================

W of each vertex, before and after. It is 0 where a vertex and its neighbours lie on a sphere or
plane, and large at creases and spikes, so it shows on a logarithmic scale.
"""

import matplotlib.pyplot as plt
import numpy as np

from meshlab_willmore import optimize_flips, vertex_willmore_energy
from meshlab_willmore.demo.models import sampled_torus

vertices, faces = sampled_torus(2000)
after = optimize_flips(vertices, faces, energy="willmore").faces

# %%
# The torus from above: its upper half, coloured by W.

LEAST, MOST = 1e-2, 1e1
figure, axes = plt.subplots(1, 2, figsize=(10, 5), sharey=True)
for panel, triangles, title in zip(axes, (faces, after), ("before", "after"), strict=True):
    energy = vertex_willmore_energy(vertices, triangles)
    upper = triangles[vertices[triangles][:, :, 2].mean(axis=1) > 0]
    shown = np.log10(np.clip(energy, LEAST, MOST))[upper].mean(axis=1)
    drawn = panel.tripcolor(*vertices[:, :2].T, upper, facecolors=shown, vmin=-2, vmax=1)
    panel.set(aspect="equal", title=f"{title}: W {energy.sum():.0f}")
    panel.axis("off")
bar = figure.colorbar(drawn, ax=axes, ticks=[-2, -1, 0, 1], label="W of a vertex")
bar.ax.set_yticklabels(["0.01", "0.1", "1", "10"])

# %%
# How the vertices are distributed:

histogram, axis = plt.subplots(figsize=(7, 3.5))
bins = np.logspace(-3, 1.2, 50)
for triangles, title in ((faces, "before"), (after, "after")):
    energy = vertex_willmore_energy(vertices, triangles)
    axis.hist(np.clip(energy, bins[0], None), bins, alpha=0.6, label=title)
axis.set(xscale="log", xlabel="W of a vertex", ylabel="vertices")
axis.legend()

"""
A face scan, before and after
=============================

The paper's third experiment: points of a scan that comes with PyMeshLab, triangulated in a
stretched parameter domain, so that most edges run up and down. Flips repair what they can without
moving a point.
"""

import pymeshlab

from meshlab_willmore import measures, optimize_flips
from meshlab_willmore.demo.experiments import CLOSEUP_CAMERA
from meshlab_willmore.demo.models import surface_of
from meshlab_willmore.demo.scan import CLEANING, scan_file, stretched_triangulation
from meshlab_willmore.report.pictures import Shot, comparison


def clean(meshes):
    """Apply the demo's cleaning filters."""
    for name, options in CLEANING:
        meshes.apply_filter(name, **options)


scan = pymeshlab.MeshSet()
scan.load_new_mesh(str(scan_file()))
clean(scan)
face = pymeshlab.MeshSet()
face.add_mesh(pymeshlab.Mesh(*stretched_triangulation(surface_of(scan))))
clean(face)
vertices, faces = surface_of(face)
print(f"{len(vertices)} vertices, {len(faces)} faces")

# %%
# The default makes few, careful flips. The preset "faithful" looks for the surface first, and then
# for good triangles:

paper = optimize_flips(vertices, faces)
faithful = optimize_flips(vertices, faces, preset="faithful")
for name, result in (("paper", paper), ("faithful", faithful)):
    totals = measures(vertices, result.faces)
    print(f"{name}: {result.flips} flips, W {totals.willmore_energy:.0f}")

# %%

figure = comparison(
    CLOSEUP_CAMERA,
    Shot("as triangulated", vertices, faces),
    Shot(f'"paper": {paper.flips} flips', vertices, paper.faces),
    Shot(f'"faithful": {faithful.flips} flips', vertices, faithful.faces),
)

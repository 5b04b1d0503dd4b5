"""Faults of projects, of the forms of files, of completion, dry runs and printed steps."""

from . import Fault

PROJECTS = [
    Fault(
        "the matrix of a layer is put into its vertices",
        "mesh_files/projects.py",
        "freeze=False,",
        "freeze=True,",
        "tests/cli/test_projects.py",
    ),
    Fault(
        "meshes of projects are not tried before PyMeshLab reads them",
        "mesh_files/projects.py",
        "        loading.load(pymeshlab.MeshSet(), file, is_isolated)\n",
        "",
        "tests/cli/test_projects.py",
    ),
    Fault(
        "layers share a texture because of its name",
        "mesh_files/projects.py",
        "if own & textures else",
        "if False else",
        "tests/cli/test_projects.py",
    ),
    Fault(
        "a layer that can't be saved is found after the whole script",
        "batch/jobs.py",
        "                    check_layers(output.path)\n",
        "                    pass\n",
        "tests/cli/test_projects.py",
    ),
    Fault(
        "an output may have the name of a layer",
        "batch/jobs.py",
        "if (project := projects.get(_project_key(path))) is not None:",
        "if False:",
        "tests/cli/test_projects.py",
    ),
    Fault(
        "a batch does not see that a mesh of a project has changed",
        "batch/resuming.py",
        "stamp = records.stamp(job.sources)",
        "stamp = records.stamp(job.inputs)",
        "tests/cli/test_projects.py",
    ),
    Fault(
        "faces of a PLY are read as if all had the same number of corners",
        "mesh_files/single.py",
        'if element.name == "vertex":\n                break',
        "if False:\n                break",
        "tests/mesh_files/test_single.py",
    ),
    Fault(
        "another precision counts as the same batch",
        "batch/runner.py",
        "output[1:] for",
        "output[1:3] for",
        "tests/cli/test_conversion.py",
    ),
]

SHELLS = [
    Fault(
        "bash takes values with blanks apart",
        "cli/completion.py",
        'COMPREPLY+=("$value")',
        "COMPREPLY+=($value)",
        "tests/cli/test_completion.py",
    ),
    Fault(
        "a line that is not whole yet is an error in completion",
        "cli/run.py",
        "            if not ctx.resilient_parsing:\n                raise\n",
        "            raise\n",
        "tests/cli/test_completion.py",
    ),
    Fault(
        "a dry run makes folders",
        "batch/jobs.py",
        "if fixed.is_dir() and makes_folders:",
        "if fixed.is_dir():",
        "tests/cli/test_batch.py",
    ),
    Fault(
        "a default that depends on the mesh is in a step",
        "cli/step_text.py",
        " and not _depends(known, own)",
        "",
        "tests/cli/test_filters.py",
    ),
]

FAULTS = [*PROJECTS, *SHELLS]

"""Which flips find a surface back? Prints the tables of docs/presets.md.

Run by hand, from the top of the repository (a quarter of an hour on a busy machine; all energies
with all searches take far longer, so choose models there):

    python -m studies.faithful
    python -m studies.faithful --searches --models torus bunny
    pip install meshlib  # optional; its licence allows evaluation and non-commercial use only

The surfaces are those of PyMeshLab's wheel, and some made in code. Each is decimated to some 3,000
of its vertices, none of which moves, and its triangulation scrambled by 0.3 random legal flips for
each edge. All tools start from that, and with `--decimated` from the decimated mesh itself. Means
are over the models on which a tool has a result; its row says if these are not all.
"""

import argparse
import sys

import numpy as np

from studies import originals
from studies.fidelity import Fidelity, fidelity
from studies.models import print_table
from studies.tools import QUICK, SEARCHES, all_tools

HEAD = ["tool", "normal error", "distance", "mean shape", "1 % worst", "cut faces", "seconds"]


class Results:
    """What is measured, by tool and model: a Fidelity, and seconds."""

    def __init__(self):
        self.by_tool = {}

    def add(self, tool, model, found, seconds):
        self.by_tool.setdefault(tool, {})[model] = (*found, seconds)

    def means(self):
        """Lines of the table over all models."""
        most = max(map(len, self.by_tool.values()))
        for tool, found in self.by_tool.items():
            values = np.mean(list(found.values()), axis=0)
            if len(found) < most:
                tool = f"{tool} ({len(found)} of {most} models)"
            yield [tool, *texts(values)]

    def single(self, column):
        """Lines of a table of one number: tools by models."""
        models = list(next(iter(self.by_tool.values())))
        for tool, found in self.by_tool.items():
            values = [found.get(model) for model in models]
            yield [tool, *("" if row is None else texts(row)[column] for row in values)]


def texts(values):
    error, distance, mean_shape, worst, cuts, seconds = values
    return [
        f"{error:.2f}",
        f"{distance:.1f}",
        f"{mean_shape:.3f}",
        f"{worst:.3f}",
        f"{cuts:.4g}",
        "" if np.isnan(seconds) else f"{seconds:.3f}",
    ]


def measured(options, tools=None):
    """Run all tools, or the given ones, on all models, and say what is going on."""
    results = Results()
    tools = list(tools or all_tools(SEARCHES if options.searches else QUICK, options.limit))
    for start in originals.starts(options.models, options.vertices, options.seed):
        faces = start.faces
        results.add("(decimated)", start.name, measure(start, faces), np.nan)
        if not options.decimated:
            faces = originals.scrambled(start, options.seed)
            results.add("(scrambled)", start.name, measure(start, faces), np.nan)
        for tool in tools:
            print(f"{start.name}: {tool.name}", file=sys.stderr)
            done = tool.run(start.vertices, faces)
            if done is not None:
                results.add(tool.name, start.name, measure(start, done[0]), done[1])
    return results


def measure(start, faces):
    return fidelity(start.vertices, faces, start.original)


def main(arguments):
    results = measured(options_of(arguments))
    models = list(next(iter(results.by_tool.values())))
    print(f"\nMeans over {len(models)} models\n")
    print_table(HEAD, results.means())
    for column, name in enumerate(Fidelity._fields):
        print(f"\n{name}\n")
        print_table(["tool", *models], results.single(column))


def options_of(arguments):
    parser = argparse.ArgumentParser(prog="python -m studies.faithful")
    parser.add_argument("--models", nargs="+", default=(), help="only these; default: all")
    parser.add_argument("--searches", action="store_true", help="all energies with all searches")
    parser.add_argument("--decimated", action="store_true", help="start from the decimated meshes")
    parser.add_argument("--vertices", type=int, help="about so many for each model")
    parser.add_argument("--seed", type=int, default=0, help="of the scrambling and the noise")
    parser.add_argument(
        "--limit", type=float, default=60.0, help="seconds for MeshLab's curvature flip"
    )
    return parser.parse_args(arguments)


if __name__ == "__main__":
    main(sys.argv[1:])

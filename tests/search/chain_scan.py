"""The variable-depth search as plain recursion, which copies the mesh for each flip it tries."""

import copy
import math

import numpy as np
import pytest

from meshlab_willmore import guards
from meshlab_willmore.energy import delaunay, table, willmore
from meshlab_willmore.mesh.halfedge import NONE, apex, flip, following, previous
from meshlab_willmore.search import snapshots
from tests.connectivity import can_flip, validate_connectivity
from tests.search.ways import ends

# More rounds than any run needs.
MANY = 100


def around(mesh, h):
    """The ring in the order of the module's picture."""
    t = int(mesh.twin[h])
    ring = []
    for side in (following(h), previous(h), following(t), previous(t)):
        ring.append(int(side))
        outside = int(mesh.twin[side])
        if outside != NONE:
            ring += [following(outside), previous(outside)]
    return ring


def corners(mesh, h):
    """The vertices of the diamond of `h`."""
    t = int(mesh.twin[h])
    return ends(mesh, h) | {int(apex(mesh, h)), int(apex(mesh, t))}


class Scan:
    """Chains by recursion, on copies; every edge is tried again until none helps."""

    def __init__(self, rules, limits, rank, judge, is_blocked=lambda mesh, h: False):
        self.rules, self.limits, self.rank, self.judge = rules, limits, rank, judge
        self.is_blocked = is_blocked
        # Corners of what was flipped for good.
        self.moved = set()

    def with_limits(self, **limits):
        """Another scan, which notes its flips in the same place."""
        other = copy.copy(self)
        other.limits = self.limits._replace(**limits)
        return other

    def allowed(self, mesh, h):
        if mesh.twin[h] == NONE or not can_flip(mesh, h):
            return False
        if not np.isfinite(self.rank(mesh, h)) or guards.folds(mesh, h, self.rules.fold):
            return False
        return not self.is_blocked(mesh, h)

    def explore(self, mesh, candidates, chain, made, width):
        """Follow the first `width` allowed candidates; True once a chain through one helps."""
        ranked = sorted(
            (-np.rint(self.rank(mesh, h) / self.rules.rank_step), sorted(ends(mesh, h)), place, h)
            for place, h in enumerate(candidates)
            if ends(mesh, h) not in made and self.allowed(mesh, h)
        )
        last = len(chain) + 1 == self.limits.depth
        if not (last and chain):
            lost = -math.fsum(entry[1] for entry in chain)
            ranked = [
                entry for entry in ranked if lost - self.judge(mesh, entry[-1]) <= table.MOST_LOSS
            ]
        # The last step is free, so that all edges may be tried: in the order of the ring.
        if last and chain:
            ranked.sort(key=lambda entry: entry[2])
            width = len(ranked)
        for *_, h in ranked[:width]:
            longer = [*chain, (h, self.judge(mesh, h), willmore.cost_reduction(mesh, h))]
            drop = math.fsum(entry[1] for entry in longer)
            rise = -math.fsum(entry[2] for entry in longer)
            if drop > self.best[0] + self.rules.tolerance and (
                not self.rules.monotone or rise <= self.rules.tie
            ):
                self.best = drop, [entry[0] for entry in longer]
            if last:
                continue
            flipped = snapshots.copy_of(mesh)
            flip(flipped, h)
            following_width = -(-width // 2) if chain else self.limits.breadth
            joined = {*made, ends(flipped, h)}
            self.explore(flipped, around(flipped, h), longer, joined, following_width)
            if self.best[1]:
                break

    def chain_from(self, mesh, start):
        self.best = 0.0, []
        self.explore(mesh, [start], [], set(), 1)
        return self.best

    def run(self, mesh, rounds, is_start=lambda h: True):
        """Make all flips; return their number for each chain."""
        made = []
        for _ in range(rounds):
            waiting = [h for h in range(len(mesh.origin)) if h < mesh.twin[h] and is_start(h)]
            before = len(made)
            while waiting:
                h = waiting.pop(0)
                if mesh.twin[h] < h:
                    continue
                drop, flips = self.chain_from(mesh, h)
                if not flips:
                    continue
                made.append(len(flips))
                energy = willmore.total(mesh)
                for h in flips:
                    self.moved |= corners(mesh, h)
                    flip(mesh, h)
                    for x in (h, *around(mesh, h)):
                        low = min(x, int(mesh.twin[x]))
                        if low != NONE and low not in waiting:
                            waiting.append(low)
                validate_connectivity(mesh)
                assert willmore.total(mesh) == pytest.approx(energy - drop, abs=1e-9)
            if len(made) == before:
                break
        return made

    def search(self, mesh):
        """Make all chains as the search does; return the number of flips of each.

        Chains that do not branch, until none helps; then those that branch and are one flip longer
        where chains have helped, and where another energy would flip edges; again if that helps.
        """
        straight = self.with_limits(breadth=1)
        deeper = self.with_limits(depth=self.limits.depth + 1)
        made = straight.run(mesh, MANY)
        while self.limits.depth > 1:
            doubtful = set(self.moved)
            self.moved.clear()
            for h in range(len(mesh.origin)):
                if h > mesh.twin[h] or not can_flip(mesh, h):
                    continue
                gain = max(delaunay.cost_reduction(mesh, h), willmore.cost_reduction(mesh, h))
                if gain > 1e-7 and not guards.folds(mesh, h, self.rules.fold):
                    doubtful |= corners(mesh, h)
            starts = [h for h in range(len(mesh.origin)) if ends(mesh, h) & doubtful]
            found = deeper.run(mesh, 1, starts.__contains__)
            if not found:
                break
            made += found + straight.run(mesh, MANY)
        return made

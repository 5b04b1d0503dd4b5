"""How an energy is minimised.

The searches are `greedy`, `parallel_greedy` (whose state and lists are in `rounds`),
`variable_depth` (of `chains`, and in `regions` of large meshes), `annealing` and `multistart`. Each
has a function ``run`` with the parameters of `greedy.run`; `meshlab_willmore.execution` has a table
of them. They share

- `rules`: their options, and when a flip is refused;
- `stencil`: the edges whose cost reductions a flip changes;
- `costs`: what some flips gain, by the number of the energy;
- `scoring`: the same for all edges of a mesh, many at once;
- `snapshots`: states to which several ways lead, of which the best counts;
- `containers`: a priority queue, a queue, a set of vertex pairs, watch lists;
- `compiled`: what they have to know of each energy, with kernels of which each energy has `copies`.
"""

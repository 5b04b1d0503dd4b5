"""How an energy is minimised.

The searches are `greedy`, `parallel_greedy` (whose state and lists are in `rounds`),
`variable_depth` (of `chains`, and in `regions` of large meshes), `annealing` and `multistart`. Each
has a function ``run`` with the parameters of `greedy.run`; `meshlab_willmore.optimize` has a table
of them. They share

- `rules`: their options, and when a flip is refused;
- `stencil`: the edges whose cost reductions a flip changes;
- `scoring`: what a flip gains, for one edge or for many at once;
- `containers`: a priority queue, a queue, a set of vertex pairs, watch lists;
- `compiled`: the kernels of all searches for each energy.
"""

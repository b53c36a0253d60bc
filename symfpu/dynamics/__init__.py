"""Motion of the chain: integrators, orbits and their tangent maps; rests on the chain only."""

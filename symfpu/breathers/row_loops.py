"""The compiled loop of single rows of the Jacobian of harmonic balance.

Importing this module imports numba.
"""

from __future__ import annotations

from typing import Any

from symfpu.compiled import compiled


@compiled(error_model="numpy")
def fill_rows(
    rows: Any, table: Any, linear: Any, own_n: Any, own_q: Any, n: Any, q: Any
) -> None:
    """Minus the slopes of the bonds between some coefficients and all, (places, n).

    table : what the slopes have of the harmonics 0 .. 2H and the modes 0 .. N, (2H+1, N+1).
    linear : Omega_q, (N-1,). own_n, own_q : harmonics and modes less 1 of the rows. n, q : of all.

    Of q and q' the slopes have Omega_q Omega_q' times what the table has of |q - q'| and q + q',
    beyond N of 2 N - q - q' with the other sign; of n and n' that of |n - n'| and n + n'.
    """
    N = table.shape[1] - 1
    for i in range(len(own_n)):
        mode, size = own_q[i] + 1, linear[own_q[i]]
        for j in range(len(n)):
            other = q[j] + 1
            total, sign = mode + other, 1.0
            if total > N:
                total, sign = 2 * N - total, -1.0
            apart, both = abs(mode - other), size * linear[q[j]]
            less, more = table[abs(own_n[i] - n[j])], table[own_n[i] + n[j]]
            first = both * (less[apart] + sign * less[total])
            rows[i, j] = -(first + both * (more[apart] + sign * more[total]))

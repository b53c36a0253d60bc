"""Independent checker of propagation certificates: mode space, the tensors B and C summed directly,
Python integers only.

m = (p_1, n_1, ..) are the exponents of w_i = Omega_i z_i and conj w_i, nu = p - n, u_q = Omega_q
Q_q, S = sum B u u or sum C u u u (Eqs. moda, modb):

    u_q^(k)[m] = L_q(nu) (sum_n W_q^(n) u_q^(k-n) - S_q^(k))[m],    W_q^(n)[f] = S_q^(n)[f w_q].

Certificates of version 2 are of other potentials, V' = r + c_3 r^2 + c_4 r^3 + ..., whose
coefficients they name. S then is the sum of g_n T u^n over the powers n, T counting signs as B and
C do, with the g_n of `read_potential`.

A coefficient that is not 0 modulo p proves a mode excited for generic frequencies; with symbols
for the L_q(nu), a polynomial that is 0 proves a zero. Written to be audited: one claim a
function; `theorem.py` calls them in order. The folder shares no code with the prover and imports
nothing but the standard library and what checkers read with, `reading.py`.
"""

from symfpu.checkers.propagation.case import MODELS as MODELS
from symfpu.checkers.propagation.case import Case as Case
from symfpu.checkers.propagation.couplings import Budget as Budget
from symfpu.checkers.propagation.couplings import couplings as couplings
from symfpu.checkers.propagation.potentials import NAMED_POTENTIALS as NAMED_POTENTIALS
from symfpu.checkers.propagation.reading import FORMAT as FORMAT
from symfpu.checkers.propagation.reading import read_certificate as read_certificate
from symfpu.checkers.propagation.recursion import SYMBOLS as SYMBOLS
from symfpu.checkers.propagation.recursion import Point as Point
from symfpu.checkers.propagation.recursion import Recursion as Recursion
from symfpu.checkers.propagation.theorem import check_certificate as check_certificate
from symfpu.checkers.propagation.theorem import verify as verify

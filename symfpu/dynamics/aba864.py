"""The scheme ABA864 of seven kicks, on T + V and on harmonic + anharmonic.

S. Blanes, F. Casas, A. Farres, J. Laskar, J. Makazaga, A. Murua, Appl. Numer. Math. 68 (2013) 58,
generalised order (8, 6, 4): for kicks of size epsilon, an error of epsilon h^8 + epsilon^2 h^6 +
epsilon^3 h^4. T and V are of one size: the order is 4, with small constants.

On harmonic + anharmonic, in mode space, it is what it was made for, since the anharmonic kicks
are small. There kicks are products of cosine polynomials by their coefficients
(symfpu.dynamics.orbit_loops): they obey the selection rules, a mode that no product feeds stays
exactly zero, and tail modes keep their relative accuracy. A kick costs about N^2 where T + V
costs N.
"""

from __future__ import annotations

from symfpu.dynamics.scheme import Scheme, palindrome

DRIFTS = palindrome(
    (
        0.0711334264982231177779387300061549964174,
        0.241153427956640098736487795326289649618,
        0.521411761772814789212136078067994229991,
        -0.333698616227678005726562603400438876027,
    ),
    middle=False,
)

KICKS = palindrome(
    (
        0.183083687472197221961703757166430291072,
        0.310782859898574869507522291054262796375,
        -0.0265646185119588006972121379164987592663,
        0.0653961422823734184559721793911134363710,
    ),
    middle=True,
)

SOURCE = "S. Blanes et al., Appl. Numer. Math. 68 (2013) 58, ABA864"
ABA864 = Scheme(
    name="aba864", order=4, splitting="T + V", source=SOURCE, drifts=DRIFTS, kicks=KICKS
)
ABA864_MODES = Scheme(
    name="aba864_modes",
    order=4,
    splitting="harmonic + anharmonic",
    source=SOURCE,
    drifts=DRIFTS,
    kicks=KICKS,
)

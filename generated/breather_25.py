"""breather_25: an invariant torus of a Fermi-Pasta-Ulam chain. Written by a machine; do not edit.

written by: symfpu 0.1.0
made by: symfpu export breather_25.symfpu --lang numpy -o breather_25
orders: frequencies 12, coordinates 12
amplitudes: A_25 = 0.0512121591740189630941015617021
chain: Chain(N=32, alpha=0.33)
seeds: 25
frequencies: 1.8830741847088537
precision: 30 digits
hash of the coefficients: 1dcd398567a325e662ff3b53541cc134d88044b6eb5a24368358e04cb7f01601

orbit(t, phases), positions, momenta, harmonic_energies, energy: see their docstrings. Arrays end in the mode axis
q = 1 .. N-1, time first; angles in radians, everything else dimensionless. Run this file to test it.
"""

import numpy as np

N = 32
SEEDS = (25,)
FREQUENCIES = (1.8830741847088537,)
PHASES = (0.0,)
ALPHA, BETA = 0.33, 0.0
TOLERANCE = 1e-13
_TURNS = (  # omega / 2 pi, each as the sum of two doubles
    (0.2997005647051548, -9.350283012835618e-18),
)
_LEADING_TEXT = """

"""
_TRAILING_TEXT = """
0 2 4 6 8 10 12 1 3 5 7 9 11 13
"""
_LAYOUT_0 = """
0 0 7
"""
_COEFFICIENTS_0 = """
0.0 0.0 -2.7675140646771417e-22 4.2461145535150117e-19 0.0 0.0 0.00015117757854294937 0.0 0.0 -1.0786315577174035e-26
3.5508781926641617e-15 0.0 0.0 4.504624101242449e-10 0.0 0.0 0.0 6.475573571247884e-24 -1.1054425924466878e-20 0.0 0.0
-1.9354829168338714e-05 0.0 0.0 3.0277387632139386e-27 4.278296790564035e-15 0.0 0.0 -5.292931896694843e-10 0.0 0.0
0.0 -5.076568596010796e-27 -6.547434405602579e-22 0.0 0.0 -1.4244560699063556e-12 0.0 0.0 -8.798943565472705e-31
-4.001853415188579e-17 0.0 0.0 9.551077410701395e-13 0.0 0.0 0.0 3.1250813276403224e-29 1.2259705351549925e-24 0.0 0.0
-1.183771896274435e-19 0.0 0.0 1.1935546690289248e-33 3.0741888457648474e-20 0.0 0.0 7.692810797179155e-20 0.0 0.0 0.0
-3.404492072400157e-32 -5.188629273502791e-28 0.0 0.0 -8.135185521021295e-27 0.0 0.0 -2.9553264933332913e-36
2.932636965630418e-27 0.0 0.0 5.968105559678107e-27 0.0 0.0 0.0 1.0417857514940804e-35 -6.110739151851142e-35 0.0 0.0
-5.504373572318875e-34 0.0 0.0 2.1473604921341954e-39 2.4194676631029753e-34 0.0 0.0 4.184160810296171e-34 0.0 0.0 0.0
1.4304130218360944e-42 -5.547002995267631e-42 0.0 0.0 -3.58516483825606e-41 0.0 0.0 -4.951770626469579e-43
1.7909980366397718e-41 0.0 0.0 2.839524050376225e-41 0.0
"""
_LAYOUT_1 = """
0 7 7
"""
_COEFFICIENTS_1 = """
0.0 1.0085362127709726e-12 -3.0009165730556703e-29 0.0 0.0 5.901180334736764e-07 0.0 0.0 -6.263956347261713e-17
-3.0478218234177374e-24 0.0 0.0 0.051212159174018966 0.0 0.0 1.9848962258524294e-20 0.0 -4.41680461344106e-14
4.119927956461746e-31 0.0 0.0 -3.255064309203764e-09 0.0 0.0 -2.8137710311924094e-18 2.8204532207813212e-27 0.0 0.0
6.484677900176531e-09 0.0 0.0 -9.677505243551741e-24 0.0 3.592700000494951e-17 -8.821734306051385e-35 0.0 0.0
-3.170787737648405e-16 0.0 0.0 8.298014009276822e-21 -4.2381937600831196e-30 0.0 0.0 5.078046961673205e-16 0.0 0.0
2.3109989565631162e-25 0.0 3.953076109854066e-24 1.4941832672044366e-37 0.0 0.0 -2.4000856282382192e-23 0.0 0.0
-4.18925397951177e-24 1.4397579899091643e-32 0.0 0.0 3.6674735063896916e-23 0.0 0.0 -3.393665481940952e-28 0.0
3.277552578540149e-31 -2.6891346357676717e-40 0.0 0.0 -1.666762440682117e-30 0.0 0.0 -5.066825016153425e-31
-1.232681963069093e-35 0.0 0.0 2.488274267685113e-30 0.0 0.0 1.1402004196781838e-31 0.0 2.407459837840973e-38
1.64993122821882e-43 0.0 0.0 -1.1151673796019302e-37 0.0 0.0 -4.464623590164244e-38 3.06140035403912e-39 0.0 0.0
1.6174572296711147e-37 0.0 0.0 1.5188423173611879e-38 0.0 1.6707763393820603e-45 -3.307432135185679e-47 0.0 0.0
-7.255980735885705e-45 0.0 0.0 -3.4421120634491285e-45 4.595750834750287e-46 0.0 0.0 1.0284125712579862e-44 0.0 0.0
1.4511214638955135e-45
"""
_BLOCK_TEXTS = [(_LAYOUT_0, _COEFFICIENTS_0, [2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30]), (_LAYOUT_1, _COEFFICIENTS_1, [1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31])]
_CHECK_TIMES = """
0.0 1.234375 137.796875
"""
_CHECK_POSITIONS = """
0.0 0.0 9.6440409364052008165499232996776e-13 0.0 -2.9597261003104011324518384501783e-29
-2.7028087824828353612627044658721e-22 0.0 4.1290351143814618220684083397156e-19 0.0 0.0
0.0000005868629688473939242294794023275 0.0 0.0 0.00013182274795015445770040603026997 0.0 0.0
-6.5445040679054746831536312709047e-17 0.0 -3.0450055940054600582074943427999e-24
-7.7594555177151547227975623413661e-27 0.0 7.7891871909677003844228580151139e-15 0.0 0.0
0.051212165658697371075365183981197 0.0 0.0 -7.7875671727241077905956901835428e-11 0.0 0.0
1.9839515513923868630958605733484e-20 0.0 0.0 -7.2416795534025706137824155930722e-13 0.0
2.0852512350817767652198639537708e-29 -2.7715760804947483649937791789606e-22 0.0 4.2596318073993593371222637787488e-19
0.0 0.0 -0.00000040631949216112398908701451287024 0.0 0.0 0.00015240674362398792260348514720019 0.0 0.0
4.0698233852054821407212547672128e-17 0.0 2.0877527894843911774333883638429e-24 -1.0977724620074538034165200291218e-26
0.0 3.3188787257677141793481901708937e-15 0.0 0.0 -0.035043730852875582750097487966043 0.0 0.0
4.8312873427862796145936814247648e-10 0.0 0.0 -1.3589683746960515290262964457926e-20 0.0 0.0
-3.3303655987521256727667129246487e-13 0.0 9.2012573956782559532254968658523e-30 -2.820952360229937906256451348854e-22
0.0 4.3349463894918925334825064396725e-19 0.0 0.0 -0.00000017713766384896411866820450628041 0.0 0.0
0.00016714428250076417464790258827856 0.0 0.0 1.6317659798916568301361175685412e-17 0.0
9.0391025485799071162074646825746e-25 -1.3284356426064079247121726053589e-26 0.0 7.0683028114628598409806617892134e-18
0.0 0.0 -0.015151058139371609272742935180684 0.0 0.0 8.8744600056298917715881904794973e-10 0.0 0.0
-5.8801122261358461123552647456841e-21
"""
_CHECK_MOMENTA = """
0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0 0.0
0.0 0.0 0.0 0.0 -1.2257722678242292700758364098964e-12 0.0 3.9725215784649382930730548838142e-29
2.4343241552803088369166746823374e-23 0.0 -4.0937039815554097571532303723687e-20 0.0 0.0
-0.00000079862308195406574124232296116339 0.0 0.0 -0.000072746015150619979159315197453489 0.0 0.0
9.6196743034423339799669641845857e-17 0.0 4.1749854608382265744791091404612e-24 1.1380722383753839172306237070612e-26
0.0 1.6118043039990650924770775031544e-14 0.0 0.0 -0.070322742974169949390105237819482 0.0 0.0
-0.0000000019902847337896515905999748180306 0.0 0.0 -2.7219327532445611421879404095884e-20 0.0 0.0
-1.9690551961773691095601866962299e-12 0.0 5.5424755968714802727295199253722e-29 1.3820336774722671186856740089541e-23
0.0 -1.8918681029217840852186931673723e-20 0.0 0.0 -0.0000010729069104971859661066581776606 0.0 0.0
-0.000041199959461840421412424587872843 0.0 0.0 1.0280128098752744449636638524754e-16 0.0
5.4922485646543797793818993973013e-24 6.4512386436229887310112846620392e-27 0.0 9.3884995959540997069833311221484e-15
0.0 0.0 -0.09211927600971585215349639942216 0.0 0.0 -0.0000000011333973049153176306124576377104 0.0 0.0
-3.5737961449745373298050618739078e-20
"""
_CHECK_ENERGIES = """
0.0046499993611292045887896602412298 0.0046499993611292045887896602412298 0.0046499993611292045887896602412298
"""

_SPLIT = min(1, len(SEEDS) - 1)
_MODES = np.arange(1, N)
_LINEAR = 2 * np.sin(_MODES * (np.pi / (2 * N)))


def _table(text, kind, columns):
    return np.array(text.split(), dtype=kind).reshape(-1, columns) if columns else np.zeros((1, 0), dtype=kind)


_LEADING, _TRAILING = _table(_LEADING_TEXT, int, _SPLIT), _table(_TRAILING_TEXT, int, len(SEEDS) - _SPLIT)
_BLOCK = 128  # times at once


def _slices(layout, text, modes):
    """(leading part, first trailing part, coefficients of cosines and rates times them) of every inner sum."""
    numbers, rows = _table(text, float, len(modes)), []
    at = 0
    for leading, start, count in _table(layout, int, 3):
        nu = np.concatenate([np.repeat(_LEADING[leading][None], count, axis=0), _TRAILING[start : start + count]], axis=1)
        part = numbers[at : at + count]
        both = np.concatenate([part, (nu @ np.array(FREQUENCIES))[:, None] * part], axis=1)
        rows.append((leading, start, np.ascontiguousarray(both.T)))
        at += count
    return np.array(modes) - 1, rows


_BLOCKS = [_slices(*block) for block in _BLOCK_TEXTS]


def _angles(t, phases):
    """omega t + phi modulo 2 pi, (s, times): turns in two doubles, so that large times lose no digit of the angle."""
    splitter = 134217729.0
    big = splitter * t
    t_high = big - (big - t)
    t_low = t - t_high
    columns = []
    for (high, low), phase in zip(_TURNS, phases):
        big = splitter * high
        f_high = big - (big - high)
        f_low = high - f_high
        product = t * high
        error = ((t_high * f_high - product) + t_high * f_low + t_low * f_high) + t_low * f_low
        columns.append(2 * np.pi * ((product - np.rint(product)) + error + t * low) + phase)
    return np.stack(columns)


def _plan(harmonics):
    """Harmonics as a number of the first seed and a row of a shorter list for the others."""
    if harmonics.shape[1] < 2:
        return harmonics[:, 0] if harmonics.shape[1] else None, None, None
    rest, where = np.unique(harmonics[:, 1:], axis=0, return_inverse=True)
    return harmonics[:, 0], where.reshape(-1), _plan(rest)


_OUTER, _INNER = _plan(_LEADING), _plan(_TRAILING)


def _waves(theta, plan):
    """exp(i nu.theta), (harmonics, times), from powers of exp(i theta_j); theta (s, times)."""
    first, where, rest = plan
    if first is None:
        return np.ones((1, theta.shape[-1]), dtype=complex)
    top = int(np.abs(first).max())
    rows = np.exp(1j * np.arange(-top, top + 1)[:, None] * theta[0])[first + top]
    if rest is not None:
        rows *= _waves(theta[1:], rest)[where]
    return rows


def orbit(t, phases=None):
    """Mode coordinates Q and momenta P: arrays (T, N-1) for times (T,), (N-1,) for a number.

    phases : s angles in radians, in the order of SEEDS; default PHASES. All quantities are dimensionless.
    """
    times = np.asarray(t, dtype=float)
    chosen = np.asarray(PHASES if phases is None else phases, dtype=float)
    if times.ndim > 1 or chosen.shape != (len(SEEDS),):
        raise ValueError("t must be a number or one-dimensional, phases one angle for each of the seeds %s" % (SEEDS,))
    flat = times.reshape(-1)
    Q, P = np.zeros((len(flat), N - 1)), np.zeros((len(flat), N - 1))
    for first in range(0, len(flat), _BLOCK):
        theta = _angles(flat[first : first + _BLOCK], chosen)
        outer, inner = _waves(theta[:_SPLIT], _OUTER), _waves(theta[_SPLIT:], _INNER).view(float)
        for columns, rows in _BLOCKS:
            m = len(columns)
            q, p = np.zeros((m, theta.shape[1])), np.zeros((m, theta.shape[1]))
            for leading, start, coefficients in rows:
                sums = (coefficients @ inner[start : start + coefficients.shape[1]]).view(complex)
                sums *= outer[leading]
                q += sums[:m].real
                p -= sums[m:].imag
            Q[first : first + _BLOCK, columns] = q.T
            P[first : first + _BLOCK, columns] = p.T
    return (Q[0], P[0]) if times.ndim == 0 else (Q, P)


def positions(t, phases=None):
    """Mode coordinates Q_q(t), q = 1 .. N-1; see orbit."""
    return orbit(t, phases)[0]


def momenta(t, phases=None):
    """Mode momenta P_q = dQ_q/dt; see orbit."""
    return orbit(t, phases)[1]


def harmonic_energies(t, phases=None):
    """E_q = (P_q^2 + Omega_q^2 Q_q^2) / 2 of every mode; shapes as those of orbit."""
    Q, P = orbit(t, phases)
    return 0.5 * (P**2 + (_LINEAR * Q) ** 2)


def energy(t, phases=None):
    """Total energy H of the chain; a number, or (T,)."""
    Q, P = orbit(t, phases)
    bonds = np.cos(np.outer(_MODES, np.arange(N) + 0.5) * (np.pi / N)) * np.sqrt(2.0 / N)
    r = (_LINEAR * Q) @ bonds
    return 0.5 * np.sum(P**2, axis=-1) + np.sum(r**2 * (0.5 + r * (ALPHA / 3 + r * BETA / 4)), axis=-1)


def self_test():
    """Largest deviation from the embedded test vectors, relative to the largest coordinate or momentum."""
    times = np.array(_CHECK_TIMES.split(), dtype=float)
    Q, P = orbit(times)
    worst = 0.0
    for ours, text in ((Q, _CHECK_POSITIONS), (P, _CHECK_MOMENTA)):
        known = _table(text, float, N - 1)
        worst = max(worst, np.abs(ours - known).max() / np.abs(known).max())
    known = np.array(_CHECK_ENERGIES.split(), dtype=float)
    return max(worst, float(np.abs(energy(times) / known - 1).max()))


if __name__ == "__main__":
    deviation = self_test()
    print("largest deviation %.1e, allowed %.0e" % (deviation, TOLERANCE))
    raise SystemExit(0 if deviation <= TOLERANCE else 1)

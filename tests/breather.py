"""The breather of a chain, a seed and an amplitude, as tables of cases have them."""

import symfpu


def breather_of(chain, seed, amplitude):
    """The first one on the family from rest."""
    return symfpu.torus(chain, (seed,), amplitudes={seed: amplitude})

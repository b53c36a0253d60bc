"""Small tori: shifts of waves are those of the published normal form, short series fall as they should."""

import numpy as np
import pytest

from symfpu import Chain, ResonantDivisor
from symfpu.tori.short_series import shifts_by_squares, short_series
from tests.action_angle.test_at_rest import published_hessian
from tests.tolerances import SLOPE, TODA_LINEAR


@pytest.mark.parametrize(("alpha", "beta"), [(0.3, 0.0), (0.0, 0.5), (0.3, 0.2)])
@pytest.mark.parametrize(("N", "seeds"), [(7, (1, -2)), (9, (2, -3)), (11, (2, -1, 1))])
def test_shifts_are_those_of_the_published_form(N, seeds, alpha, beta):
    """d omega / d I, with I_j = Omega_j A_j^2 / 2; read next to the linear frequencies."""
    chain = Chain(N, alpha=str(alpha), beta=str(beta), ends="periodic")
    linear = 2 * np.abs(np.sin(np.pi * np.array(seeds) / N))
    expected = published_hessian(N, alpha, beta, seeds) * linear / 2
    assert shifts_by_squares(chain, seeds) == pytest.approx(expected, rel=TODA_LINEAR, abs=TODA_LINEAR * np.abs(expected).max())


@pytest.mark.parametrize(("ends", "seeds"), [("periodic", (1, -2)), ("fixed", (3, 1))])
def test_short_series_miss_their_equations_by_the_order(ends, seeds):
    """Degree 3 in the amplitudes is met: what is left over the force falls as the third power; the frequencies miss the fourth."""
    chain, (first, second) = Chain(8, alpha="0.3", ends=ends), seeds
    tori = [short_series(chain, {first: A, second: A / 2}, 2) for A in (0.1, 0.05)]
    assert tori[0].amplitudes == {first: 0.1, second: 0.05}
    left = [torus.residual() for torus in tori]
    assert np.log2(left[0] / left[1]) == pytest.approx(3, abs=SLOPE)


def test_opposite_waves_that_drive_each_other_are_refused():
    with pytest.raises(ResonantDivisor, match="driven in resonance"):
        short_series(Chain(8, beta=1, ends="periodic"), {2: 0.2, -2: 0.1}, 2)

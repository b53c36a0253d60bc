"""Pictures of public results: functions take a result and optional axes, and return axes."""

from symfpu.plots.atlas import atlas_borders as atlas_borders
from symfpu.plots.atlas import atlas_map as atlas_map
from symfpu.plots.families import family_amplitudes as family_amplitudes
from symfpu.plots.families import family_frequencies as family_frequencies
from symfpu.plots.families import family_multipliers as family_multipliers
from symfpu.plots.families import family_spectra as family_spectra
from symfpu.plots.frequency_map import frequency_drift as frequency_drift
from symfpu.plots.frequency_map import frequency_map as frequency_map
from symfpu.plots.indices import alignment as alignment
from symfpu.plots.indices import foretold as foretold
from symfpu.plots.indices import lyapunov as lyapunov
from symfpu.plots.lines import lines as lines
from symfpu.plots.motion import animation as animation
from symfpu.plots.motion import space_time as space_time
from symfpu.plots.motion import time_series as time_series
from symfpu.plots.normal import normal_frequencies as normal_frequencies
from symfpu.plots.normal_family import (
    family_normal_frequencies as family_normal_frequencies,
)
from symfpu.plots.rule import propagation as propagation
from symfpu.plots.series import amplitudes as amplitudes
from symfpu.plots.series import coefficients as coefficients
from symfpu.plots.series import residuals as residuals
from symfpu.plots.series import small_divisors as small_divisors
from symfpu.plots.spectra import spectrum as spectrum
from symfpu.plots.stability import multipliers as multipliers
from symfpu.plots.toda import toda_gaps as toda_gaps
from symfpu.plots.tori import section as section
from symfpu.plots.tori import torus as torus

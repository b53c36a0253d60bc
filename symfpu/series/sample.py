"""A universal series at many points at once: frequencies, couplings, and derivatives by them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import psutil
from numpy.typing import ArrayLike, NDArray

from symfpu.errors import InputError
from symfpu.series.series import LindstedtSeries
from symfpu.series.substitution import sampled_leaves, tables_in_doubles

Floats = NDArray[np.float64]

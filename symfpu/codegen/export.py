"""A torus or a series as source code in a file: the languages there are, legal names, and the file itself."""

from __future__ import annotations

import keyword
import re
from importlib.metadata import version
from pathlib import Path

from symfpu.codegen.languages.c import C
from symfpu.codegen.languages.fortran import FORTRAN
from symfpu.codegen.languages.mpmath import MPMATH
from symfpu.codegen.languages.numpy import NUMPY
from symfpu.codegen.languages.octave import OCTAVE
from symfpu.codegen.series_program import series_facts, series_program
from symfpu.codegen.torus_program import torus_facts, torus_program
from symfpu.errors import InputError
from symfpu.files.writing import output_file, write_text
from symfpu.numbers.arithmetic import text
from symfpu.series.series import LindstedtSeries
from symfpu.tori.quasiperiodic import QuasiPeriodic
from symfpu.tori.torus import QTorus

LONGEST_NAME = 40  # with a suffix it stays below the 63 characters of Fortran


LANGUAGES = {
    "c": C,
    "fortran": FORTRAN,
    "numpy": NUMPY,
    "mpmath": MPMATH,
    "octave": OCTAVE,
}


def export(
    solution: QuasiPeriodic | LindstedtSeries,
    language: str,
    path: str | Path,
    *,
    order: int | None = None,
    frequency_order: int | None = None,
    force: bool = False,
    command: str | None = None,
) -> Path:
    """Write a torus or a series as a source file that needs nothing of this package; returns its path.

    solution : a torus gives Q(t), P(t), E_q(t), H(t), with phases (radians) to choose; a series gives Q(t; A,
        phi), P, omega(A) and its Jacobian, with amplitudes, phases and frequencies to choose (Eqs. qser,
        omeser). In universal form the frequencies of the divisors are free too. All but phases is
        dimensionless.
    language : one of LANGUAGES.
    path : the file; its name without the extension names the functions or the module, and the extension may
        be left out.
    order, frequency_order : of a series only, where coordinates and frequencies are cut; default
        series.order.
    force : replace an existing file.
    command : what the header says made it.

    Raises InputError for an unknown language, a name that is no identifier, an existing file, an order above
    the series' order or given for a torus, and a universal series too large for straight-line code.

    >>> import tempfile
    >>> from symfpu.chain.chain import Chain
    >>> from symfpu.series.lindstedt import lindstedt
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     export(lindstedt(Chain(N=4, beta=1), (1,), ("0.8",), 1), "c", f"{folder}/mode").name
    'mode.c'
    """
    if language not in LANGUAGES:
        raise InputError("language", language, f"one of {', '.join(LANGUAGES)}", "name one of these")
    chosen = LANGUAGES[language]
    file = Path(path)
    if file.name and not file.suffix:
        file = file.with_suffix(f".{chosen.extension}")
    output_file(file, "path", "choose another")
    name = legal_name(file.stem)
    if file.exists() and not force:
        raise InputError("path", str(file), "a file that does not exist yet", "choose another, or replace it with force (--force)")
    orders = {key: value for key, value in (("order", order), ("frequency_order", frequency_order)) if value is not None}
    kind = "series" if isinstance(solution, LindstedtSeries) else "torus"
    words = ", ".join([kind, repr(language), repr(file.name), *(f"{key}={value}" for key, value in orders.items())])
    made = {"written by": f"symfpu {version('symfpu')}", "made by": command or f"symfpu.export({words})"}
    if isinstance(solution, LindstedtSeries):
        facts = {**made, **series_facts(solution, order=order, frequency_order=frequency_order)}
        source = chosen.series(series_program(solution, name, facts, order=order, frequency_order=frequency_order))
    elif orders:
        raise InputError(next(iter(orders)), next(iter(orders.values())), "none for a torus, which has its orders", "export its series")
    else:
        source = chosen.torus(torus_program(solution, name, {**made, **_orders(solution), **torus_facts(solution)}))
    write_text(file, source)
    return file


def legal_name(name: str) -> str:
    """The name, if it is an identifier in every language; InputError otherwise."""
    allowed = f"a lower-case letter, then letters, digits and underscores, at most {LONGEST_NAME}"
    if not re.fullmatch(rf"[a-z][a-z0-9_]{{0,{LONGEST_NAME - 1}}}", name, re.ASCII) or keyword.iskeyword(name) or name in RESERVED:
        raise InputError("path", name, f"a file name that is also an identifier: {allowed}, no reserved word", "rename the file")
    return name


RESERVED = frozenset().union(*(language.reserved for language in LANGUAGES.values()))


def _orders(torus: QuasiPeriodic) -> dict[str, str]:
    if not isinstance(torus, QTorus):
        return {}
    amplitudes = ", ".join(f"A_{q} = {text(a, torus.digits or 17)}" for q, a in torus.amplitudes.items())
    return {"orders": f"frequencies {torus.frequency_order}, coordinates {torus.order}", "amplitudes": amplitudes}

"""A torus or a series as source code in a file: the languages there are, and legal names."""

from __future__ import annotations

import keyword
import re
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any

from symfpu.codegen.languages.c import C
from symfpu.codegen.languages.fortran import FORTRAN
from symfpu.codegen.languages.mpmath import MPMATH
from symfpu.codegen.languages.numpy import NUMPY
from symfpu.codegen.languages.octave import OCTAVE
from symfpu.codegen.series_program import series_facts, series_program
from symfpu.codegen.templating import Language
from symfpu.codegen.torus_program import DOUBLE_DIGITS, torus_facts, torus_program
from symfpu.errors import InputError
from symfpu.files.writing import output_file, write_text
from symfpu.numbers.arithmetic import text
from symfpu.numbers.public import public
from symfpu.series.series import LindstedtSeries, require_series
from symfpu.tori.from_series import FromSeries
from symfpu.tori.torus import Torus, comes_from, require_fixed_solution

LANGUAGES = {
    "c": C,
    "fortran": FORTRAN,
    "numpy": NUMPY,
    "mpmath": MPMATH,
    "octave": OCTAVE,
}

RESERVED_WORDS = frozenset().union(*(language.reserved for language in LANGUAGES.values()))
LONGEST_NAME = 40  # with a suffix it stays below the 63 characters of Fortran


@public
def export(
    solution: Torus | LindstedtSeries,
    language: str,
    path: str | Path,
    *,
    order: int | None = None,
    frequency_order: int | None = None,
    derivatives: bool = False,
    force: bool = False,
    command: str | None = None,
) -> Path:
    """Write a torus or a series as a source file that needs nothing of this package.

    Returns its path.

    solution : a torus gives Q(t), P(t), E_q(t), H(t), with phases (radians) to choose; a series
        gives Q(t; A, phi), P, omega(A) and its Jacobian, with amplitudes, phases and frequencies
        to choose (Eqs. qser, omeser). In universal form the frequencies of the divisors are free
        too. All but phases is dimensionless.
    language : one of LANGUAGES.
    path : the file; its name without the extension names the functions or the module, and the
        extension may be left out.
    order, frequency_order : of a series only, where coordinates and frequencies are cut; default
        series.order.
    derivatives : of a universal series only, by the frequencies, of Q, P and omega(A). It is then
        written as tables of operations, as large ones are in any case.
    force : replace an existing file.
    command : what the header says made it.

    Raises InputError for an unknown language, a name that is no identifier, an existing file, an
    order above the series' order or given for a torus, derivatives of what is no universal series,
    and a universal series whose operations do not fit into a file.

    >>> import tempfile
    >>> from symfpu.chain.chain import Chain
    >>> from symfpu.series.lindstedt import lindstedt
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     export(lindstedt(Chain(N=4, beta=1), (1,), ("0.8",), 1), "c", f"{folder}/mode").name
    'mode.c'
    """
    chosen = _language(language)
    file = _file(Path(path), chosen.extension, force)
    given = {"order": order, "frequency_order": frequency_order}
    orders = {key: value for key, value in given.items() if value is not None}
    options: dict[str, Any] = {**orders, "derivatives": True} if derivatives else {**orders}
    facts = {
        "written by": f"symfpu {version('symfpu')}",
        "made by": command or _call(solution, language, file, options),
    }
    if isinstance(solution, LindstedtSeries):
        require_series(solution)
        facts |= series_facts(solution, **orders)
        series = series_program(solution, file.stem, facts, **options)
        source = chosen.series(series)
    else:
        require_fixed_solution(solution, "solution")
        _refuse_options(options)
        facts |= _orders(solution) | torus_facts(solution)
        torus = torus_program(solution, file.stem, facts)
        source = chosen.torus(torus)
    write_text(file, source)
    return file


def _language(name: str) -> Language:
    if name not in LANGUAGES:
        known = ", ".join(LANGUAGES)
        raise InputError("language", name, f"one of {known}", "name one of these")
    return LANGUAGES[name]


def _file(path: Path, extension: str, force: bool) -> Path:
    """The path with an extension; InputError if it cannot be written, or for an illegal name."""
    file = path
    if file.name and not file.suffix:
        file = file.with_suffix(f".{extension}")
    output_file(file, "path", "choose another")
    legal_name(file.stem)
    if file.exists() and not force:
        raise InputError(
            "path",
            str(file),
            "a file that does not exist yet",
            "choose another, or replace it with force (--force)",
        )
    return file


def _call(solution: Any, language: str, file: Path, options: Mapping[str, Any]) -> str:
    """The call that makes this file, for its header."""
    kind = "series" if isinstance(solution, LindstedtSeries) else "torus"
    keywords = [f"{key}={value}" for key, value in options.items()]
    words = [kind, repr(language), repr(file.name), *keywords]
    return f"symfpu.export({', '.join(words)})"


def _refuse_options(options: Mapping[str, Any]) -> None:
    for key, value in options.items():
        allowed = "none for a torus, which has its orders and frequencies"
        raise InputError(key, value, allowed, "export its series")


def legal_name(name: str) -> str:
    """The name, if it is an identifier in every language; InputError otherwise."""
    letters = re.fullmatch(r"[a-z][a-z0-9_]*", name, re.ASCII)
    reserved = keyword.iskeyword(name) or name in RESERVED_WORDS
    if not letters or len(name) > LONGEST_NAME or reserved:
        allowed = (
            "a file name that is also an identifier: a lower-case letter, then letters, "
            f"digits and underscores, at most {LONGEST_NAME}, no reserved word"
        )
        raise InputError("path", name, allowed, "rename the file")
    return name


def _orders(torus: Torus) -> dict[str, str]:
    """Orders and amplitudes of a torus that has them."""
    if not comes_from(torus, FromSeries):
        return {}
    digits = torus.digits or DOUBLE_DIGITS
    amplitudes = [f"A_{q} = {text(a, digits)}" for q, a in torus.amplitudes.items()]
    return {
        "orders": f"frequencies {torus.origin.frequency_order}, coordinates {torus.origin.order}",
        "amplitudes": ", ".join(amplitudes),
    }

"""A torus as fast functions at once: compiled C where there is a compiler, else NumPy."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from numbers import Real
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symfpu.codegen.languages.c import C
from symfpu.codegen.torus_program import torus_facts, torus_program
from symfpu.errors import InputError, SymfpuError
from symfpu.numbers.arithmetic import DOUBLES
from symfpu.numbers.public import public
from symfpu.series.series import LindstedtSeries
from symfpu.tori.torus import Torus, require_fixed_solution

Floats = NDArray[np.float64]
Angles = Floats | None  # (s,), or those of the torus
Call = Callable[[Floats, Angles], Floats]
Phases = Mapping[int, float] | ArrayLike | None  # by seed, or in the order of the seeds

BACKENDS = ("c", "numpy")
COMPILERS = ("cc", "gcc", "clang")
FLAGS = ("-std=c99", "-O2", "-march=native", "-shared", "-fPIC")
NAME = "torus"
COMPILER_SEARCH = f"$CC is not set and none of {', '.join(COMPILERS)} is in PATH"
NO_COMPILER = f"no C compiler: {COMPILER_SEARCH}; install one or take 'numpy'"


class Backend(Protocol):
    """Functions of times (T,) and phases (s,) or None for the torus' own."""

    def Q(self, t: Floats, phases: Angles) -> Floats: ...
    def P(self, t: Floats, phases: Angles) -> Floats: ...
    def harmonic_energies(self, t: Floats, phases: Angles) -> Floats: ...
    def energy(self, t: Floats, phases: Angles) -> Floats: ...


@public
@dataclass(frozen=True, eq=False)
class Evaluator:
    """A torus to be evaluated in doubles at many times.

    Made by `compile_evaluator`; gives Q_q(t), P_q(t), E_q(t) and H of Eqs. qser, harmonicene,
    fpuham2.

    torus : what it was made of. backend : 'c' or 'numpy'. functions : of the backend.

    In its methods t is a number or an array (T,), dimensionless; phases is an angle in radians
    for each seed, a mapping by seed or an array (s,) in the order of torus.seeds; seeds left out
    of a mapping, and None, keep the phases of the torus. They raise InputError for others.

    >>> from symfpu import Chain, lindstedt, solve_amplitudes
    >>> torus = solve_amplitudes(lindstedt(Chain(N=8, alpha="0.3"), (1,), ("0.3905",), 4))
    >>> compile_evaluator(torus, backend="numpy")
    Evaluator(Chain(N=8, alpha=0.3), seeds=1, 6 harmonics, backend='numpy')
    """

    torus: Torus = field(repr=False)
    backend: str
    functions: Backend = field(repr=False)

    def __repr__(self) -> str:
        chain = repr(self.torus.chain)
        seeds = ",".join(map(str, self.torus.seeds))
        harmonics = f"{len(self.torus.harmonics)} harmonics"
        return f"Evaluator({chain}, seeds={seeds}, {harmonics}, backend={self.backend!r})"

    def Q(self, t: ArrayLike, phases: Phases = None) -> Floats:
        """Mode coordinates Q_q(t); (N-1,) for a number, (T, N-1) for an array."""
        return self._at(t, phases, self.functions.Q)

    def P(self, t: ArrayLike, phases: Phases = None) -> Floats:
        """Mode momenta P_q(t), in the shapes of Q."""
        return self._at(t, phases, self.functions.P)

    def harmonic_energies(self, t: ArrayLike = 0.0, phases: Phases = None) -> Floats:
        """Harmonic energies E_q(t) (Eq. harmonicene).

        Shape (N-1,) for a number, (T, N-1) for an array.
        """
        return self._at(t, phases, self.functions.harmonic_energies)

    def energy(self, t: ArrayLike = 0.0, phases: Phases = None) -> Any:
        """Total energy H; a number, or (T,) for an array."""
        return self._at(t, phases, self.functions.energy)

    def _at(self, t: ArrayLike, phases: Phases, function: Call) -> Floats:
        allowed = "a finite number or a one-dimensional array of them"
        times = _finite("t", t, allowed)
        if times.ndim > 1:
            raise InputError("t", t, allowed, "flatten it")
        flat = np.ascontiguousarray(times.reshape(-1))
        values = function(flat, self._angles(phases))
        result: Floats = values[0] if times.ndim == 0 else values
        return result

    def _angles(self, phases: Phases) -> Angles:
        if phases is None:
            return None
        seeds = self.torus.seeds
        names = ", ".join(map(str, seeds))
        allowed = f"{len(seeds)} finite angles, of the seeds {names}"
        if isinstance(phases, Mapping):
            if set(phases) - set(seeds):
                raise InputError("phases", phases, allowed, "name seeds only")
            given = {**self.torus.phases, **phases}
            phases = [_double(given[q]) for q in seeds]
        angles = _finite("phases", phases, allowed)
        if angles.shape != (len(seeds),):
            raise InputError("phases", phases, allowed, "give one for each seed")
        return np.ascontiguousarray(angles)


def _double(value: Any) -> Any:
    """A real number as a double; anything else as it is."""
    return float(value) if isinstance(value, Real) else value


def _finite(argument: str, values: Any, allowed: str) -> Floats:
    try:
        array = DOUBLES.array(values)
    except (TypeError, ValueError) as error:
        raise InputError(argument, values, allowed, "pass real numbers") from error
    if not np.isfinite(array).all():
        raise InputError(argument, values, allowed, "leave out infinities and NaN")
    return array


@public
def compile_evaluator(torus: Torus, *, backend: str | None = None) -> Evaluator:
    """The torus as fast functions of time and phases, in doubles.

    torus : any quasi-periodic solution with numbers for amplitudes (Eqs. qser, serabs1);
        dimensionless, phases in radians.
    backend : 'c' writes C99, compiles it by $CC or the first of cc, gcc, clang in PATH, and loads
        it; 'numpy' needs no compiler; None takes 'c' if there is a compiler. The C functions keep
        the digits of omega t at any t; NumPy rounds omega t.

    Raises InputError for an unknown backend and for a series without amplitudes; SymfpuError if
    'c' finds no compiler, or with the compiler's first line if it fails.

    >>> from symfpu.chain.chain import Chain
    >>> from symfpu.tori.torus import Torus
    >>> from fractions import Fraction
    >>> cosines = np.array([[1.0, 0.0, 0.0]])
    >>> chain, omega, harmonics = Chain(4, alpha=1), Fraction(1, 2), np.array([[1]])
    >>> mode = Torus(chain, (1,), (omega,), harmonics, cosines, {1: 0.0})
    >>> functions = compile_evaluator(mode, backend="numpy")
    >>> functions.P(0.0, phases={1: 1.5707963267948966}).tolist()
    [-0.5, 0.0, 0.0]
    """
    if isinstance(torus, LindstedtSeries):
        advice = "call solve_amplitudes(series) first, or export the series"
        raise InputError("torus", "a series without amplitudes", "a torus", advice)
    require_fixed_solution(torus, "torus")
    if backend is not None and backend not in BACKENDS:
        allowed = f"one of {', '.join(BACKENDS)}, or None"
        raise InputError("backend", backend, allowed, "name a backend or leave it out")
    compiler = None if backend == "numpy" else find_compiler()
    if backend == "c" and compiler is None:
        raise SymfpuError(NO_COMPILER)
    if compiler is None:
        doubles = torus.in_doubles()
        return Evaluator(torus, "numpy", NumpyFunctions(doubles))
    source = C.torus(torus_program(torus, NAME, torus_facts(torus)))
    functions = compiled(source, torus.chain.N - 1, compiler)
    return Evaluator(torus, "c", functions)


def compiled(
    source: str,
    modes: int,
    compiler: list[str] | None = None,
) -> CompiledFunctions:
    """The functions of an exported C file; SymfpuError without a compiler, or if it fails."""
    command = compiler or find_compiler()
    if command is None:
        raise SymfpuError(NO_COMPILER)
    return CompiledFunctions(source, modes, _library(source, command))


def find_compiler() -> list[str] | None:
    """The command of a C compiler; None if there is none.

    It is $CC if that is set, else what PATH has of cc, gcc and clang.
    """
    if command := os.environ.get("CC", "").split():
        return command
    for name in COMPILERS:
        if path := shutil.which(name):
            return [path]
    return None


def _library(source: str, compiler: list[str]) -> ctypes.CDLL:
    """The loaded functions; their files are gone when this returns."""
    with tempfile.TemporaryDirectory(
        prefix="symfpu-", ignore_cleanup_errors=True
    ) as folder:
        written = Path(folder, f"{NAME}.c")
        library = Path(folder, f"{NAME}.so")
        try:
            written.write_text(source, encoding="ascii")
        except OSError as error:
            advice = "make room there, or set TMPDIR to another folder"
            raise SymfpuError(f"{written}: {error.strerror}; {advice}") from error
        files = ["-o", str(library), str(written), "-lm"]
        _run([*compiler, *FLAGS, *files])
        return ctypes.CDLL(str(library))


def _run(command: list[str]) -> None:
    """Run a compiler; SymfpuError if it does not start, or fails."""
    compiler = f"the C compiler {command[0]}"
    advice = "set CC or take 'numpy'"
    try:
        run = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603
    except OSError as error:
        raise SymfpuError(
            f"{compiler} does not start: {error.strerror}; {advice}"
        ) from error
    if run.returncode:
        said = run.stderr.strip() or f"exit status {run.returncode}"
        first = said.splitlines()[0]
        raise SymfpuError(f"{compiler} failed: {first}; {advice}")


@dataclass(frozen=True, eq=False)
class CompiledFunctions:
    """The functions of an exported C file, loaded.

    source : the file, which is pickled. modes : N-1.
    """

    source: str
    modes: int
    library: ctypes.CDLL

    def __reduce__(self) -> tuple[Any, ...]:
        """Compiled again where it arrives, for the processor there."""
        return compiled, (self.source, self.modes)

    def __deepcopy__(self, memo: dict[int, Any]) -> CompiledFunctions:
        """Itself: loaded functions do not change."""
        return self

    def Q(self, t: Floats, phases: Angles) -> Floats:
        return self._call("positions", t, phases, self.modes)

    def P(self, t: Floats, phases: Angles) -> Floats:
        return self._call("momenta", t, phases, self.modes)

    def harmonic_energies(self, t: Floats, phases: Angles) -> Floats:
        return self._call("harmonic_energies", t, phases, self.modes)

    def energy(self, t: Floats, phases: Angles) -> Floats:
        return self._call("energy", t, phases)

    def _call(self, name: str, t: Floats, phases: Angles, *columns: int) -> Floats:
        function = getattr(self.library, f"{NAME}_{name}")
        function.restype = None
        values = np.empty((len(t), *columns))
        count = ctypes.c_size_t(len(t))
        function(count, _pointer(t), _pointer(phases), _pointer(values))
        return values


def _pointer(values: Floats | None) -> ctypes.c_void_p | None:
    return None if values is None else ctypes.c_void_p(values.ctypes.data)


@dataclass(frozen=True, eq=False)
class NumpyFunctions:
    """The torus in doubles, evaluated by matrix products."""

    torus: Torus

    def Q(self, t: Floats, phases: Angles) -> Floats:
        return self._with(phases).Q(t)

    def P(self, t: Floats, phases: Angles) -> Floats:
        return self._with(phases).P(t)

    def harmonic_energies(self, t: Floats, phases: Angles) -> Floats:
        return self._with(phases).harmonic_energies(t)

    def energy(self, t: Floats, phases: Angles) -> Floats:
        return np.asarray(self._with(phases).energy(t))

    def _with(self, phases: Angles) -> Torus:
        if phases is None:
            return self.torus
        by_seed = zip(self.torus.seeds, phases.tolist(), strict=True)
        return replace(self.torus, phases=dict(by_seed))

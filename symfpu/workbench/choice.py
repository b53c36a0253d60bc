"""What was chosen on the page, as a frozen record; what follows from it is in symfpu.workbench.

Everything is kept as it was typed: what is wrong with it is said when it is used.
"""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Any

from symfpu.chain.chain import Chain
from symfpu.errors import InputError
from symfpu.numbers.typed import decimal, exact

FREQUENCIES, AMPLITUDES, ENERGY = "frequencies", "amplitudes", "energy"
GIVEN = (FREQUENCIES, AMPLITUDES, ENERGY)
LONGEST_LINE = 88  # of Python; longer calls have one argument a line


@dataclass(frozen=True)
class Choice:
    """A torus as it was chosen, all numbers as typed.

    N, alpha, beta, potential, ends : the chain, as on the command line; potential "" where it
        is alpha and beta. seeds : such as "1,2".
    given : what is chosen of the torus, one of GIVEN. values : one for each seed: its frequency,
        its amplitude, or its share of the energy. energy : H, where it is chosen.
    order : of the series. refined : whether Newton's method goes on from the series.
    bundle : the file that the torus is from, "" for none; then the others only describe it.

    >>> print(Choice(N="8", seeds="1", values=("0.3903",)).command())
    symfpu solve -N 8 --alpha 0.33 --seeds=1 --omega 0.3903 --order 8
    """

    N: str = "32"
    alpha: str = "0.33"
    beta: str = "0"
    potential: str = ""
    ends: str = "fixed"
    seeds: str = "1,2"
    given: str = FREQUENCIES
    values: tuple[str, ...] = ("0.09816", "0.19607")
    energy: str = "0.001"
    order: str = "8"
    refined: bool = False
    bundle: str = ""

    @property
    def chain(self) -> Chain:
        """The chain; raises InputError."""
        law: dict[str, Any] = {"alpha": self.alpha or "0", "beta": self.beta or "0"}
        if self.potential.strip():
            law = {"potential": self.potential.strip()}
        return Chain(whole("N", self.N), **law, ends=self.ends)

    @property
    def seed_modes(self) -> tuple[int, ...]:
        """The seeds as typed, distinct modes of the chain; raises InputError."""
        parts = [part for part in self.seeds.split(",") if part.strip()]
        if not parts:
            raise InputError("seeds", self.seeds, "modes such as 1,2", "name one at least")
        return self.chain.seeds_of([whole("seeds", part) for part in parts])

    @property
    def last_order(self) -> int:
        """The order of the series; raises InputError."""
        return whole("order", self.order)

    @property
    def by_seed(self) -> dict[int, str]:
        """The values by seed; raises InputError where there are others."""
        seeds = self.seed_modes
        if len(self.values) != len(seeds):
            allowed = f"{len(seeds)} numbers, one for each seed"
            raise InputError(self.given, ", ".join(self.values), allowed, "type them all")
        for q, value in zip(seeds, self.values, strict=True):
            exact(value, f"{self.given}, seed {q}")
        return dict(zip(seeds, self.values, strict=True))

    def python(self) -> str:
        """The lines of Python that make the same torus, and judge it."""
        if self.bundle:
            return "\n".join([*self._loading(), *self._refining()]) + "\n"
        self.require_known()
        names, making = MAKING[self.chain.periodic, self.given](self)
        refining = self._refining()
        names = [*names, *(["refine"] if refining else [])]
        imports = [f"from symfpu import {', '.join(sorted(names))}"]
        if any("symfpu." in line for line in making):
            imports = ["import symfpu", *imports]
        lines = [*imports, "", f"chain = {self.chain_text}", *making, *refining]
        return "\n".join(lines) + "\n"

    @property
    def chain_text(self) -> str:
        """The call that makes the chain; raises InputError."""
        law = {name: f'"{text}"' for name, text in self.chain.typed_law.items()}
        shown = {name: text for name, text in law.items() if text != '"0"'}
        if self.chain.periodic:
            shown["ends"] = '"periodic"'
        return call("Chain", f"N={self.chain.N}", **shown)

    def require_known(self) -> None:
        """InputError for what the package does not solve: amplitudes or an energy of a ring."""
        if self.chain.periodic and self.given != FREQUENCIES:
            allowed = f"{FREQUENCIES}, which alone lead to the waves of a ring"
            advice = "choose these, or fixed ends"
            raise InputError("given", f"{self.given} of a ring", allowed, advice)

    def _loading(self) -> list[str]:
        names = "load, refine" if self.refined else "load"
        held = f'load("{Path(self.bundle).name}")'
        return [f"from symfpu import {names}", "", f"torus = {held}"]

    def _refining(self) -> list[str]:
        return ["refined = refine(torus)"] if self.refined else []

    def command(self, frequencies: Mapping[int, Fraction] | None = None) -> str:
        """The command line that makes the same torus.

        frequencies : those that were found, where others were chosen; before that "".
        """
        if self.bundle:
            return f"symfpu show {shlex.quote(Path(self.bundle).name)}"
        typed = dict(self.by_seed)
        if self.given != FREQUENCIES:
            if frequencies is None:
                return ""
            typed = {q: decimal(w) for q, w in frequencies.items()}
        chain = self.chain
        law = [
            word
            for name, text in chain.typed_law.items()
            if text != "0"
            for word in (f"--{name}", text)
        ]
        ends = ["--ends", chain.ends] if chain.periodic else []
        seeds = ",".join(map(str, typed))
        words = ["symfpu", "solve", "-N", str(chain.N), *law, *ends, f"--seeds={seeds}"]
        words += ["--omega", ",".join(typed.values()), "--order", str(self.last_order)]
        return shlex.join(words)

    def changed(self, **changes: Any) -> Choice:
        """Another choice: what came from a file or from Newton's method is left behind."""
        return replace(self, **{"refined": False, "bundle": "", **changes})


def whole(argument: str, text: str) -> int:
    """A whole number as typed; InputError naming the argument otherwise."""
    try:
        return int(text)
    except ValueError as error:
        raise InputError(argument, text, "a whole number", "type digits only") from error


def call(function: str, *arguments: str, **named: str) -> str:
    """A call in Python; on several lines where it is long."""
    listed = [*arguments, *(f"{name}={text}" for name, text in named.items())]
    line = f"{function}({', '.join(listed)})"
    if len(line) <= LONGEST_LINE:
        return line
    rows = "".join(f"    {argument},\n" for argument in listed)
    return f"{function}(\n{rows})"


def _tuple(texts: Mapping[int, str]) -> str:
    listed = [f'"{text}"' for text in texts.values()]
    return f"({', '.join(listed)}{',' if len(listed) == 1 else ''})"


def _mapping(texts: Mapping[int, str]) -> str:
    return "{" + ", ".join(f'{q}: "{text}"' for q, text in texts.items()) + "}"


Making = tuple[list[str], list[str]]  # names that are imported, and lines


def _by_frequencies(choice: Choice) -> Making:
    typed = choice.by_seed
    seeds = repr(tuple(typed))
    order = str(choice.last_order)
    making = call("lindstedt", "chain", seeds=seeds, frequencies=_tuple(typed), order=order)
    lines = [f"series = {making}", "torus = solve_amplitudes(series)"]
    names = ["Chain", "assess", "lindstedt", "solve_amplitudes"]
    return names, [*lines, "verdict = assess(series, torus)"]


def _by_amplitudes(choice: Choice) -> Making:
    typed = choice.by_seed
    return _of_series(choice, "amplitudes", _mapping(typed), tuple(typed))


def _by_energy(choice: Choice) -> Making:
    typed = choice.by_seed
    exact(choice.energy, "energy")
    ratio = f"energy_ratio={_mapping(typed)}"
    energy = f'symfpu.Energy("{choice.energy}", {ratio})'
    return _of_series(choice, "energy", energy, tuple(typed))


def _of_series(choice: Choice, name: str, given: str, seeds: tuple[int, ...]) -> Making:
    """The torus of a series with what is given."""
    how = {name: given, "method": '"series"', "order": str(choice.last_order)}
    making = call("symfpu.torus", "chain", repr(seeds), **how)
    lines = [f"torus = {making}", "verdict = assess(torus.origin.series, torus)"]
    return ["Chain", "assess"], lines


MAKING = {
    (False, FREQUENCIES): _by_frequencies,
    (False, AMPLITUDES): _by_amplitudes,
    (False, ENERGY): _by_energy,
    (True, FREQUENCIES): _by_frequencies,
}

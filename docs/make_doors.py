"""Writes the table of docs/chains.md: which public function serves which chain, by calling each of them.

    python docs/make_doors.py

A door is called once for every chain, in a small case. It answers "yes"; or it refuses by an InputError that names the chain, its
potential, its model or its ends; anything else ends this program. Doors that take a series or a solution refuse where there is none.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import redirect_stderr, redirect_stdout
from functools import cached_property
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np

import symfpu
from symfpu import Chain, InputError
from symfpu.cli.main import main as command
from symfpu.dynamics.schemes import SCHEMES
from symfpu.families.appendix_a import appendix_a

PAGE = Path(__file__).parent / "chains.md"
BEGIN = "<!-- doors: written by docs/make_doors.py; do not edit -->\n"
END = "<!-- end of doors -->\n"
N = 8
SEEDS = (1, 2)


class Case:
    """A chain, what can be made of it, and a folder for files. size : of amplitudes, far from harmonic."""

    def __init__(self, folder: Path, size: float = 0.1, **law: Any) -> None:
        self.law, self.size = law, size
        self.chain = Chain(N, **law)
        self.amplitudes = {1: size, 2: size / 2}
        self.folder = folder

    @cached_property
    def state(self) -> tuple[Any, Any]:
        x = np.zeros(len(self.chain.positions(np.zeros(N - 1))))
        x[0], x[1] = self.size, -self.size
        Q = self.chain.modes(x)
        return Q, 0 * Q

    @property
    def state_file(self) -> Path:
        """The state of the particles in columns."""
        path = self.folder / "state.txt"
        np.savetxt(path, np.transpose([self.chain.positions(part) for part in self.state]))
        return path

    @cached_property
    def torus(self) -> Any:
        return symfpu.torus(
            self.chain,
            tuple(self.amplitudes),
            amplitudes=self.amplitudes,
            method="series",
            order=4,
        )

    @cached_property
    def series(self) -> Any:
        if self.chain.periodic:
            return self.waves
        return self.lindstedt(SEEDS, self.torus.frequencies, 4)

    @cached_property
    def solved(self) -> Any:
        return symfpu.solve_amplitudes(self.series)

    @cached_property
    def symbolic(self) -> Any:
        return self.lindstedt(SEEDS, order=2)

    @cached_property
    def for_all_lengths(self) -> Any:
        return symfpu.lindstedt(Chain("N", **self.law), (1,), order=2)

    @cached_property
    def refined(self) -> Any:
        return symfpu.refine(self.solution)

    @cached_property
    def breather(self) -> Any:
        return symfpu.torus(self.chain, (1,), amplitudes={1: self.size})

    @property
    def periodic(self) -> Any:
        """A breather of its own kind."""
        return self.wave if self.chain.periodic else self.breather

    @cached_property
    def wave(self) -> Any:
        return symfpu.torus(self.chain, (1,), amplitudes={1: self.size})

    @cached_property
    def orbit(self) -> Any:
        return symfpu.integrate(self.chain, *self.state, 20.0, step=0.1, averages=True)

    @cached_property
    def lines(self) -> Any:
        orbit = symfpu.integrate(self.chain, *self.state, 200.0, step=0.1, samples=2)
        return symfpu.frequency_analysis(orbit)

    @cached_property
    def waves(self) -> Any:
        frequencies = self.chain.frequencies()[
            [self.chain.mode_numbers.index(q) for q in SEEDS]
        ]
        shift = 1e-4 if self.chain.potential.even else 1e-5
        return self.lindstedt(SEEDS, list(frequencies * (1 + shift)), 3)

    @property
    def solution(self) -> Any:
        """A torus of its own kind."""
        ring = self.chain.periodic
        return symfpu.solve_amplitudes(self.waves) if ring else self.of(lambda: self.torus)

    @cached_property
    def family(self) -> Any:
        return symfpu.family(self.chain, (1,), 1e-2 * self.size**2, members=4)

    def of(self, make: Callable[[], Any]) -> Any:
        """What a door takes; where a chain has none, its series says why."""
        self.lindstedt()
        return make()

    def lindstedt(
        self, seeds: Any = (1,), frequencies: Any = None, order: int = 1, **how: Any
    ) -> Any:
        return symfpu.lindstedt(self.chain, seeds, frequencies, order, **how)

    def atlas(self) -> None:
        """One column, whose failure is a row."""
        with ThreadPoolExecutor(1) as pool:
            how = {"borders": (), "places": (1e-2 * self.size**2,), "executor": pool}
            found = symfpu.atlas([self.chain], ["low:1"], 2, **how)
        for row in found.rows.failures:
            if row.failure.kind != "InputError":
                raise SystemExit(f"atlas of {self.chain}: {row.failure}")
            raise InputError("atlas", row.failure.message, "", "")

    @property
    def rule(self) -> dict[str, Any]:
        """The law for functions that take N and not a chain."""
        ends = {"ends": "periodic"} if self.chain.periodic else {}
        return {"potential": self.chain.potential, **ends}

    @property
    def words(self) -> list[str]:
        """The law on the command line."""
        entries = {"ends": "periodic"} if self.chain.periodic else {}
        entries |= {
            name: value for name, value in self.chain.typed_law.items() if value != "0"
        }
        return [word for entry in entries.items() for word in (f"--{entry[0]}", entry[1])]

    @property
    def rule_words(self) -> list[str]:
        """The same for verbs that name the paper's chains as models."""
        if not self.chain.fpu:
            return self.words
        ends = ["--ends", "periodic"] if self.chain.periodic else []
        return ["--model", self.chain.model, *ends]

    def proved(self) -> None:
        """A certificate written, and checked."""
        path = self.folder / "certificate.json"
        self.verb(
            "prove", "-N", N, "--seeds", "1,2", "--order", 2, *self.rule_words, "-o", path
        )
        self.verb("verify", path)

    def verb(self, name: str, *words: Any) -> None:
        """One verb of the command line; InputError with what it says where an argument is wrong."""
        said, complaint = StringIO(), StringIO()
        with redirect_stdout(said), redirect_stderr(complaint):
            code = command([name, *map(str, words)])
        if code == 2:
            raise InputError(name, complaint.getvalue(), "", "")
        if code:
            raise SystemExit(
                f"symfpu {name} ends with {code} for {self.chain}: {complaint.getvalue()}"
            )

    @cached_property
    def refined_file(self) -> Path:
        """A saved breather."""
        return Path(symfpu.save(self.folder / "breather.symfpu", self.breather))

    @cached_property
    def periodic_file(self) -> Path:
        """A saved breather of its own kind."""
        return Path(symfpu.save(self.folder / "periodic.symfpu", self.periodic))

    @cached_property
    def file(self) -> Path:
        """A saved torus, by the command line."""
        path = self.folder / "solved.symfpu"
        self.verb(
            "solve",
            "-N",
            N,
            "--seeds",
            1,
            "--omega",
            float(self.omega),
            "--order",
            3,
            *self.words,
            "-o",
            path,
        )
        return path

    @cached_property
    def omega(self) -> Any:
        """A frequency of a breather, or of one wave of a ring."""
        if self.chain.periodic:
            place = self.chain.mode_numbers.index(1)
            return self.chain.frequencies()[place] * 1.0005
        return self.breather.frequency


CHAINS: dict[str, dict[str, Any]] = {
    "alpha": {"alpha": "0.3"},
    "beta": {"beta": "0.3"},
    "alpha+beta": {"alpha": "0.3", "beta": "0.2"},
    "polynomial": {"potential": "poly:1/3,0,1/5"},
    "toda": {"potential": "toda:1/2"},
    "lennard_jones": {"potential": "lj:12,6", "size": 0.01},
    "morse": {"potential": "morse:1/2"},
    "from_expression": {"potential": "expr:cosh(r)-1"},
    "ring": {"alpha": "0.3", "ends": "periodic"},
}

Door = Callable[[Case], Any]
METHODS: dict[str, Door] = {
    "Chain.accelerations": lambda c: c.chain.accelerations(c.state[0]),
    "Chain.energy": lambda c: c.chain.energy(*c.state),
    "Chain.equations_of_motion": lambda c: Chain(4, **c.law).equations_of_motion(),
    "Chain.hamiltonian": lambda c: Chain(4, **c.law).hamiltonian(),
    "Chain.harmonic_energies": lambda c: c.chain.harmonic_energies(*c.state),
}
SERIES: dict[str, Door] = {
    "amplitude_history": lambda c: symfpu.amplitude_history(c.series),
    "assess": lambda c: symfpu.assess(c.series, c.solved),
    "birkhoff_form": lambda c: symfpu.birkhoff_form(c.chain, SEEDS, 2),
    "closed_form": lambda c: symfpu.closed_form(c.symbolic.term(3, 2), c.chain, SEEDS),
    "expandable_term": lambda c: symfpu.expandable_term(c.symbolic, 3, 2),
    "frequency_expansion": lambda c: symfpu.frequency_expansion(c.chain, SEEDS, 1, 2),
    "frequency_shift": lambda c: symfpu.frequency_shift(c.chain, c.amplitudes),
    "frequency_shift_formula": lambda c: symfpu.frequency_shift_formula(c.chain, SEEDS),
    "lindstedt": lambda c: c.series,
    "lindstedt, digits=30": lambda c: c.lindstedt(
        (1,), c.torus.frequencies[:1], 3, digits=30
    ),
    "lindstedt, no frequencies": lambda c: c.symbolic,
    "lindstedt, N='N'": lambda c: c.for_all_lengths,
    "lindstedt, ring='nested'": lambda c: c.lindstedt((1,), order=2, ring="nested"),
    "normal_frequency_series": lambda c: symfpu.normal_frequency_series(
        c.chain, (1,), 3, 2, {1: "0.6", 3: "1.6"}
    ),
    "normal_frequency_series, no frequencies": lambda c: symfpu.normal_frequency_series(
        c.chain, SEEDS, 4, 2
    ),
    "pade_amplitudes": lambda c: symfpu.pade_amplitudes(c.series, c.solution.amplitudes),
    "pade_frequencies": lambda c: symfpu.pade_frequencies(c.series, c.amplitudes),
    "pade_poles": lambda c: symfpu.pade_poles(c.series, 1, c.amplitudes),
    "resum": lambda c: symfpu.resum(c.of(lambda: c.torus)),
    "same_series": lambda c: symfpu.same_series(c.symbolic, c.symbolic),
    "sample_series": lambda c: symfpu.sample_series(c.symbolic, [c.torus.frequencies]),
    "series_bytes": lambda c: symfpu.series_bytes(c.chain, SEEDS, 4),
    "solve_amplitudes": lambda c: c.solved,
    "solve_amplitudes, digits=30": lambda c: symfpu.solve_amplitudes(
        c.lindstedt((1,), c.breather.frequencies, 4, digits=30)
    ),
    "torus, method=series": lambda c: symfpu.torus(
        c.chain, SEEDS, energy=c.size**2 / 20, method="series", order=4
    ),
    "unfold": lambda c: symfpu.unfold(c.of(lambda: c.torus)),
}
NEWTON: dict[str, Door] = {
    "actions": lambda c: symfpu.actions(c.solution),
    "appendix_a": lambda c: appendix_a(c.chain, SEEDS, c.amplitudes, 3, members=2),
    "atlas": lambda c: c.atlas(),
    "torus": lambda c: c.breather,
    "torus of an energy": lambda c: symfpu.torus(c.chain, SEEDS, energy=c.size**2 / 20),
    "family": lambda c: c.family,
    "family, folder=": lambda c: symfpu.family(
        c.chain, (1,), 1e-2 * c.size**2, members=2, folder=c.folder / "family"
    ),
    "floquet": lambda c: symfpu.floquet(c.periodic),
    "foretold_indices": lambda c: symfpu.foretold_indices(c.periodic, 1e4, vectors=2),
    "prove_existence": lambda c: symfpu.prove_existence(c.periodic),
    "prove_stability": lambda c: symfpu.prove_stability(c.periodic),
    "prove_residual": lambda c: symfpu.prove_residual(c.solution),
    "prove_stay": lambda c: symfpu.prove_stay(c.refined, time=1),
    "normal_family": lambda c: symfpu.normal_family(
        c.periodic, {1: 1.1 * c.size}, members=2, modes=[2], resonance_length=0
    ),
    "normal_modes": lambda c: symfpu.normal_modes(c.periodic),
    "solve_normal_frequency": lambda c: symfpu.solve_normal_frequency(c.periodic, 2, 2),
    "member_at_energy": lambda c: symfpu.member_at_energy(
        c.family, c.family.members[1].torus.energy(), harmonic=False
    ),
    "member_at_frequency": lambda c: symfpu.member_at_frequency(
        c.family, 1, c.family.members[1].torus.frequency
    ),
    "refine": lambda c: c.refined,
    "refine, digits": lambda c: symfpu.refine(c.refined, digits=25),
    "twist": lambda c: symfpu.twist(c.periodic),
    "twist_at_rest": lambda c: symfpu.twist_at_rest(c.chain, SEEDS),
}
DYNAMICS: dict[str, Door] = {
    "alignment_indices": lambda c: symfpu.alignment_indices(
        c.chain, *c.state, 100.0, vectors=2, frames=1
    ),
    "frequency_analysis": lambda c: c.lines,
    "frequency_map": lambda c: symfpu.frequency_map(
        c.chain, (float(c.chain.energy(*c.state)),), T=200.0, step=0.1
    ),
    **{
        f"integrate, {name}": lambda c, name=name: symfpu.integrate(
            c.chain, *c.state, 5.0, step=0.1, scheme=name
        )
        for name in SCHEMES
    },
    "integrate, file=": lambda c: symfpu.integrate(
        c.chain, *c.state, 5.0, step=0.1, file=c.folder / "orbit"
    ),
    "packet_state": lambda c: symfpu.packet_state(c.chain, SEEDS, c.size**2 / 20),
    "torus_near": lambda c: symfpu.torus_near(c.lines),
    "particle_state": lambda c: symfpu.particle_state(
        c.chain, *map(c.chain.positions, c.state)
    ),
    "random_state": lambda c: symfpu.random_state(c.chain, c.size**2 / 20, 1),
    "read_state": lambda c: symfpu.read_state(c.chain, c.state_file),
    "seconds_needed": lambda c: symfpu.seconds_needed(c.chain, 100.0, vectors=2),
    "toda_gaps": lambda c: symfpu.toda_gaps(c.chain, *c.state, a="1/2"),
    "toda_invariants": lambda c: symfpu.toda_invariants(c.chain, *c.state, a="1/2"),
    "toda_torus": lambda c: symfpu.toda_torus(
        c.chain,
        (1,),
        frequencies=[c.chain.frequencies()[c.chain.mode_numbers.index(1)] * 1.001],
        a="1/2",
    ),
}
PROFILE = np.logspace(0, -12, N - 1)
LOCALIZATION: dict[str, Door] = {
    "breather_law": lambda c: symfpu.breather_law(c.chain, 0.01),
    "coefficient_errors": lambda c: symfpu.coefficient_errors(c.of(lambda: c.refined)),
    "fit_profile": lambda c: symfpu.fit_profile(c.chain, PROFILE, 1),
    "fpu_trajectory": lambda c: symfpu.fpu_trajectory(c.chain, c.amplitudes),
    "group_energy": lambda c: symfpu.group_energy(c.chain, 2, 1e-3, 1),
    "growth_exponents": lambda c: symfpu.growth_exponents(
        c.chain,
        c.orbit.times[1:],
        c.orbit.averages[1:],
        symfpu.excitation_sequence(N, (1,), 3),
    ),
    "least_packet": lambda c: symfpu.least_packet(c.chain, 1e-3),
    "middle_modes": lambda c: symfpu.middle_modes(c.chain, 2),
    "natural_packet": lambda c: symfpu.natural_packet(c.chain, 1e-3),
    "normalised_averages": lambda c: symfpu.normalised_averages(c.orbit),
    "packet_amplitudes": lambda c: symfpu.packet_amplitudes(c.chain, SEEDS, c.size**2),
    "packet_energies": lambda c: symfpu.packet_energies(c.chain, 2, 1e-3),
    "packet_groups": lambda c: symfpu.packet_groups(c.chain, 2),
    "packet_parameter": lambda c: symfpu.packet_parameter(c.chain, 2, 1e-3),
    "profile_invariance": lambda c: symfpu.profile_invariance(
        c.chain, "1/8", 1e-2, (16, 32, 48), 1e3
    ),
    "profile_law": lambda c: symfpu.profile_law(c.chain, 2, 1e-3),
    "rounding_floor": lambda c: symfpu.rounding_floor(c.chain, PROFILE, 100.0, step=0.1),
    "slope_by_energy": lambda c: symfpu.slope_by_energy(
        c.chain, 1, [1e-3, 2e-3, 3e-3], [PROFILE] * 3
    ),
    "spectrum_floor": lambda c: symfpu.spectrum_floor(c.of(lambda: c.refined)),
}
PROOFS: dict[str, Door] = {
    "asymptotic_energy": lambda c: symfpu.asymptotic_energy(Chain("N", **c.law), SEEDS, 3),
    "asymptotic_group_energy": lambda c: symfpu.asymptotic_group_energy(
        Chain("N", **c.law), 2, 1
    ),
    "asymptotic_profile": lambda c: symfpu.asymptotic_profile(Chain("N", **c.law), 2, 1),
    "asymptotic_term": lambda c: symfpu.asymptotic_term(
        c.for_all_lengths, 3 if c.chain.potential.even else 2, 1
    ),
    "coupling_sequence": lambda c: symfpu.coupling_sequence(N, SEEDS, 2, **c.rule),
    "excitation_sequence": lambda c: symfpu.excitation_sequence(N, SEEDS, 2, **c.rule),
    "leading_term": lambda c: symfpu.leading_term(c.chain, SEEDS, 3),
    "lemma_holds": lambda c: symfpu.lemma_holds(c.chain, SEEDS, 2),
    "prove_propagation": lambda c: symfpu.prove_propagation(N, SEEDS, 2, **c.rule),
    "reachable_modes": lambda c: symfpu.reachable_modes(N, SEEDS, 2, **c.rule),
    "sweep_propagation": lambda c: symfpu.sweep_propagation(
        (4,), 1, 2, executor=ThreadPoolExecutor(1), **c.rule
    ),
}
FILES: dict[str, Door] = {
    "compile_evaluator": lambda c: symfpu.compile_evaluator(
        c.of(lambda: c.torus), backend="numpy"
    ),
    "export, a solution": lambda c: symfpu.export(
        c.of(lambda: c.torus), "numpy", c.folder / "solution.py"
    ),
    "export, a series": lambda c: symfpu.export(
        c.symbolic, "numpy", c.folder / "series.py"
    ),
    "save and load": lambda c: symfpu.load(
        symfpu.save(c.folder / "torus.symfpu", c.solution)
    ),
}
VERBS: dict[str, Door] = {
    "symfpu actions": lambda c: c.verb("actions", c.file),
    "symfpu atlas": lambda c: c.verb(
        "atlas",
        "--lengths",
        4,
        "--packets",
        "low:1",
        "--order",
        2,
        "--borders",
        "newton",
        "--places",
        1e-2 * c.size**2,
        "--reach",
        1,
        *c.words,
    ),
    "symfpu export": lambda c: c.verb(
        "export", c.file, "--lang", "numpy", "-o", c.folder / "exported.py"
    ),
    "symfpu family": lambda c: c.verb(
        "family",
        "-N",
        N,
        "--seeds",
        1,
        "--from-energy",
        5e-3 * c.size**2,
        "--to-energy",
        1e-2 * c.size**2,
        *c.words,
    ),
    "symfpu frequencies": lambda c: c.verb(
        "frequencies", c.file, "--time", 200, "--step", 0.1, "--json"
    ),
    "symfpu gali": lambda c: c.verb(
        "gali", c.file, "--time", 100, "--vectors", 2, "--json"
    ),
    "symfpu orbit": lambda c: c.verb("orbit", c.file, "--time", 5),
    "symfpu propagate": lambda c: c.verb(
        "propagate", "-N", N, "--seeds", "1,2", "--order", 2, *c.rule_words
    ),
    "symfpu prove, verify": lambda c: c.proved(),
    "symfpu refine": lambda c: c.verb("refine", c.file),
    "symfpu show": lambda c: c.verb("show", c.file),
    "symfpu solve": lambda c: c.file,
    "symfpu certify": lambda c: c.verb("certify", c.refined_file),
    "symfpu certify --stability": lambda c: c.verb(
        "certify", c.refined_file, "--stability"
    ),
    "symfpu stability": lambda c: c.verb("stability", c.periodic_file),
    "symfpu sweep": lambda c: c.verb(
        "sweep", "--order", 1, "--longest", 3, "--largest", 1, *c.rule_words
    ),
    "symfpu term": lambda c: c.verb(
        "term", "-N", N, "--seeds", 1, "-q", 2, "--order", 1, *c.words
    ),
}
DOORS = {
    "The chain": METHODS,
    "Series and their tori": SERIES,
    "Newton's method": NEWTON,
    "Dynamics": DYNAMICS,
    "Localization": LOCALIZATION,
    "Proofs": PROOFS,
    "Files and code": FILES,
    "Command line": VERBS,
}
# they take no chain, nor anything made of one
OTHERS = {
    *(
        "asymptotic_divisor",
        "cite",
        "collect_terms",
        "frequency_rank",
        "from_expression",
        "init_printing",
        "lennard_jones",
        "saved_file",
        "morse",
        "polynomial",
        "prove_for_all_N",
    ),
    *(
        "profile_distance",
        "read_atlas",
        "read_sweep",
        "recurrence",
        "substitute_multipliers",
        "toda",
    ),
}

HEAD = """
## Doors

Which public function serves which chain: each is called in a small case (N = 8). "no" is a refusal by name: one `InputError`,
whose last words are what to do instead. Columns are potentials with fixed ends (`polynomial` of degree 5, `from_expression` with
cosh r - 1) and a ring of the alpha model.

- Orbits, tangent maps, Newton's method and Floquet multipliers take the closed potential, not its Taylor series.
- The scheme `aba864_modes` multiplies polynomials of modes: it is for polynomials.
- Many digits of a torus (`refine(digits=)`) are of polynomials, and of tensions made of exponentials and powers with
  rational numbers: their Taylor series is cut where a bound of the rest is below the last place. Even ones (cosh r - 1) and other
  expressions have no such bound here.
- Laws of the energy profile and the Lemma are stated for alpha or beta alone.
- An orbit that comes to a wall of its potential (r = -1 in `lennard_jones`) by a step too long stops with time and bond named;
  no orbit starts beyond one.

"""


def answer(door: Door, case: Case) -> str:
    """Whether a door serves a chain; raises what is neither an answer nor a refusal by name."""
    try:
        door(case)
    except TypeError as error:
        # functions of N, without an argument for its ends
        if "unexpected keyword argument 'ends'" not in str(error):
            raise
        return "no"
    except InputError as refused:
        chains = case.chain, Chain(4, **case.law)
        names = (
            *map(repr, chains),
            repr(case.chain.potential),
            case.chain.potential.text,
            f"'{case.chain.model}'",
            "'periodic'",
            "--ends",
        )
        if not any(name in str(refused) for name in names):
            raise
        return "no"
    return "yes"


def table(folder: Path) -> str:
    """The section of the page; folder : for files."""
    cases = []
    for name, how in CHAINS.items():
        (folder / name).mkdir()
        cases.append(Case(folder / name, **how))
    text = BEGIN + HEAD
    for group, doors in DOORS.items():
        text += f"| {group} | {' | '.join(CHAINS)} |\n|{' --- |' * (len(CHAINS) + 1)}\n"
        for name, door in doors.items():
            row = [answer(door, case) for case in cases]
            text += f"| `{name}` | {' | '.join(row)} |\n"
        text += "\n"
    return text + END


def written(page: str, section: str) -> str:
    """The page with the section in its place, at the end if it has none."""
    before, found, rest = page.partition(BEGIN)
    after = rest.partition(END)[2] if found else ""
    return f"{before.rstrip()}\n\n{section}{after}"


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as made:
        PAGE.write_text(written(PAGE.read_text(), table(Path(made))))

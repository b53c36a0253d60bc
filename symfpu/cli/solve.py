"""The verb solve: a torus from frequencies, from an energy, or from amplitudes."""

from __future__ import annotations

import shlex
import sys
import warnings
from dataclasses import dataclass
from typing import Annotated, Any

import typer

from symfpu.breathers.floquet import Floquet, floquet
from symfpu.chain.chain import Chain
from symfpu.cli.chains import (
    AlphaOption,
    BetaOption,
    BondsOption,
    EndsOption,
    PotentialOption,
    chain_of,
)
from symfpu.cli.keeping import output_named
from symfpu.cli.pictures import PlotOption, draw, picture_named, say_drawn
from symfpu.cli.terminal import (
    HarmonicOption,
    JsonOption,
    SeedsOption,
    by_seed,
    one_of,
    optional,
    print_json,
    progress_bar,
    say,
    whole_numbers,
    width_of,
)
from symfpu.cli.tori import verdict_of
from symfpu.cli.verbs import app
from symfpu.errors import InputError
from symfpu.files.progress import NO_FRACTION, Progress
from symfpu.solutions.series import series_torus
from symfpu.solutions.torus import torus
from symfpu.store.saved_file import save
from symfpu.tori.energy import Energy
from symfpu.tori.from_series import FromSeries
from symfpu.tori.orders import Orders
from symfpu.tori.torus import Torus
from symfpu.tori.verdict import Assessment, assess

EQUAL_SHARES = "equal time averages of E_q of the seeds; --shares S,S,... for others"


@dataclass(frozen=True)
class Wish:
    """What is asked of a torus, besides its chain and seeds.

    One of frequencies (in the order of the seeds), energy and amplitudes is given; the others
    are None.
    shares : of the energy, or None for equal ones. harmonic : whether it is sum E_q.
    """

    frequencies: list[str] | None
    energy: str | None
    amplitudes: dict[int, str] | None
    shares: dict[int, str] | None
    harmonic: bool
    order: int | None
    frequency_order: int | None
    coordinate_order: int | None
    digits: int | None


@app.command(
    epilog="Example: symfpu solve -N 16 --alpha 0.33 --seeds 1,2 --energy 0.01 --order 8"
)
def solve(
    context: typer.Context,
    bonds: BondsOption,
    seeds: SeedsOption,
    omega: Annotated[
        str | None,
        typer.Option(
            help="Frequencies, one for each seed, such as 0.19626,0.39046.",
            metavar="W,W,...",
        ),
    ] = None,
    energy: Annotated[
        str | None,
        typer.Option(help="The torus of this energy H; frequencies found.", metavar="E"),
    ] = None,
    amplitudes: Annotated[
        str | None,
        typer.Option(
            help="The torus of these amplitudes; frequencies found.", metavar="A,A,..."
        ),
    ] = None,
    shares: Annotated[
        str | None,
        typer.Option(
            help="With --energy: ratio of the averaged E_q of the seeds.  Default: equal.",
            metavar="S,S,...",
        ),
    ] = None,
    harmonic: HarmonicOption = False,
    alpha: AlphaOption = "0",
    beta: BetaOption = "0",
    potential: PotentialOption = None,
    ends: EndsOption = "fixed",
    order: Annotated[
        str | None,
        typer.Option(
            help="The truncated series of this order.  Default: Newton's method.",
            metavar="K",
        ),
    ] = None,
    frequency_order: Annotated[
        str | None,
        typer.Option(
            help="Order of the frequency series that gives the amplitudes.  Default: --order.",
            metavar="K",
        ),
    ] = None,
    coordinate_order: Annotated[
        str | None,
        typer.Option(
            help="Order at which the coordinates Q(t) are cut.  Default: --order.",
            metavar="K",
        ),
    ] = None,
    digits: Annotated[
        str | None,
        typer.Option(
            help="Any number of digits, with a bound.  Default: doubles.", metavar="D"
        ),
    ] = None,
    multipliers: Annotated[
        bool, typer.Option("--multipliers", help="Floquet multipliers of a breather.")
    ] = False,
    output: Annotated[
        str | None,
        typer.Option(
            "-o",
            "--output",
            help="Keep series, torus and verdict in this file.",
            metavar="FILE",
        ),
    ] = None,
    plot: PlotOption = None,
    as_json: JsonOption = False,
) -> None:
    """The q-torus of exactly one of --omega, --energy and --amplitudes.

    It solves the equations of motion to rounding; one seed: a breather. With --order it is the
    truncated series of the paper, with a verdict.
    """
    chain = chain_of(bonds, alpha, beta, potential, ends)
    chosen = tuple(whole_numbers("seeds", seeds))
    given = {"omega": omega, "energy": energy, "amplitudes": amplitudes}
    one_of(given)
    _refuse_without_energy(energy, shares, harmonic)
    wish = Wish(
        frequencies=None if omega is None else omega.split(","),
        energy=energy,
        amplitudes=None
        if amplitudes is None
        else by_seed("amplitudes", amplitudes, chosen),
        shares=None if shares is None else by_seed("shares", shares, chosen),
        harmonic=harmonic,
        order=optional("order", order),
        frequency_order=optional("frequency-order", frequency_order),
        coordinate_order=optional("coordinate-order", coordinate_order),
        digits=optional("digits", digits),
    )
    if wish.order is None:
        _refuse_cuts(wish)
        how = {"multipliers": multipliers, "as_json": as_json}
        _by_newton(context, chain, chosen, wish, (output, plot), **how)
        return
    if multipliers:
        allowed = "none with --order, which gives a truncated series"
        raise InputError("multipliers", True, allowed, "leave out --order")
    file = output_named(output)
    picture = picture_named(plot)
    with progress_bar("series") as advance:
        found, assessment, record = _found(chain, chosen, wish, advance)
        if file:
            advance("writing", NO_FRACTION)
            save(
                file,
                found,
                verdict=assessment.record(),
                command=shlex.join(["symfpu", *context.obj]),
            )
        draw(found.plot, picture)
    if as_json:
        print_json(record)
        return
    say(f"verdict: {assessment.verdict}")
    say(found.text())
    if "energy_shares" in record:
        say(f"energy shared      {_shares_text(wish)}")
    say(assessment.text(width_of(sys.stdout)))
    if assessment.word != "converged":
        say("without --order: the torus itself, by Newton's method")
    if file:
        print(f"written: {file}")
    say_drawn(picture)


def _by_newton(
    context: typer.Context,
    chain: Chain,
    seeds: tuple[int, ...],
    wish: Wish,
    files: tuple[str | None, str | None],
    *,
    multipliers: bool,
    as_json: bool,
) -> None:
    """The torus that solves the equations of motion, printed and kept, with multipliers.

    files : of --output and --plot.
    """
    file, picture = output_named(files[0]), picture_named(files[1])
    with progress_bar("Newton's method") as advance:
        with warnings.catch_warnings(record=True) as several:
            warnings.simplefilter("always", UserWarning)
            found = torus(
                chain, seeds, **_asked(wish), digits=wish.digits, progress=advance
            )
        doubts = tuple(str(w.message) for w in several if w.category is UserWarning)
        if multipliers:
            advance("multipliers", NO_FRACTION)
        stability = floquet(found) if multipliers else None
        if file:
            verdict = verdict_of(found)
            verdict["reasons"] += doubts
            command = shlex.join(["symfpu", *context.obj])
            save(file, found, verdict=verdict, command=command)
        draw(found.plot, picture)
    if as_json:
        print_json(_record(found, doubts, stability))
        return
    say(found.text())
    if stability is not None:
        say(stability.multiplier_line)
    for doubt in doubts:
        say(f"warning: {doubt}")
    if file:
        print(f"written: {file}")
    say_drawn(picture)


def _record(
    found: Torus, doubts: tuple[str, ...], stability: Floquet | None
) -> dict[str, Any]:
    """A torus for JSON, with doubts besides its own, and with its multipliers."""
    record = found.record()
    record["warnings"] += doubts
    if stability is not None:
        record |= {field.key: field.value for field in stability.multiplier_fields()}
    return record


def _asked(wish: Wish) -> dict[str, Any]:
    """What fixes the torus, as `torus` takes it."""
    energy = wish.energy
    given = {
        "frequencies": wish.frequencies,
        "amplitudes": wish.amplitudes,
        "energy": energy
        and Energy(energy, harmonic=wish.harmonic, energy_ratio=wish.shares),
    }
    return {name: value for name, value in given.items() if value is not None}


def _refuse_cuts(wish: Wish) -> None:
    """InputError for orders at which a series is cut, where there is none."""
    for name in ("frequency_order", "coordinate_order"):
        if getattr(wish, name) is not None:
            allowed = "none without --order, as Newton's method has no series"
            raise InputError(name, getattr(wish, name), allowed, "give --order K, too")


def _refuse_without_energy(energy: str | None, shares: str | None, harmonic: bool) -> None:
    """InputError for options that say something about an energy, where none is given."""
    if energy is not None:
        return
    for name, value in (("shares", shares), ("harmonic", harmonic or None)):
        if value is not None:
            allowed = "an --energy that it says something about"
            raise InputError(name, value, allowed, "give --energy E, or leave it out")


def _shares_text(wish: Wish) -> str:
    if wish.shares is None:
        return EQUAL_SHARES
    ratio = ", ".join(f"{q}: {share}" for q, share in sorted(wish.shares.items()))
    return f"time averages of E_q of the seeds as {ratio}"


def _found(
    chain: Chain, seeds: tuple[int, ...], wish: Wish, advance: Progress
) -> tuple[Torus[FromSeries], Assessment, dict[str, Any]]:
    """The torus, the verdict on its series, and both for JSON."""
    if chain.periodic:
        _refuse_on_a_ring(wish)
    found = _torus(chain, seeds, wish, advance)
    assessment = assess(found.origin.series, found, progress=advance)
    record = found.record() | {"verdict": assessment.verdict}
    record["assessment"] = assessment.record()
    if wish.energy is not None:
        shares = wish.shares or dict.fromkeys(seeds, "1")
        record["energy_shares"] = {str(q): shares[q] for q in found.seeds}
    return found, assessment, record


def _torus(
    chain: Chain, seeds: tuple[int, ...], wish: Wish, advance: Progress
) -> Torus[FromSeries]:
    if wish.frequencies is None:
        advance("frequencies", NO_FRACTION)
    assert wish.order is not None
    asked = _asked(wish)
    cuts: dict[str, Any] = {
        "frequency_order": wish.frequency_order,
        "coordinate_order": wish.coordinate_order,
    }
    orders = Orders(wish.order, **cuts)
    return series_torus(chain, seeds, asked, orders, wish.digits, advance)


def _refuse_on_a_ring(wish: Wish) -> None:
    """InputError for what the series of waves on a ring does not take."""
    allowed = "none with --ends periodic, where waves are found from frequencies"
    for name, words in (("amplitudes", "A,A,..."), ("energy", "E")):
        if getattr(wish, name) is not None:
            advice = f"give --omega and -o FILE, then symfpu refine FILE --{name} {words}"
            raise InputError(name, getattr(wish, name), allowed, advice)
    if wish.digits is not None:
        allowed = "none with --ends periodic, which is in doubles"
        advice = "leave it out; what takes a ring is in docs/chains.md"
        raise InputError("digits", wish.digits, allowed, advice)

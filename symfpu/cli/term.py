"""The verb term: one coordinate or frequency correction of a series as a formula."""

from __future__ import annotations

import shlex
from dataclasses import dataclass
from typing import Annotated, Any

import typer

from symfpu.chain.chain import Chain
from symfpu.chain.length import label_entry, mode_label
from symfpu.chain.symbols import chosen_symbol, coordinate_symbol
from symfpu.cli.chains import AlphaOption, BetaOption, PotentialOption, chain_of
from symfpu.cli.choices import choice
from symfpu.cli.keeping import output_named
from symfpu.cli.terminal import (
    JsonOption,
    OrderOption,
    mode_named,
    optional,
    print_json,
    progress_bar,
    say,
    whole,
)
from symfpu.cli.verbs import app
from symfpu.errors import InputError
from symfpu.notebook import latex_lines
from symfpu.numbers.typed import decimal
from symfpu.results.field import exact_by_seed
from symfpu.series.all_lengths import SeriesForAllN
from symfpu.series.closed_forms import closed_form
from symfpu.series.lindstedt import lindstedt
from symfpu.series.named_parts import NamedParts
from symfpu.series.series import LindstedtSeries
from symfpu.store.saved_file import save

CLOSED = "closed"
FORMS = ("expanded", "factored", "cse", CLOSED)
RINGS = {"factored": "nested"}  # in which a frequency has this form; others are expanded


@dataclass(frozen=True)
class Formula:
    """A formula of a series. name : Q_q or omega_q. form : None where coefficients are numbers."""

    series: LindstedtSeries
    name: str
    q: int
    order: int
    form: str | None
    parts: NamedParts

    @property
    def valid(self) -> dict[str, Any]:
        """From which N on it holds, where it holds for all of them."""
        if isinstance(self.series, SeriesForAllN):
            return {"valid_from": self.series.valid_from}
        return {}


@app.command(epilog="Example: symfpu term -N N --alpha 1 --seeds 1,2 -q 3 --order 2")
def term(
    context: typer.Context,
    bonds: Annotated[
        str,
        typer.Option("-N", help="Number of bonds, or N for all at once.", metavar="N"),
    ],
    seeds: Annotated[
        str,
        typer.Option(
            "--seeds",
            help="Seed modes D_0, such as 1,2; with -N N also N-1, N-2, ...",
            metavar="Q,Q,...",
        ),
    ],
    q: Annotated[
        str, typer.Option("-q", help="The mode; with -N N also N-1, ...", metavar="Q")
    ],
    order: OrderOption,
    alpha: AlphaOption = "0",
    beta: BetaOption = "0",
    potential: PotentialOption = None,
    frequency: Annotated[
        bool,
        typer.Option("--frequency", help="The correction of omega_q, a seed, not Q_q."),
    ] = False,
    form: Annotated[
        str | None,
        choice(
            "--form",
            FORMS,
            "How it is written; closed: in N and omega.  Default: expanded.",
        ),
    ] = None,
    omega: Annotated[
        str | None,
        typer.Option(
            help="Frequencies, one for each seed: then with numbers.", metavar="W,W,..."
        ),
    ] = None,
    digits: Annotated[
        str | None,
        typer.Option(help="With --omega: digits, proved.  Default: doubles.", metavar="D"),
    ] = None,
    latex: Annotated[
        bool, typer.Option("--latex", help="As LaTeX, in lines that fit a page.")
    ] = False,
    output: Annotated[
        str | None,
        typer.Option(
            "-o", "--output", help="Keep the series in this file.", metavar="FILE"
        ),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """One term of a series, Q_q^(k) or omega_q^(k), as a formula, for one N or for all.

    Without --omega in the symbols L_q(nu) and Omega_q; without the power of mu.
    """
    chain = chain_of(bonds, alpha, beta, potential, symbolic=True)
    named = mode_named if chain.symbolic else whole
    modes = [named("seeds", part) for part in seeds.split(",") if part.strip()]
    mode, highest = named("q", q), whole("order", order)
    _require_form(form, frequency, omega)
    places = optional("digits", digits)
    chosen = None if omega is None else omega.split(",")
    file = output_named(output)
    ring = RINGS.get(form or "") if frequency else None
    with progress_bar("series") as advance:
        series = lindstedt(
            chain, modes, chosen, highest, ring=ring, digits=places, progress=advance
        )
        found = _formula(series, mode, frequency, form)
        if file:
            save(file, series, command=shlex.join(["symfpu", *context.obj]))
    if as_json:
        print_json(_record(found, latex))
    elif latex:
        print(_latex(found))
    else:
        _print_formula(found)
    if file and not as_json:
        print(f"written: {file}")


def _require_form(form: str | None, frequency: bool, omega: str | None) -> None:
    """InputError for a form that is none, or that the formula cannot have."""
    if form is None:
        return
    if omega is not None:
        advice = "leave out --form or --omega"
        raise InputError("form", form, "none with --omega: it has numbers", advice)
    allowed = [name for name in FORMS if name != "cse" or not frequency]
    if form not in allowed:
        raise InputError("form", form, f"one of {', '.join(allowed)}", "leave it out")


def _formula(
    series: LindstedtSeries, mode: int | str, frequency: bool, form: str | None
) -> Formula:
    """The term at the order of the series."""
    label, k = mode_label(mode, "q"), series.order
    numeric = series.frequencies is not None
    wanted = None if numeric else form or "expanded"
    if frequency:
        name, expression = chosen_symbol(label), series.frequency_correction(label, k)
    else:
        name = coordinate_symbol(label)
        expression = series.term(label, k, form="factored" if wanted == CLOSED else wanted)
    if wanted == CLOSED:
        expression = closed_form(expression, series.chain, series.seeds)
    parts = expression
    if not isinstance(expression, NamedParts):
        parts = NamedParts((), expression)
    return Formula(series, f"{name}^({k})", label, k, wanted, parts)


def _record(found: Formula, latex: bool) -> dict[str, Any]:
    """For machines; expressions as SymPy and SymEngine read them."""
    series = found.series
    names = [[str(name), str(value)] for name, value in found.parts.names]
    record = {
        "kind": "term",
        "N": "N" if series.chain.symbolic else series.chain.N,
        **series.chain.typed_law,
        **found.valid,
        "seeds": list(map(label_entry, series.seeds)),
        "frequencies": None if series.frequencies is None else exact_by_seed(series.omega),
        "digits": series.digits,
        "name": found.name,
        "q": label_entry(found.q),
        "order": found.order,
        "form": found.form,
        "expression": str(found.parts.expression),
        "names": names,
    }
    return record | {"latex": _latex(found)} if latex else record


def _latex(found: Formula) -> str:
    if found.parts.names:
        return found.parts.latex()
    lines = [f"&{line}" for line in latex_lines(found.parts.expression)]
    rows = " \\\\\n".join(lines)
    return f"\\begin{{aligned}}\n{rows}\n\\end{{aligned}}"


def _print_formula(found: Formula) -> None:
    say(f"{found.name} = {found.parts.expression}")
    for name, value in found.parts.names:
        say(f"  {name} = {value}")
    say(_where(found))


def _where(found: Formula) -> str:
    """What the symbols are."""
    chain: Chain = found.series.chain
    power = "sqrt(2N)" if chain.degree_step == 1 else "(2N)"
    mu = f"mu = {decimal(chain.unit_coupling)}/{power}"
    remarks = [f"to be multiplied by mu^{found.order}, {mu}"]
    if found.valid:
        remarks.append(f"for every N >= {found.valid['valid_from']}")
    if found.form not in (None, CLOSED):
        quotient = "L_q(nu) = Omega_q^2/(lambda_q - (nu.omega)^2)"
        remarks.append(f"{quotient}, lambda_q = omega_q^2 of a seed, Omega_q^2 of others")
        remarks.append("Omega_q = 2 sin(q pi/2N)")
    return "\n".join(remarks)

"""Results as text: JSON with numbers that lose no digit, Markdown, CSV. Computes nothing."""

from __future__ import annotations

import csv
import math
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from symfpu.chain.chain import decimal
from symfpu.errors import InputError
from symfpu.numbers.arithmetic import text
from symfpu.paper.convergence import BreatherStudy, CancellationStudy
from symfpu.paper.printed import FIG1_CLAIMS
from symfpu.paper.table import AmplitudeRow, Figure1, Figure6
from symfpu.proofs.sweeps import Sweep, SweepCase
from symfpu.tori.torus import QTorus
from symfpu.tori.verdict import Assessment


def output_folder(path: Path) -> Path:
    """The folder, made if missing; InputError if it cannot be written."""
    try:
        path.mkdir(parents=True, exist_ok=True)
        if not os.access(path, os.W_OK):
            raise PermissionError("no permission to write")
    except OSError as error:
        raise InputError(
            "output", str(path), "a folder that can be written", f"choose another with -o ({error.strerror or error})"
        ) from error
    return path


def output_file(path: Path) -> Path:
    """The path, if a file can be written there; InputError before anything is computed otherwise."""
    if path.is_dir() or not path.parent.is_dir() or not os.access(path.parent, os.W_OK):
        raise InputError("output", str(path), "a file in a folder that exists and can be written", "choose another with -o")
    return path


def fifteen_digits(value: float) -> float:
    """A measure of size to 15 digits, the most that a number in JSON has; what needs more is written as a string."""
    return float(f"{value:.15g}")


def number_text(value: Any, digits: int | None) -> str:
    """A number that loses no digit: the shortest decimal of a double, or so many digits of an mpf."""
    return repr(float(value)) if digits is None else text(value, digits)


def torus_record(torus: QTorus, assessment: Assessment | None = None) -> dict[str, Any]:
    """A torus for JSON: keys of the command line, numbers of more than 15 digits as strings."""
    series, digits = torus.series, torus.digits
    energies = {
        "energy": torus.energy(),
        "harmonic_energy": torus.harmonic_energies().sum(),
        "average_harmonic_energy": torus.average_spectrum().sum(),
    }
    judged = {} if assessment is None else {"verdict": assessment.headline, "assessment": assessment.record()}
    return {
        "N": series.chain.N,
        "alpha": decimal(series.chain.alpha),
        "beta": decimal(series.chain.beta),
        "seeds": list(series.seeds),
        "frequencies": {str(q): decimal(w) for q, w in zip(series.seeds, series.frequencies or (), strict=True)},
        "order": torus.order,
        "frequency_order": torus.frequency_order,
        "digits": digits,
        "guard_digits": None if digits is None else series.guard_digits,
        "amplitudes": {str(q): number_text(a, digits) for q, a in torus.amplitudes.items()},
        "certified": None if torus.certificate is None else torus.certificate.certified,
        "history": {str(k): [number_text(a, digits) for a in values] for k, values in torus.history.items()},
        **{name: number_text(value, digits) for name, value in energies.items()},
        "residual": fifteen_digits(torus.residual()),
        "root_residual": fifteen_digits(torus.root_residual),
        "smallest_divisors": [
            {"size": fifteen_digits(d.size), "mode": d.mode, "harmonic": list(d.harmonic), "order": d.order}
            for d in series.smallest_divisors
        ],
        "warnings": list(torus.warnings),
        **judged,
    }


def assessment_text(found: Assessment) -> str:
    """The evidence of a verdict: reasons, radii, and a line for some of the orders (all of them are in the JSON)."""
    lines = [f"  {reason}" for reason in found.reasons]
    poles = "no pole" if math.isinf(found.pole_radius) else f"{found.pole_radius:.3g}"
    lines.append(
        f"  radius of convergence in units of mu: {found.radius:.3g} by ratio of terms, {poles} by Pade poles of the frequencies (a hint)"
    )
    seed = next(iter(found.sums))
    head = ("order", f"A_{seed}(k)", "dA(k)", f"S_1, S_2 of Q_{seed}", "residual", "energy error", "largest term: mode, harmonic, divisor")
    rows = [_order_line(found, seed, k) for k in _some(found)]
    widths = [max(len(row[i]) for row in (head, *rows)) for i in range(len(head))]
    lines += ["  " + "  ".join(cell.ljust(w) for cell, w in zip(row, widths, strict=True)).rstrip() for row in (head, *rows)]
    return "\n".join(lines)


def _some(found: Assessment) -> list[int]:
    """At most about a dozen orders: the first, the best, the last, and some between."""
    step = max(1, found.order // 10)
    return sorted({*range(0, found.order + 1, step), found.best_order, found.order})


def _order_line(found: Assessment, seed: int, k: int) -> tuple[str, ...]:
    first, second = (sums[k] for sums in found.sums[seed])
    term = next((t for t in found.terms if t.order == k), None)
    largest = "" if term is None else f"{term.size:.1e}: {term.mode}, ({','.join(map(str, term.harmonic))}), {term.divisor:.1e}"
    position = list(found.sums).index(seed)
    amplitude = f"{float(found.amplitudes[k][position]):.10g}" if k in found.amplitudes else ""
    change = f"{max(found.differences[k]):.1e}" if k in found.differences else ""
    sums, errors = f"{first:.1e}, {second:.1e}", (f"{found.residuals[k]:.1e}", f"{found.energy_errors[k]:.1e}")
    return (str(k), amplitude, change, sums, *errors, largest)


def row_record(row: AmplitudeRow) -> dict[str, Any]:
    """One row of the table for JSON, printed and computed numbers side by side."""
    printed = row.printed
    return {
        "label": printed.label,
        "printed_label": printed.printed_label,
        "printed_amplitudes": dict(zip(map(str, printed.seeds), printed.amplitudes, strict=True)),
        "printed_energy": printed.energy,
        "digits_by_frequency_order": {str(k): round(d, 2) for k, d in row.digits.items()},
        "met_at_frequency_orders": list(row.met),
        "digits": round(row.digits[row.best], 2),
        "energies": {name: repr(value) for name, value in row.energies.items()},
        "energy_matches": list(row.energy_matches),
        "energy_orders": {name: list(orders) for name, orders in row.energy_orders.items()},
        "verdict": row.verdict,
        "torus": torus_record(row.torus),
    }


def figure1_record(data: Figure1) -> dict[str, Any]:
    """The claims about Fig. 1 for JSON."""
    ours = data.claims()
    judged = {"digits": data.torus.digits, "rounding_of_doubles": fifteen_digits(data.rounding), "assessment": data.assessment.record()}
    return {"best_order": data.best_order, **judged, "claims": {key: {"printed": FIG1_CLAIMS[key], "computed": ours[key]} for key in ours}}


def markdown_table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table."""
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def table_markdown(rows: Sequence[AmplitudeRow]) -> str:
    """The table of Appendix F and Fig. 1: a summary, then every frequency order of every row."""
    parts = [
        "## Appendix F and Fig. 1: amplitudes and energies from the printed frequencies",
        "Digits are those of the worst amplitude, -log10 |ours/printed - 1|. Two truncation orders: K of the frequency series "
        "that gives the amplitudes, `order` of the coordinates that give the energies.",
        markdown_table(
            ["torus", "N", "alpha", "seeds", "order", "met at K", "digits", "printed E", "H(0)", "harmonic E(0)", "average", "residual"],
            [_summary(row) for row in rows],
        ),
    ]
    for row in rows:
        printed = row.printed
        head = f"### {printed.label} (Appendix F: {printed.printed_label}), {printed.chain!r}, seeds {printed.seeds}"
        lines = [["printed", *printed.amplitudes, ""]]
        lines += [[str(k), *(repr(a) for a in row.history.amplitudes[k]), f"{row.digits[k]:.1f}"] for k in _shown(row)]
        columns = ["K", *(f"A_{q}" for q in printed.seeds), "digits"]
        failures = [f"K = {k}: {failure}" for k, failure in row.history.failures.items()]
        parts += [head, f"Verdict: {row.verdict}.", markdown_table(columns, lines), *failures]
    return "\n\n".join(parts) + "\n"


def _summary(row: AmplitudeRow) -> list[str]:
    printed = row.printed
    met = ", ".join(map(str, row.met)) or f"none (nearest {row.best})"
    values = [f"{value:.8g}" for value in row.energies.values()]
    seeds = ",".join(map(str, printed.seeds))
    fixed = [printed.label, str(printed.chain.N), decimal(printed.chain.alpha), seeds, str(printed.order)]
    return [*fixed, met, f"{row.digits[row.best]:.1f}", printed.energy, *values, f"{row.residual:.1e}"]


def _shown(row: AmplitudeRow) -> list[int]:
    """All orders of a short history; of a long one the beginning, the end, what is met and every tenth."""
    orders = list(row.digits)
    if len(orders) <= 30:
        return orders
    return [k for i, k in enumerate(orders) if i < 5 or i >= len(orders) - 5 or k in (*row.met, row.best) or i % 10 == 9]


def figure1_markdown(data: Figure1) -> str:
    """The claims of the text about Fig. 1 beside ours, and where the pictures are."""
    ours = data.claims()
    rows = [[key.replace("_", " "), FIG1_CLAIMS[key], ours[key]] for key in ours]
    pictures = "\n\n".join(f"![Fig. 1({panel})](fig1{panel}.png)" for panel in "abcd")
    residual = ", ".join(f"{k}: {value:.1e}" for k, value in data.residuals.items() if k % 2 == 0)
    return (
        "## Fig. 1: the 2-torus of N = 16, alpha = 0.33, seeds 1 and 2\n\n"
        + markdown_table(["claim", "printed", "computed"], rows)
        + f"\n\nResidual of the equations of motion by coordinate order: {residual}.\n"
        + f"The least is at order {data.best_order}.\n\n"
        + f"Verdict on the series: {data.assessment.headline} ({'; '.join(data.assessment.reasons)}).\n\n"
        + f"Computed with {data.torus.series.precision}. In doubles the amplitudes of all orders come out the same to "
        + f"{data.rounding:.1e}.\n\n{pictures}\n"
    )


def write_figure1_csv(data: Figure1, folder: Path) -> list[Path]:
    """The data behind panels (a) to (d), one CSV file each."""
    seeds = data.torus.series.seeds
    modes = range(1, data.torus.series.chain.N)
    tables: dict[str, tuple[list[str], Iterable[Sequence[Any]]]] = {
        "fig1a": (
            ["q", *(f"average_energy_over_H_order_{k}" for k in data.spectra)],
            ([q, *(float(s[q - 1]) for s in data.spectra.values())] for q in modes),
        ),
        "fig1b": (["k", *(f"delta_A{q}" for q in seeds)], ([k, *d] for k, d in data.differences.items())),
        "fig1c": (
            ["k", "mu_k_S1", "mu_k_S2"],
            ([k, float(a), float(b)] for k, (a, b) in enumerate(zip(*data.sums, strict=True))),
        ),
        "fig1d": (
            ["t", *(f"{name}_order_{k}" for k in data.errors for name in ("total", "harmonic"))],
            ([float(t), *(float(e[i]) for pair in data.errors.values() for e in pair)] for i, t in enumerate(data.times)),
        ),
    }
    return write_csv(tables, folder)


def write_figure6_csv(data: Figure6, folder: Path) -> list[Path]:
    """The data behind the panels of Fig. 6, one CSV file each."""
    return write_csv(
        {
            f"fig6{panel}": (["q", "kappa", "order"], [[q, q / data.N, orders[q]] for q in sorted(orders)])
            for panel, (_, orders) in data.panels.items()
        },
        folder,
    )


def figure6_markdown(data: Figure6) -> str:
    """What Fig. 6 shows, and where the pictures are."""
    lines = [
        [panel, f"{seeds[0]}..{seeds[-1]}", str(len(orders)), str(max(orders.values()))] for panel, (seeds, orders) in data.panels.items()
    ]
    pictures = "\n\n".join(f"![Fig. 6({panel})](fig6{panel}.png)" for panel in data.panels)
    table = markdown_table(["panel", "seeds", "modes excited", "at order, at the latest"], lines)
    return f"## Fig. 6: orders of first excitation, N = {data.N}, alpha\n\n{table}\n\n{pictures}\n"


def cancellation_markdown(data: CancellationStudy) -> str:
    """Question (i) of the convergence study: what was tested, what came out."""
    shown = (14, 20, 24, 28)
    rows = [
        [v.name, *(f"{max(v.differences[k]):.2e}" for k in shown), *(f"{v.sums[k]:.2e}" for k in (14, 30)), f"{v.residuals.min():.1e}"]
        for v in data.variants
    ]
    table = markdown_table(["case", *(f"dA({k})" for k in shown), "S_2(14)", "S_2(30)", "least residual"], rows)
    ratios = ", ".join(f"{k}: {r:.6f}" for k, r in data.ratios.items() if k >= 20)
    by_order = [
        [str(k), f"{data.residuals[k]:.1e}", f"{data.resummed[k]:.1e}", *(f"{a:.10f}" for pair in data.amplitudes[k] for a in pair)]
        for k in data.resummed
    ]
    columns = ["order", "residual", "resummed", "A_1", "A_2", "A_1 resummed", "A_2 resummed"]
    first, second = data.coincidence
    return "\n\n".join(
        [
            "## Question (i): Fig. 1(b, c), why the errors stop falling",
            table,
            f"Exact coincidence: {first} omega_1 {second:+d} omega_2 = 0, at order {abs(first) + abs(second) - 1}; none before.",
            f"Verdict: {data.assessment.headline} ({'; '.join(data.assessment.reasons)}).",
            f"The coefficient of harmonic (5,-4) in mode 3, divisor {data.divisor:.4e}, grows every two orders by: {ratios}.",
            f"Mode 3's own frequency on the torus, a series in mu^2, meets 4 omega_2 - 5 omega_1 at {data.pole:.5f} of the actual mu^2: "
            f"a pole there makes terms grow by {1 / data.pole:.5f} every two orders.",
            markdown_table(columns, by_order),
        ]
    )


def breather_markdown(data: BreatherStudy) -> str:
    """Question (ii) of the convergence study."""
    rows = [
        [name, f"{float(o.frequency):.14f}", f"{o.amplitude:.11f}", f"{o.energy:.10f}", f"{o.harmonic_energy:.10f}", f"{o.residual:.0e}"]
        for name, o in (("printed frequency", data.orbit), ("printed amplitude", data.at_printed))
    ]
    orders = [k for k in data.amplitudes if k in (2, 10, 50, 100, 150, 200) or k == max(data.amplitudes)]
    return "\n\n".join(
        [
            "## Question (ii): the breather of E = 0.014915",
            markdown_table(["periodic orbit with the", "omega", "A", "H", "harmonic E(0)", "residual"], rows),
            "A(K) of the truncated series: " + ", ".join(f"{k}: {data.amplitudes[k]:.8f}" for k in orders) + ".",
            f"The frequency series with these divisors ends at A = {data.singularity:.9f} (spread of the fit {data.spread:.0e}) in a "
            f"singularity of exponent {data.exponent:.4f}.",
            f"The breathers lie behind such an end, out of reach of the series, from A = {data.limit.orbit.amplitude:.6f}, omega = "
            f"{float(data.limit.orbit.frequency):.9f}, H = {data.limit.orbit.energy:.7f} on; Newton's method followed the family to H = "
            f"{data.limit.family.members[-1].energy:.4f}.",
            f"Verdict: {data.assessment.headline} ({'; '.join(data.assessment.reasons)}).",
        ]
    )


def convergence_markdown(cancellation: CancellationStudy, breather: BreatherStudy) -> str:
    """Both questions, and where the pictures are."""
    pictures = "\n\n".join(f"![{name}]({name}.png)" for name in (f"convergence-{x}" for x in "abcde"))
    return "\n\n".join([cancellation_markdown(cancellation), breather_markdown(breather), pictures]) + "\n"


def convergence_record(cancellation: CancellationStudy, breather: BreatherStudy) -> dict[str, Any]:
    """Both questions for JSON."""
    return {
        "coincidence": list(cancellation.coincidence),
        "divisor": fifteen_digits(cancellation.divisor),
        "pole": fifteen_digits(cancellation.pole),
        "ratios": {str(k): fifteen_digits(r) for k, r in cancellation.ratios.items()},
        "resummed_residuals": {str(k): fifteen_digits(r) for k, r in cancellation.resummed.items()},
        "torus": cancellation.assessment.record(),
        "orbit": {"frequency": decimal(breather.orbit.frequency), "amplitude": repr(breather.orbit.amplitude)},
        "orbit_energy": repr(breather.orbit.energy),
        "singularity": fifteen_digits(breather.singularity),
        "limit": {
            "frequency": decimal(breather.limit.orbit.frequency),
            "amplitude": repr(breather.limit.orbit.amplitude),
            "energy": repr(breather.limit.orbit.energy),
        },
        "breather": breather.assessment.record(),
    }


def write_convergence_csv(cancellation: CancellationStudy, breather: BreatherStudy, folder: Path) -> list[Path]:
    """The data behind the pictures of the convergence study."""
    names = [v.name for v in cancellation.variants]
    orders = list(cancellation.variants[0].differences)
    return write_csv(
        {
            "convergence-a": (["k", *names], ([k, *(max(v.differences[k]) for v in cancellation.variants)] for k in orders)),
            "convergence-b": (
                ["k", *names],
                ([k, *row] for k, row in enumerate(zip(*(v.sums for v in cancellation.variants), strict=True))),
            ),
            "convergence-c": (
                ["order", "truncated", "resummed"],
                ([k, cancellation.residuals[k], r] for k, r in cancellation.resummed.items()),
            ),
            "convergence-d": (["K", "A"], ([k, a] for k, a in breather.amplitudes.items())),
            "convergence-e": (
                ["omega", "A", "A at the end of the series"],
                zip(breather.limit.frequencies, breather.limit.amplitudes, breather.limit.ends, strict=True),
            ),
        },
        folder,
    )


def write_csv(tables: Mapping[str, tuple[Sequence[str], Iterable[Sequence[Any]]]], folder: Path) -> list[Path]:
    """Tables by name, each with its header, as CSV files in a folder."""
    paths = []
    for name, (header, lines) in tables.items():
        path = folder / f"{name}.csv"
        with path.open("w", newline="") as file:
            csv.writer(file).writerows([header, *lines])
        paths.append(path)
    return paths


def sweep_markdown(sweep: Sweep) -> str:
    """A sweep of the propagation rule: how often it holds by N and number of seeds, and every exception."""
    groups: dict[tuple[int, int], list[SweepCase]] = {}
    for case in sweep.cases:
        groups.setdefault((case.N, len(case.seeds)), []).append(case)
    rows = [
        [str(N), str(s), str(len(cases)), *(str(sum(c.verdict == v for c in cases)) for v in ("proved", "refuted", "undecided"))]
        for (N, s), cases in groups.items()
    ]
    exceptions = [
        [str(case.N), ", ".join(map(str, case.seeds)), "; ".join(f"{q}: {p} -> {a}" for q, p, a in case.exceptions)]
        for case in sweep.exceptions
    ]
    holds = sum(case.corrected_rule_holds for case in sweep.cases)
    parts = [
        f"## {sweep.model} model, order {sweep.order}",
        f"{len(sweep.cases)} seed sets. The proposition holds in {sum(c.verdict == 'proved' for c in sweep.cases)}; "
        f"the corrected rule predicts the actual sets in {holds}.",
        markdown_table(["N", "seeds", "sets", "proved", "refuted", "undecided"], rows),
    ]
    if exceptions:
        parts += [
            "Exceptions (mode: predicted order -> actual order):",
            markdown_table(["N", "seeds", "exceptions"], exceptions),
        ]
    return "\n\n".join(parts) + "\n"

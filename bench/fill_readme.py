#!/usr/bin/env python3
"""Puts recorded results between the markers of the repository's README.md, and into results/sets.md, so that no figure in them is typed.

report, proven: results/report/report.json, what `tools/report.sh --record` measured
run:   results/run.txt, what tools/run.sh printed
truth: results/truth.txt, what truth_test printed
speed: results/*.json, records of tools/bench.sh
"""
import json
import pathlib
import re
import textwrap

results = pathlib.Path(__file__).parent / "results"
readme = pathlib.Path(__file__).parent.parent / "README.md"


def wrapped(line):
    """Prose in lines of the README's width."""
    return textwrap.fill(line, 120, break_long_words=False, break_on_hyphens=False)


def report_table():
    """Speed against error: vertex-face pairs, a row for each E_tol, a column of speeds for each instruction set."""
    report = json.loads((results / "report" / "report.json").read_text())
    part, machine = report["speed_and_error"], report["machine"]
    labels = {"avx512": "AVX-512", "avx2": "AVX2", "sse2": "SSE2", "neon": "NEON", "scalar": "scalar"}
    isas = machine["isas"]
    points = {(point["tolerance"], point["isa"]): point for point in part["vf"]["points"]}
    sets = report["hard_cases"]["sets"]
    hard = sum(s["pairs"] for s in sets)
    wrong = {key: sum(s["plain"][key] for s in sets) for key in ("missed", "late", "false_alarms")}
    lines = ["| E_tol | " + " | ".join(f"{labels[isa]}, M pairs/s" for isa in isas) + " | early: median | worst | missed | late | false alarms |",
             "|---|" + "---|" * (len(isas) + 5)]
    for tolerance in sorted({tolerance for tolerance, _ in points}, reverse=True):
        of_all = [points[tolerance, isa] for isa in isas]
        errors = of_all[-1]["signed_error"]
        lines.append("| " + " | ".join([f"{tolerance:g}", *(f"{point['timing']['pairs_per_second'] / 1e6:.1f}" for point in of_all),
                                        f"{-errors['median']:.1e}", f"{-errors['earliest']:.1e}",
                                        *(str(max(point[key] for point in of_all)) for key in ("missed", "late", "false_alarms"))]) + " |")
    repeats = of_all[-1]["timing"]["repeats"]
    peers = "; ".join(f"{peer['name']}: {peer['missed']:,} missed, "
                      + (f"{peer['late']:,} late, " if peer["signed_error"] else "no time, ") + f"{peer['false_alarms']:,} false alarms"
                      for peer in part["vf"]["peers"])
    lines += ["", wrapped(f"Random vertex-face pairs (the paper's test), one thread, processor time, median of {repeats}; {machine['processor']}, {machine['compiler']}, "
              f"commit {machine['commit']}, load average {machine['load_average']:.1f}. Errors of the time of impact in units of the step, judged by exact truth on the first "
              f"{part['truth_pairs']:,} pairs ({points[1e-9, isas[0]]['contacts']:,} contacts)."
              + (f" Other libraries on the same pairs: {peers}." if peers else "")
              + f" Hard cases, {hard:,} pairs in {len(sets)} sets: {wrong['missed']} missed, {wrong['late']} late, {wrong['false_alarms']:,} false alarms, "
              f"with `--exact` {sum(s['exact']['false_alarms'] for s in sets if s['exact'])}.")]
    return "\n".join(lines)


def run_output():
    text = (results / "run.txt").read_text()
    return "    " + text.strip().replace("\n", "\n    ")


def truth_table():
    """Lines of truth_test: E_tol T: vertex-face N pairs, C contacts, F false alarms; edge-edge N, C, F."""
    rows = ["| data | E_tol | kind | pairs | contacts | missed | late | false alarms |", "|---|---|---|---|---|---|---|---|"]
    data = None
    for line in (results / "truth.txt").read_text().splitlines():
        if match := re.match(r"\[ RUN +\] Truth\.Public(\w+)", line):
            data = {"HardCases": "hard cases", "Queries": "queries"}[match[1]]
        if match := re.match(r"E_tol (\S+): vertex-face (\d+) pairs, (\d+) contacts, (\d+) missed, (\d+) late, (\d+) false alarms; "
                             r"edge-edge (\d+), (\d+), (\d+), (\d+), (\d+)", line):
            tolerance, *numbers = match.groups()
            for kind, values in (("vertex-face", numbers[:5]), ("edge-edge", numbers[5:])):
                rows.append("| " + " | ".join([data, f"{float(tolerance):g}", kind, *(f"{int(v):,}" for v in values)]) + " |")
    return "\n".join(rows)


def set_table():
    """Lines of truth_test: set NAME: kind, N pairs, C contacts, ... false alarms A and B exactly, worst early S and T."""
    rows = ["| set | contacts | missed | late | proven | false alarms | with `--exact` | worst early | with `--exact` |",
            "|---|---|---|---|---|---|---|---|---|"]
    for line in (results / "truth.txt").read_text().splitlines():
        if match := re.match(r"set (\S+): \S+ \d+ pairs, (\d+) contacts, (\d+) missed, (\d+) late, (\d+) proven, "
                             r"false alarms (\d+) and (\d+) exactly, worst early (\S+)(?: and (\S+))?", line):
            name, contacts, missed, late, proven, alarms, exact_alarms, early, exact_early = match.groups()
            name = name.removesuffix(".csv")
            early = "-" if early == "unknown" else early
            rows.append("| " + " | ".join([name, *(f"{int(v):,}" for v in (contacts, missed, late, proven, alarms, exact_alarms)),
                                           early, exact_early or "-"]) + " |")
    return "\n".join(rows)


def proven_table():
    """Contacts of the public scenes in the recorded report, and how many of them are proven."""
    record = json.loads((results / "report" / "report.json").read_text())
    rows = ["| scene | contacts | proven |", "|---|---|---|"]
    for scene in record["scenes"]["scenes"]:
        if scene["source"] != "data":
            continue
        kinds = [step[kind] for step in scene["steps"] for kind in ("vf", "ee")]
        contacts, proven = (sum(kind[count] for kind in kinds) for count in ("contacts", "proven"))
        rows.append(f"| {scene['name']} | {contacts:,} | {proven:,} |")
    return "\n".join(rows)


def speed_table(record):
    """The end-to-end medians of one thread, by layout, per instruction set of four lanes and more."""
    rates, last, contacts = {}, {}, {}
    for b in record["benchmarks"]:
        name = b["name"].removesuffix("_median").removesuffix("/manual_time")
        match = re.fullmatch(r"(vertex_face|edge_edge)/(avx2|avx512|neon)/([^/]+)/(blocked|interleaved|indexed)/(double|float)/threads:1", name)
        if not match or b.get("aggregate_name", "median") != "median":
            continue
        key = (match[1].replace("_", "-"), match[3], match[4] + (", floats" if match[5] == "float" else ""))
        rates.setdefault(key, {})[match[2]] = b["pairs/s"] / 1e6
        last[key] = f"{100 * b['limit_fraction']:.0f} %" if "limit_fraction" in b else "-"
        contacts[key] = int(b["contacts"])
    isas = [isa for isa in ("avx2", "avx512", "neon") if any(isa in rate for rate in rates.values())]
    context = record["context"]
    lines = [wrapped(f"One thread, E_tol 1e-9, million pairs per second; {context['cpu']}, {context['num_cpus']} processors, "
             f"commit {context['commit']}. Last column but one: the share of the streaming limit that {isas[-1]} reaches."), "",
             "| kind | data | layout | " + " | ".join(isas) + " | of the limit | contacts |",
             "|---|---|---|" + "---|" * len(isas) + "---|---|"]
    for key, rate in rates.items():
        cells = [f"{rate[isa]:.1f}" if isa in rate else "-" for isa in isas]
        lines.append("| " + " | ".join([*key, *cells, last[key], f"{contacts[key]:,}"]) + " |")
    return "\n".join(lines)


def speed_tables():
    """Of the latest records of machines with AVX-512, and without."""
    records = sorted((json.loads(path.read_text()) for path in results.glob("*.json")), key=lambda r: r["context"]["date"])
    latest = {record["context"]["best_isa"]: record for record in records}
    widest_first = [isa for isa in ("avx512", "avx2", "sse2", "neon", "scalar") if isa in latest]
    return "\n\n".join(speed_table(latest[isa]) for isa in widest_first)


text = readme.read_text()
for mark, content in (("report", report_table()), ("run.sh", run_output()), ("truth", truth_table()), ("proven", proven_table()), ("speed", speed_tables())):
    begin, end = f"<!-- {mark} begin -->", f"<!-- {mark} end -->"
    head, rest = text.split(begin)
    text = head + begin + "\n" + content + "\n" + end + rest.split(end)[1]
readme.write_text(text)
(results / "sets.md").write_text("# Accuracy, set by set\n\nWritten by `bench/fill_readme.py` from what `truth_test` printed (`truth.txt`), at E_tol 1e-9, without and with "
                                 "`--exact`: the public hard cases and queries.\n\n" + set_table() + "\n")

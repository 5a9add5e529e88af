#!/usr/bin/env python3
"""Records and tables of the benchmarks. Called by tools/bench.sh.

report.py merge FOLDER RUN.json...   one record FOLDER/<cpu>-<isa>.json from the runs of several programs; prints its path
report.py table RECORD.json          Markdown tables of a record
report.py readme                     puts the tables of every record in results/ into README.md, between the markers
"""

import json
import math
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
BEGIN, END = "<!-- begin results -->", "<!-- end results -->"


def slug(context):
    """File name of a record. Virtual machines hide the model's name but not its number."""
    cpu = re.sub(r"\((R|TM)\)|CPU|Processor|@.*(?=\(family)", " ", context["cpu"])
    cpu = re.sub(r"\(family (\w+), model (\w+)\)", r"family\1 model\2", cpu)
    return "-".join(re.findall(r"[a-z0-9]+", cpu.lower()) + [context["best_isa"]])


def merge(folder, runs):
    record = None
    for run in runs:
        run = json.loads(pathlib.Path(run).read_text())
        # The median is the result, the coefficient of variation says how far to trust it.
        kept = [b for b in run["benchmarks"] if b.get("aggregate_name") in ("median", "cv")]
        if record is None:
            record = run
            record["benchmarks"] = []
            # Which computer and folder it was is nobody's business; the load tells how quiet the machine was.
            for key in ("host_name", "executable"):
                record["context"].pop(key, None)
        record["benchmarks"] += kept
    path = pathlib.Path(folder) / (slug(record["context"]) + ".json")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(record, indent=1) + "\n")
    print(path)


def rows_of(record):
    """Medians by name, each with the coefficient of variation of its time as `spread`."""
    rows = {}
    for b in record["benchmarks"]:
        name = re.sub(r"/(manual_time|real_time)$", "", b["run_name"])
        if b["aggregate_name"] == "median":
            rows.setdefault(name, {}).update(b)
        else:
            rows.setdefault(name, {})["spread"] = b["real_time"]
    return rows


def number(value, scale=1.0, digits=3):
    if value is None:
        return ""
    value *= scale
    decimals = 0 if value == 0 else max(0, digits - 1 - math.floor(math.log10(abs(value))))
    return f"{value:,.{decimals}f}"


def percent(value):
    if value is None:
        return ""
    value *= 100
    return f"{value:.0f} %" if value >= 10 or value == 0 else f"{value:.2g} %" if value >= 0.001 else "< 0.001 %"


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def group_by_isa(rows, pattern):
    """{name without the instruction set: {instruction set: row}} of the names that match; the set is group 'isa'."""
    grouped = {}
    for name, row in rows.items():
        match = re.fullmatch(pattern, name)
        if match:
            key = tuple(v for k, v in match.groupdict().items() if k != "isa")
            grouped.setdefault(key, {})[match["isa"]] = row
    return grouped


def narrow_phase_table(rows, isas):
    pattern = (r"(?P<kind>vertex_face|edge_edge)/(?P<isa>\w+)/(?P<data>[^/]+)/(?P<layout>\w+)/(?P<scalar>\w+)"
               r"(?:/(?P<question>\w+))?/threads:(?P<threads>\d+)")
    out = []
    for (kind, data, layout, scalar, question, threads), found in group_by_isa(rows, pattern).items():
        best = found.get(isas[-1]) or list(found.values())[-1]
        out.append([kind, data, f"{layout} {scalar}", question or "dense", threads]
                   + [number(found.get(isa, {}).get("pairs/s"), 1e-6) for isa in isas]
                   + [number(best.get("limit_bytes/s"), 1e-9), percent(best.get("limit_fraction")),
                      number(best.get("contacts"), digits=1), percent(best.get("scalar_share")), percent(best.get("spread"))])
    header = (["kind", "data", "layout", "question", "threads"] + [f"{isa}, M pairs/s" for isa in isas]
              + ["limit, GB/s", "of limit", "contacts", "scalar path", "spread"])
    return header, out


def stage_table(rows, isas):
    pattern = r"stage/(?P<kind>\w+)/(?P<isa>\w+)/(?P<stage>\w+)/(?P<data>[^/]+)"
    out = []
    for (kind, stage, data), found in group_by_isa(rows, pattern).items():
        best = found.get(isas[-1]) or list(found.values())[-1]
        out.append([kind, data, stage] + [number(found.get(isa, {}).get("s/pair"), 1e9) for isa in isas]
                   + [percent(best["kept"]), percent(best.get("spread"))])
    return ["kind", "data", "stage"] + [f"{isa}, ns/pair" for isa in isas] + ["kept", "spread"], out


def search_table(rows, isas):
    pattern = r"search/(?P<kind>\w+)/(?P<isa>\w+)/(?P<sort>\w+)/(?P<data>[^/]+)"
    out = []
    for (kind, sort, data), found in group_by_isa(rows, pattern).items():
        best = found.get(isas[-1]) or list(found.values())[-1]
        out.append([kind, data, sort, percent(best.get("of_pairs")), number(best["intervals"])]
                   + [number(found.get(isa, {}).get("s/pair"), 1e9) for isa in isas]
                   + [percent(best.get("of_time")), percent(best.get("spread"))])
    return (["kind", "data", "searched", "of pairs", "intervals"] + [f"{isa}, ns/search" for isa in isas] + ["of time", "spread"],
            out)


def peer_table(rows):
    out = []
    for name, row in rows.items():
        if match := re.fullmatch(r"peer/(\w+)/([^/]+)/([^/]+)", name):
            kind, peer, data = match.groups()
            out.append([kind, data, peer, number(row["pairs/s"], 1e-6), number(1e9 / row["pairs/s"]),
                        number(row["contacts"], digits=1), number(row.get("missed"), digits=1),
                        number(row.get("extra"), digits=1), percent(row.get("spread"))])
    return ["kind", "data", "library", "M pairs/s", "ns/pair", "contacts", "missed", "extra", "spread"], out


def mesh_table(rows):
    out = [[what.replace("_", " "), name, number(row["vertices"], digits=1), number(1e3 * row["vertices"] / row["vertices/s"]),
            percent(row.get("spread"))]
           for full_name, row in rows.items()
           for what, _, name in [full_name.partition("/")] if what in ("moving_mesh", "mesh_boxes")]
    return ["what is made", "data", "vertices", "ms", "spread"], out


def tables(record):
    context, rows = record["context"], rows_of(record)
    isas = context["isas"].split()
    text = (f"{context['cpu']}, {context['num_cpus']} threads, {context['compiler']}, `{context['flags']}`, "
            f"{context['date'][:10]}, commit {context.get('commit', 'unknown')}, "
            f"load average at the start {context['load_avg'][0]:.1f}.\n")
    for title, (header, body) in (("Narrow phase", narrow_phase_table(rows, isas)), ("Moving mesh", mesh_table(rows)),
                                  ("Stages", stage_table(rows, isas)), ("Certified search", search_table(rows, isas)),
                                  ("Peers, one thread", peer_table(rows))):
        if body:
            text += f"\n#### {title}\n\n" + table(header, body)
    return text


def write_readme():
    readme = HERE / "README.md"
    before, rest = readme.read_text().split(BEGIN)
    after = rest.split(END)[1]
    parts = [f"\n### {path.stem}\n\n{tables(json.loads(path.read_text()))}" for path in sorted((HERE / "results").glob("*.json"))]
    readme.write_text(before + BEGIN + "\n" + ("".join(parts) or "\nNothing is recorded yet.\n") + "\n" + END + after)


def main(arguments):
    match arguments:
        case ["merge", folder, *runs] if runs:
            merge(folder, runs)
        case ["table", path]:
            print(tables(json.loads(pathlib.Path(path).read_text())))
        case ["readme"]:
            write_readme()
        case _:
            sys.exit(__doc__)


main(sys.argv[1:])

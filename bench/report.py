#!/usr/bin/env python3
"""Records and tables of the benchmarks. Called by tools/bench.sh.

report.py groups                     of the names on standard input, one a line: a regular expression for each group that belongs together
report.py merge FOLDER RUN.json...   one record FOLDER/<cpu>-<isa>.json from several runs of several programs: medians; prints its path
report.py table RECORD.json          Markdown tables of a record
report.py readme                     writes the tables of every record in results/ to its README.md, and the goals of the latest one with
                                     AVX-512 into README.md here, between the markers
"""

import json
import math
import pathlib
import re
import statistics
import sys

HERE = pathlib.Path(__file__).resolve().parent
BEGIN, END = "<!-- begin goals -->", "<!-- end goals -->"


def slug(context):
    """File name of a record. Virtual machines hide the model's name but not its number."""
    cpu = re.sub(r"\((R|TM)\)|CPU|Processor|@.*(?=\(family)", " ", context["cpu"])
    cpu = re.sub(r"\(family (\w+), model (\w+)\)", r"family\1 model\2", cpu)
    return "-".join(re.findall(r"[a-z0-9]+", cpu.lower()) + [context["best_isa"]])


def group_of(name):
    """What differs only in instruction set, question and threads, of the narrow phase; of the rest, in instruction set and stage or library."""
    parts = name.split("/")
    if parts[0] in ("vertex_face", "edge_edge"):
        return (parts[0], *parts[2:5])
    if parts[0] == "queries":
        return tuple(parts[:2])
    if parts[0] in ("stage", "search", "peer"):
        return (*parts[:2], next(part for part in reversed(parts) if part not in ("manual_time", "real_time")))
    return (parts[0],)


def print_groups(names):
    groups = {}
    for name in names:
        groups.setdefault(group_of(name), []).append(name)
    for group in groups.values():
        print("^(" + "|".join(group) + ")$")


def name_of(benchmark):
    return re.sub(r"/(manual_time|real_time)$", "", benchmark["run_name"])


def time_of(benchmark):
    """The time that its rates are of: processor time, unless the name says otherwise."""
    return "cpu_time" if name_of(benchmark) == benchmark["run_name"] else "real_time"


def refuse_other_answers(benchmarks):
    """A fast wrong answer is no result: the same pairs have the same contacts and the same earliest one, whatever the layout, instruction
    set, number of threads and form of the answer, in every round."""
    answers = {}

    def refuse_unless_equal(name, pairs, what, answer):
        first = answers.setdefault((*pairs, what), answer)
        if first != answer:
            sys.exit(f"{name}: {what} is {answer!r}, of the same pairs elsewhere {first!r}")

    for benchmark in benchmarks:
        name = name_of(benchmark)
        if name.startswith("queries/"):
            _, kind, _, data = name.split("/", 3)
            refuse_unless_equal(name, (kind, data), "contacts", benchmark["contacts"])
        elif name.startswith(("vertex_face/", "edge_edge/")):
            kind, _, data, _, scalar, *question = name.split("/")
            separation = question[0].startswith("separation")  # or threads:N, where one time per pair is asked for
            for what in ("contacts", "earliest_pair", "earliest_toi"):
                if what in benchmark:  # the earliest contact alone counts no others
                    refuse_unless_equal(name, (kind, data, scalar, separation), what, benchmark[what])


def aggregates(rounds):
    """Of one benchmark in every round, as Google Benchmark writes them: the median is the result, the coefficient of variation of the
    time that its rates are of says how far to trust it."""
    first = rounds[0]
    common = {"run_name": first["run_name"], "run_type": "aggregate", "repetitions": len(rounds), "time_unit": first["time_unit"]}
    same = {"name", "family_index", "per_family_instance_index", "repetition_index", "threads", *common}
    medians = {key: statistics.median(benchmark[key] for benchmark in rounds) for key in first if key not in same}
    time = time_of(first)
    times = [benchmark[time] for benchmark in rounds]
    variation = statistics.stdev(times) / statistics.mean(times) if len(times) > 1 else 0.0
    return [{"name": first["run_name"] + "_median", **common, "aggregate_name": "median", **medians},
            {"name": first["run_name"] + "_cv", **common, "aggregate_name": "cv", time: variation}]


def merge(folder, runs):
    runs = [json.loads(pathlib.Path(run).read_text()) for run in runs]
    # In the order of the programs, not of turns.
    benchmarks = [b for run in runs for b in sorted(run["benchmarks"], key=lambda b: b["family_index"])]
    refuse_other_answers(benchmarks)
    rounds = {}
    for benchmark in benchmarks:
        rounds.setdefault(benchmark["run_name"], []).append(benchmark)
    # Which computer and folder it was is nobody's business; the load tells how quiet the machine was.
    context = {key: value for key, value in runs[0]["context"].items() if key not in ("host_name", "executable")}
    record = {"context": context, "benchmarks": [row for found in rounds.values() for row in aggregates(found)]}
    path = pathlib.Path(folder) / (slug(context) + ".json")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(record, indent=1) + "\n")
    print(path)


def rows_of(record):
    """Medians by name, each with the coefficient of variation of its time as `spread`."""
    rows = {}
    for b in record["benchmarks"]:
        name = name_of(b)
        if b["aggregate_name"] == "median":
            rows.setdefault(name, {}).update(b)
        else:
            rows.setdefault(name, {})["spread"] = b.get(time_of(b), b.get("real_time"))  # some older records have this alone
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


def products_of_a_core(rows):
    """Products per second of one thread that is left alone, as most are: the median. None in records without them."""
    return statistics.median(found) if (found := [row["products/s"] for name, row in rows.items()
                                                  if name.endswith("/threads:1") and "products/s" in row]) else None


def cores_of(row, core):
    """How many cores the threads of a row had, in products."""
    return row["products/s"] / core if core and "products/s" in row else None


def narrow_phase_table(rows, isas):
    core = products_of_a_core(rows)
    pattern = (r"(?P<kind>vertex_face|edge_edge)/(?P<isa>\w+)/(?P<data>[^/]+)/(?P<layout>\w+)/(?P<scalar>\w+)"
               r"(?:/(?P<question>\w+))?/threads:(?P<threads>\d+)")
    out = []
    for (kind, data, layout, scalar, question, threads), found in group_by_isa(rows, pattern).items():
        best = found.get(isas[-1]) or list(found.values())[-1]
        out.append([kind, data, f"{layout} {scalar}", question or "dense", threads]
                   + [number(found.get(isa, {}).get("pairs/s"), 1e-6) for isa in isas]
                   + [number(best.get("limit_bytes/s"), 1e-9), percent(best.get("limit_fraction")), number(cores_of(best, core)),
                      number(best.get("contacts"), digits=1), percent(best.get("scalar_share")), percent(best.get("spread"))])
    header = (["kind", "data", "layout", "question", "threads"] + [f"{isa}, M pairs/s" for isa in isas]
              + ["limit, GB/s", "of limit", "cores", "contacts", "scalar path", "spread"])
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


def query_table(rows, isas):
    pattern = r"queries/(?P<kind>\w+)/(?P<isa>\w+)/(?P<set>.+)"
    out = []
    for (kind, name), found in group_by_isa(rows, pattern).items():
        best = found.get(isas[-1]) or list(found.values())[-1]
        out.append([kind, name, number(best["pairs"], digits=1), number(best["contacts"], digits=1), percent(best["scalar_share"])]
                   + [number(found.get(isa, {}).get("s/pair"), 1e9) for isa in isas] + [percent(best.get("spread"))])
    return ["kind", "set", "pairs", "contacts", "scalar path"] + [f"{isa}, ns/pair" for isa in isas] + ["spread"], out


def peer_table(rows):
    out = []
    for name, row in rows.items():
        if match := re.fullmatch(r"peer/(\w+)/([^/]+)/([^/]+)", name):
            kind, peer, data = match.groups()
            out.append([kind, data, peer, number(row["pairs/s"], 1e-6), number(1e9 / row["pairs/s"]),
                        number(row["contacts"], digits=1), number(row.get("missed"), digits=1),
                        number(row.get("extra"), digits=1), percent(row.get("spread"))])
    return ["kind", "data", "library", "M pairs/s", "ns/pair", "contacts", "missed", "extra", "spread"], out


def goal_table(rows):
    """What the pipeline is meant to reach with AVX-512, and what this record has of it. Ratios are of one record."""
    def row(kind, data, layout="blocked", question="", threads=1, isa="avx512"):
        parts = [kind, isa, data, layout, "double", *([question] if question else []), f"threads:{threads}"]
        return rows.get("/".join(parts), {})

    def rate(*args, **kwargs):
        return row(*args, **kwargs).get("pairs/s")

    def ratio(a, b):
        return a / b if a and b else None

    core = products_of_a_core(rows)

    def millions(value):
        return number(value, 1e-6)

    def nanoseconds(value):
        return number(value, 1e9)

    kinds, scenes = ("vertex_face", "edge_edge"), ("cloth-ball", "n-body")

    def of_kinds(value):
        return {kind.replace("_", "-"): value(kind) for kind in kinds}

    def of_scenes(value, names=scenes):
        return {f"{kind.replace('_', '-')} {data}": value(kind, data) for kind in kinds for data in names}

    def share_of_search(kind, data):
        return rows.get(f"search/{kind}/avx512/undecided/{data}", {}).get("of_time")

    def two_threads_over_one():
        found = {}
        for kind in kinds:
            cores = cores_of(row(kind, "random", threads=2), core)
            of_cores = f" ({number(cores)} cores)" if cores else ""
            found[kind.replace("_", "-") + of_cores] = ratio(rate(kind, "random", threads=2), rate(kind, "random"))
        return found

    def worst_query_set(kind):
        times = [row["s/pair"] for name, row in rows.items() if name.startswith(f"queries/{kind}/avx512/")]
        return max(times, default=None)

    layouts = ("blocked", "packed"), ("indexed", "indexed")

    def earliest_over_dense(layout):
        return lambda kind, data: ratio(rate(kind, data, layout, "earliest"), rate(kind, data, layout))

    def earliest_seconds(layout):
        return lambda kind, data: ratio(1.0, rate(kind, data, layout, "earliest"))

    # What, at least or at most, how much, what was found, how to write numbers.
    goals = [
        ("random pairs, packed, M pairs/s", min, 60e6, {"vertex-face": rate("vertex_face", "random")}, millions),
        ("rate of random edge-edge pairs over vertex-face", min, 0.7, {"": ratio(rate("edge_edge", "random"), rate("vertex_face", "random"))}, percent),
        ("AVX2 over AVX-512, random pairs", min, 0.6, of_kinds(lambda kind: ratio(rate(kind, "random", isa="avx2"), rate(kind, "random"))), percent),
        ("scenes, packed, of the streaming limit", min, 0.85, of_scenes(lambda kind, data: row(kind, data).get("limit_fraction")), percent),
        ("the same, contacts alone, without one time per pair", min, 0.85,
         of_scenes(lambda kind, data: row(kind, data, question="contacts").get("limit_fraction")), percent),
        ("cloth-ball, indexed, M pairs/s", min, 110e6, {"vertex-face": rate("vertex_face", "cloth-ball", "indexed")}, millions),
        ("n-body, indexed, M pairs/s", min, 160e6, {"vertex-face": rate("vertex_face", "n-body", "indexed")}, millions),
        *((f"earliest contact over one time per pair, rates, {name}", min, 1.0, of_scenes(earliest_over_dense(layout)), percent)
          for layout, name in layouts),
        *((f"earliest contact, {name}, ns a pair", max, 6e-9, of_scenes(earliest_seconds(layout)), nanoseconds) for layout, name in layouts),
        ("certificates on data in L2, ns a pair", max, 3.5e-9,
         of_scenes(lambda kind, data: rows.get(f"stage/{kind}/avx512/certificates/{data}", {}).get("s/pair"), ("random", "generated")), nanoseconds),
        ("two threads over one, random pairs", min, 1.85, two_threads_over_one(), number),
        ("two threads, scenes packed, of their streaming limit", min, 0.9,
         of_scenes(lambda kind, data: row(kind, data, threads=2).get("limit_fraction")), percent),
        ("certified search, share of the time", max, 0.02, of_scenes(share_of_search, ("generated", "grids", *scenes, "cloth-funnel")), percent),
        ("worst set of public queries, ns a pair", max, 2e-6, of_kinds(worst_query_set), nanoseconds),
    ]
    out = []
    for what, worse, wanted, found, write in goals:
        found = {label: value for label, value in found.items() if value is not None}
        if found:
            held = sum(worse(value, wanted) == wanted for value in found.values())
            out.append([what, f"at {'least' if worse is min else 'most'} {re.sub(r'[.]0+$', '', write(wanted))}",
                        ", ".join(f"{label} {write(value)}".strip() for label, value in found.items()), f"{held} of {len(found)}"])
    return ["goal, with AVX-512", "wanted", "measured", "held"], out


def mesh_table(rows):
    out = [[what.replace("_", " "), name, number(row["vertices"], digits=1), number(1e3 * row["vertices"] / row["vertices/s"]),
            percent(row.get("spread"))]
           for full_name, row in rows.items()
           for what, _, name in [full_name.partition("/")] if what in ("moving_mesh", "mesh_boxes")]
    return ["what is made", "data", "vertices", "ms", "spread"], out


def origin(context):
    return (f"{context['cpu']}, {context['num_cpus']} threads, {context['compiler']}, `{context['flags']}`, "
            f"{context['date'][:10]}, commit {context.get('commit', 'unknown')}, "
            f"load average at the start {context['load_avg'][0]:.1f}.\n")


def tables(record):
    rows = rows_of(record)
    isas = record["context"]["isas"].split()
    text = origin(record["context"])
    for title, (header, body) in (("Goals", goal_table(rows)), ("Narrow phase", narrow_phase_table(rows, isas)),
                                  ("Moving mesh", mesh_table(rows)), ("Stages", stage_table(rows, isas)), ("Certified search", search_table(rows, isas)),
                                  ("Public queries, one thread, in cache", query_table(rows, isas)), ("Peers, one thread", peer_table(rows))):
        if body:
            text += f"\n#### {title}\n\n" + table(header, body)
    return text


def write_readme():
    records = {path.stem: json.loads(path.read_text()) for path in sorted((HERE / "results").glob("*.json"))}
    text = ("# Results\n\nWritten by `tools/bench.sh` from the records beside it; [../README.md](../README.md) says what is measured. The report of speed\n"
            "against error is in `report/`, what `tools/run.sh` printed in `run.txt`, what `truth_test` printed in `truth.txt` and, as a table, in `sets.md`.\n\n")
    text += "".join(f"- [{name}](#{name})\n" for name in records)
    (HERE / "results" / "README.md").write_text(text + "".join(f"\n### {name}\n\n{tables(record)}" for name, record in records.items()))

    with_goals = [record for record in records.values() if record["context"]["best_isa"] == "avx512"]
    if not with_goals:
        return
    latest = max(with_goals, key=lambda record: record["context"]["date"])
    readme = HERE / "README.md"
    before, rest = readme.read_text().split(BEGIN)
    readme.write_text(before + BEGIN + "\n" + origin(latest["context"]) + "\n" + table(*goal_table(rows_of(latest))) + END + rest.split(END)[1])


def main(arguments):
    match arguments:
        case ["groups"]:
            print_groups(sys.stdin.read().split())
        case ["merge", folder, *runs] if runs:
            merge(folder, runs)
        case ["table", path]:
            print(tables(json.loads(pathlib.Path(path).read_text())))
        case ["readme"]:
            write_readme()
        case _:
            sys.exit(__doc__)


main(sys.argv[1:])

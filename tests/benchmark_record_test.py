"""How rounds of benchmarks become a record, and which are refused. Argument: bench/report.py."""
import json
import pathlib
import subprocess
import sys
import tempfile

CONTEXT = {"cpu": "Some CPU @ 3.0GHz (family 1, model 2)", "num_cpus": 2, "compiler": "none", "flags": "-O3", "date": "2000-01-01T00:00:00", "commit": "c",
           "isas": "scalar avx512", "best_isa": "avx512", "load_avg": [0.5], "host_name": "secret", "executable": "/secret"}
SLOW, FAST = "vertex_face/scalar/random/blocked/double/threads:1", "vertex_face/avx512/random/blocked/double/threads:1"


def report(*arguments, text=None):
    return subprocess.run([sys.executable, sys.argv[1], *arguments], input=text, capture_output=True, text=True)


def row(name, milliseconds, index, contacts=7):
    return {"name": name + "/manual_time", "family_index": index, "per_family_instance_index": 0, "run_name": name + "/manual_time",
            "run_type": "iteration", "repetitions": 1, "repetition_index": 0, "threads": 1, "iterations": 10, "real_time": milliseconds,
            "cpu_time": milliseconds, "time_unit": "ms", "contacts": contacts, "earliest_pair": 3, "earliest_toi": 0.5,
            "pairs/s": 1e9 / milliseconds, "limit_fraction": 0.5}


def write(folder, rounds):
    paths = []
    for k, rows in enumerate(rounds):
        paths.append(pathlib.Path(folder) / f"run_{k}.json")
        paths[-1].write_text(json.dumps({"context": CONTEXT, "benchmarks": rows}))
    return [str(path) for path in paths]


with tempfile.TemporaryDirectory() as folder:
    # Three rounds, in each of which turns are taken in another order.
    runs = write(folder, [[row(FAST, 2, 1), row(SLOW, 10, 0)], [row(SLOW, 30, 0), row(FAST, 3, 1)], [row(FAST, 4, 1), row(SLOW, 11, 0)]])
    merged = report("merge", folder, *runs)
    assert merged.returncode == 0, merged.stderr
    path = pathlib.Path(merged.stdout.strip())
    assert path.name == "some-family1-model2-avx512.json", path
    record = json.loads(path.read_text())
    assert "secret" not in path.read_text()
    found = [(b["name"], b["real_time"]) for b in record["benchmarks"]]
    assert [name for name, _ in found] == [f"{name}/manual_time_{what}" for name in (SLOW, FAST) for what in ("median", "cv")], found
    times = [time for _, time in found]
    assert times[0] == 11 and times[2] == 3, times
    assert abs(times[1] - (127.0 ** 0.5) / 17) < 1e-12 and abs(times[3] - 1 / 3) < 1e-12, times  # of 10, 30, 11 and of 2, 3, 4
    assert record["benchmarks"][2]["pairs/s"] == 1e9 / 3

    table = report("table", str(path)).stdout
    assert "| vertex_face | random | blocked double | dense | 1 | 90.9 | 333 |" in table, table
    assert "| random pairs, packed, M pairs/s | at least 60 | vertex-face 333 | 1 of 1 |" in table, table

    # Rates of processor time have the spread of that.
    rounds = []
    for cpu_time in (2, 3, 4):
        stage = {**row(FAST, 100, 0), "run_name": "stage/vertex_face/avx512/screening/random", "cpu_time": cpu_time,
                 "s/pair": cpu_time * 1e-9, "kept": 0.5}
        rounds.append([stage])
    stages = pathlib.Path(report("merge", str(pathlib.Path(folder) / "stages"), *write(folder, rounds)).stdout.strip())
    table = report("table", str(stages)).stdout
    assert "| vertex_face | random | screening |  | 3.00 | 50 % | 33 % |" in table, table

    # A wrong answer in one round is no result, though the median of three would hide it.
    runs = write(folder, [[row(SLOW, 10, 0), row(FAST, 2, 1)], [row(SLOW, 10, 0), row(FAST, 2, 1, contacts=8)], [row(SLOW, 10, 0), row(FAST, 2, 1)]])
    before = path.read_text()
    refused = report("merge", folder, *runs)
    assert refused.returncode == 1 and f"{FAST}: contacts is 8, of the same pairs elsewhere 7" in refused.stderr, refused
    assert path.read_text() == before

groups = report("groups", text=f"{SLOW}\n{FAST}\nvertex_face/avx512/random/indexed/double/threads:1\n").stdout.split()
assert groups == [f"^({SLOW}|{FAST})$", "^(vertex_face/avx512/random/indexed/double/threads:1)$"], groups
assert report("something").returncode == 1

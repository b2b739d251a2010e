"""Runs the benchmarks beside their peers and prints a table.

    scripts/bench                   all of them
    scripts/bench --only NAME       those whose figures are called NAME or NAME.something; may be repeated
    scripts/bench --json FILE       also writes [{"name", "value", "unit", "peer", "peer_value", "ratio", "goal"}]
    scripts/bench --build DIR       the executables of this build, as they are, instead of an up-to-date release build

A goal is the most that the ratio to the peer may be, or the value where there is no peer. A goal that is missed is
marked and is no failure: the exit code is 1 only where something could not be run. Ratios mean something on a busy
machine, seconds do not: the load is printed above the table.
"""

import argparse
import json
import os
import shlex
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
KEYS = ("name", "value", "unit", "peer", "peer_value", "ratio", "goal")
TIMEOUT = 1800  # seconds


@dataclass
class Benchmark:
    names: list[str]  # of its figures
    program: str  # of bin/ in the build, or of tests/benchmarks/, where it ends in .py
    scene: str  # empty: it makes its own
    arguments: list[str] = field(default_factory=list)
    python: str = "bpy"  # the environment in build/ that programs in Python run in

    def chosen(self, only: list[str]) -> bool:
        return not only or any(name == o or name.startswith(o + ".") for name in self.names for o in only)


def ray_casting(scene: str, light: str, goal: float) -> Benchmark:
    name = f"ray_casting.{scene}"
    arguments = ["--name", name, "--goal", str(goal), "--light", *light.split()]
    return Benchmark([name], "ray_bench", scene, arguments)


def ray_tracing(scene: str, goal: float) -> Benchmark:
    name = f"ray_tracing.{scene}"
    return Benchmark([name], "ray_bench", scene, ["--name", name, "--goal", str(goal), "--method", "ray_tracing"])


def raster(name: str, goal: float, *arguments: str) -> Benchmark:
    name = f"raster.{name}"
    return Benchmark([name], "raster_bench", "", ["--name", name, "--goal", str(goal), *arguments])


def cycles(scene: str) -> list[Benchmark]:
    name = f"ray_tracing.cycles.{scene}"
    return [
        Benchmark([f"{name}{end}"], "cycles_bench.py", "", [scene, *option])
        for end, option in (("", []), (".rough", ["--rough"]))
    ]


# Lights stand where the camera sees their shadows; metres, Z up.
BENCHMARKS = [
    ray_casting("tower_of_meshes", "-4 -17.5 8.5", 1.5),
    ray_casting("gallery", "5 5 3.8", 2),
    ray_casting("cornell_box", "0.278 -0.1 0.5", 4),
    ray_tracing("tower_of_meshes", 1.5),
    ray_tracing("gallery", 2),
    ray_tracing("still_life", 2),
    ray_tracing("whitted_spheres", 4),
    Benchmark(["lamps"], "lamps_bench", "", ["--goal", "10"]),
    Benchmark(["ray_tracing.povray"], "povray_bench.py", ""),
    *cycles("whitted_spheres"),
    *cycles("still_life"),
    Benchmark(
        ["load.tower_of_meshes", "memory.tower_of_meshes"],
        "load_bench",
        "tower_of_meshes",
        ["--name", "load.tower_of_meshes", "--load-goal", "1", "--memory-goal", "2.2"],
    ),
    raster("phong_1m", 0.25, "--side", "289"),
    raster("phong_100k", 0.333, "--side", "91"),
    raster("phong_layers", 0.4, "--shape", "layers"),
    raster("phong_1m_4_samples", 0.25, "--side", "289", "--samples", "4"),
    raster("wireframe_1m", 0.25, "--side", "289", "--method", "wireframe"),
    raster("hidden_line_1m", 0.25, "--side", "289", "--method", "hidden_line"),
    Benchmark(["raster.scaling"], "raster_bench", "", ["--name", "raster.scaling", "--shape", "scaling"]),
    Benchmark(
        ["radiosity.cornell_box"],
        "radiosity_bench",
        "cornell_box",
        ["--tolerance", "0.01", "--size", "192", "--error-goal", "0.01", "--seconds-goal", "2"],
    ),
    Benchmark(["radiosity.links"], "links_bench.py", ""),
    Benchmark(["radiosity.form_factors"], "form_factors_bench.py", "", python="viewfactor"),
    Benchmark(["radiosity.shot"], "shot_bench", "cornell_box", ["--goal", "1.5"]),
    Benchmark(["radiosity.view"], "view_bench", "cornell_box", ["--element-size", "0.006", "--goal", "1"]),
    Benchmark(["edit", "cancel"], "edit_bench", "gallery", ["--edit-goal", "0.1", "--cancel-goal", "0.1"]),
]


class BenchError(Exception):
    pass


def call(command: list[str]) -> None:
    """Runs a command whose output is for the reader, on standard error."""
    print("$", shlex.join(command), file=sys.stderr, flush=True)
    try:
        subprocess.run(command, cwd=ROOT, stdout=sys.stderr, check=True)
    except OSError as error:
        raise BenchError(f"{command[0]}: {error.strerror}") from error
    except subprocess.CalledProcessError as error:
        raise BenchError(f"{command[0]} ended with exit code {error.returncode}") from error


def build() -> Path:
    directory = ROOT / "build"
    if not (directory / "build.ninja").is_file():
        call(["cmake", "--preset", "release"])
    call(["cmake", "--build", "--preset", "release", "--target", "benchmarks"])
    return directory


def scene_file(name: str) -> Path:
    committed = ROOT / "scenes" / f"{name}.glb"
    return committed if committed.is_file() else ROOT / "build" / "scenes" / f"{name}.glb"


def rows_of(benchmark: Benchmark, directory: Path, threads: int, repeats: int) -> list[dict]:
    command = [str(directory / "bin" / benchmark.program)]
    if benchmark.program.endswith(".py"):
        # Blender as a module, which is built nowhere and stands in the one place.
        python = ROOT / "build" / benchmark.python / "bin/python"
        program = ROOT / "tests/benchmarks" / benchmark.program
        command = [str(python), str(program), "--build", str(directory)]
    command += [str(scene_file(benchmark.scene))] if benchmark.scene else []
    command += [*benchmark.arguments, "--threads", str(threads), "--repeats", str(repeats)]
    try:
        done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True, timeout=TIMEOUT)
        rows = [json.loads(line) for line in done.stdout.splitlines()]
        return [{key: row[key] for key in KEYS} for row in rows]
    except OSError as error:
        raise BenchError(f"{command[0]}: {error.strerror}") from error
    except subprocess.CalledProcessError as error:
        raise BenchError(f"{shlex.join(command)} ended with exit code {error.returncode}") from error
    except subprocess.TimeoutExpired as error:
        raise BenchError(f"{shlex.join(command)} took longer than {TIMEOUT} s") from error
    except (ValueError, KeyError, TypeError) as error:
        raise BenchError(f"{shlex.join(command)} printed what is not a figure: {error}") from error


def goal_met(row: dict) -> bool | None:
    """None where there is no goal."""
    if row["goal"] is None:
        return None
    reached = row["value"] if row["ratio"] is None else row["ratio"]
    return reached is not None and reached <= row["goal"]


def number(value: float | None) -> str:
    return "" if value is None else f"{value:.4g}"


def print_table(rows: list[dict]) -> None:
    cells = [("", "value", "", "peer", "", "ratio", "goal", "")]
    for row in rows:
        mark = {None: "", True: "met", False: "MISSED"}[goal_met(row)]
        texts = [number(row[key]) for key in ("value", "peer_value", "ratio", "goal")]
        cells.append((row["name"], texts[0], row["unit"], texts[1], row["peer"] or "", texts[2], texts[3], mark))
    widths = [max(len(line[column]) for line in cells) for column in range(len(cells[0]))]
    to_the_right = {1, 3, 5, 6}
    for line in cells:
        aligned = [
            text.rjust(width) if column in to_the_right else text.ljust(width)
            for column, (text, width) in enumerate(zip(line, widths, strict=True))
        ]
        print("  ".join(aligned).rstrip())


def load() -> str:
    return " ".join(f"{value:.2f}" for value in os.getloadavg())


def main() -> int:
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser("scripts/bench", description=__doc__, formatter_class=raw)
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures here")
    parser.add_argument("--only", action="append", default=[], metavar="NAME", help="these figures")
    parser.add_argument("--build", type=Path, metavar="DIR", help="a build directory, taken as it is")
    parser.add_argument("--threads", type=int, default=2, help="of both sides (default: 2)")
    parser.add_argument("--repeats", type=int, default=5, help="medians of so many (default: 5)")
    options = parser.parse_args()
    chosen = [benchmark for benchmark in BENCHMARKS if benchmark.chosen(options.only)]
    if not chosen:
        names = ", ".join(name for benchmark in BENCHMARKS for name in benchmark.names)
        parser.error(f"--only: no figure is called {', '.join(options.only)}; there are {names}")

    rows: list[dict] = []
    failures = 0
    try:
        directory = options.build.resolve() if options.build else build()
    except BenchError as error:
        print(f"bench: error: {error}", file=sys.stderr)
        return 1
    before = load()
    for benchmark in chosen:
        print(f"{', '.join(benchmark.names)} ...", file=sys.stderr, flush=True)
        try:
            rows += rows_of(benchmark, directory, options.threads, options.repeats)
        except BenchError as error:
            print(f"bench: error: {error}", file=sys.stderr)
            failures += 1
    print(f"{options.threads} threads, medians of {options.repeats}; load {before} before, {load()} after")
    print_table(rows)
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())

# SPDX-License-Identifier: GPL-3.0-or-later
"""The form-factor matrix of a furnished room beside pyviewfactor 1.1.0: about 1000 quads, with what stands between.

Ours is the whole process of `triptych form-factors`, from the scene's file to NumPy's, for each kind of form factors;
the peer's is compute_viewfactor_matrix() alone, once its code is compiled. CPU seconds of all threads; medians; the
sides alternate.

Errors, of both sides:

    row_sums   RMS over the rows of Σ_j F_ij − 1
    symmetry   of A_i F_ij − A_j F_ji, RMS, beside the RMS of A_i F_ij: what reciprocity finds wrong
    factors    of F_ij in 24 rows, RMS, beside the RMS of F_ij, against rows of 2²² rays each

Runs in a Python that has pyviewfactor (scripts/setup --bench).
"""

import os
import resource
import subprocess
from statistics import median

import numpy as np
from figures import arguments, cpu_seconds, figure
from room import box, room, write_glb

# Settings by kind of form factors, as coarse as their errors allow.
KINDS = {
    "analytic": {},
    "hemisphere": {"radiosity.rays": 1024},
    "hemicube": {"radiosity.hemicube_resolution": 256},
}
ROW_SUM_GOAL = 8.4e-4  # a tenth of the peer's in a room with one box in it
PEER = "pyviewfactor 1.1.0"


class Bench:
    def __init__(self, options):
        self.folder = options.build.resolve() / "bench"
        self.folder.mkdir(parents=True, exist_ok=True)
        self.program, self.threads = options.build.resolve() / "bin" / "triptych", options.threads
        dark, lamp = room()
        self.quads = np.concatenate([dark, lamp])
        # The side of a surface that light reaches is the one that has form factors.
        write_glb(self.folder / "room.glb", [(dark, 0), (lamp, 1)])
        a, b, c, _ = np.moveaxis(self.quads, 1, 0)
        self.areas = np.linalg.norm(np.cross(b - a, c - b), axis=1)  # of rectangles

    def ours(self, kind, settings, rows=()):
        """CPU seconds and the matrix, or these rows of it."""
        command = [str(self.program), "form-factors", "room.glb", "--output", "room.npy", "--quiet"]
        command += ["--rows", ",".join(map(str, rows))] if len(rows) else []
        for name, value in {"radiosity.form_factors": kind, "threads": self.threads, **settings}.items():
            command += ["--set", f"{name}={value}"]
        before = cpu_seconds(resource.RUSAGE_CHILDREN)
        subprocess.run(command, cwd=self.folder, check=True)
        return cpu_seconds(resource.RUSAGE_CHILDREN) - before, np.load(self.folder / "room.npy")

    def errors(self, matrix, rows, reference):
        def rms(values):
            return float(np.sqrt(np.mean(np.square(values))))

        power = matrix * self.areas[:, None]
        return {
            "row_sums": rms(matrix.sum(axis=1) - 1),
            "symmetry": rms(power - power.T) / rms(power),
            "factors": rms(matrix[rows] - reference) / rms(reference),
        }


class Peer:
    """pyviewfactor, warmed up: it compiles itself where it is first used."""

    def __init__(self, threads):
        os.environ["NUMBA_NUM_THREADS"] = str(threads)
        import pyviewfactor
        import pyvista

        self.mesh_of, self.compute = pyvista.PolyData, pyviewfactor.compute_viewfactor_matrix
        self.matrix(box((0, 0, 0), (1, 1, 1), (1, 1, 1), inward=True))

    def matrix(self, quads):
        """CPU seconds and the matrix."""
        faces = np.insert(np.arange(4 * len(quads)).reshape(-1, 4), 0, 4, axis=1)
        mesh = self.mesh_of(quads.reshape(-1, 3), faces.ravel())
        before = cpu_seconds()
        matrix = self.compute(mesh, obstacles=[mesh])
        return cpu_seconds() - before, np.asarray(matrix).T  # its columns are the quads that light leaves


def main():
    options = arguments(__doc__).parse_args()
    bench, peer = Bench(options), Peer(options.threads)
    count = len(bench.quads)
    rows = np.linspace(0, count - 1, 24).astype(int)
    _, reference = bench.ours("hemisphere", {"radiosity.rays": 2**22}, rows)

    costs = {kind: [] for kind in [*KINDS, PEER]}
    matrices = {}
    for _ in range(options.repeats):
        for kind in costs:
            cost, matrices[kind] = bench.ours(kind, KINDS[kind]) if kind in KINDS else peer.matrix(bench.quads)
            costs[kind].append(cost)
    errors = {kind: bench.errors(matrix, rows, reference) for kind, matrix in matrices.items()}

    name = "radiosity.form_factors"
    figure(f"{name}.quads", count, "quads")
    for kind in KINDS:
        figure(f"{name}.{kind}", median(costs[kind]), "CPU s", PEER, median(costs[PEER]), goal=1 / 15)
        figure(f"{name}.{kind}.row_sums", errors[kind]["row_sums"], "RMS", goal=ROW_SUM_GOAL)
        for what in ("symmetry", "factors"):
            figure(f"{name}.{kind}.{what}", errors[kind][what], "of the RMS", PEER, errors[PEER][what])
    figure(f"{name}.pyviewfactor.row_sums", errors[PEER]["row_sums"], "RMS")


if __name__ == "__main__":
    main()

# The phase-field problem of a scene as a user of FEniCSx (dolfinx 0.5) writes it: UFL forms that are compiled once, vectorised throughout,
# PETSc for the linear systems. Bilinear quadrilaterals, 2 x 2 Gauss points with the history H at them, AT2, the seed paper's split, staggered.
#   explicit   central differences with lumped mass; one linear system a step, for psi
#   newmark    beta 1/4, gamma 1/2; passes between u and psi until psi moves by less than 1e-4
# Linear systems by conjugate gradients with Jacobi from the last solution, or by a sparse factorisation (what dolfinx does unless told otherwise).
# Isotropic materials, velocities on whole sides, no plasticity. Writes seconds of the run (compiling left out), time to failure, peak and psi.
import argparse
import json
import logging
import sys
import time

import basix
import numpy as np
import ufl
from dolfinx import fem, mesh
from dolfinx.fem import petsc
from mpi4py import MPI
from petsc4py import PETSc

logging.disable(logging.INFO)  # of the form compiler
QUICK = {"cffi_extra_compile_args": ["-O3", "-march=native"]}  # of the compiled forms


class Scene:
    def __init__(self, path):
        text = json.load(open(path))
        material, settings = text["material"], text.get("phase_field", {})
        young, nu = material["young"], material["poisson"]
        self.density, self.Gc = material["density"], material["Gc"]
        self.lam, self.mu = young * nu / ((1 + nu) * (1 - 2 * nu)), young / (2 * (1 + nu))
        self.w0, self.eta = material["characteristic_width"] / 2, settings.get("residual_stiffness", 1e-6)
        self.width, self.height = text["domain"]["width"], text["domain"]["height"]
        self.cells = settings.get("cells", [127, 127])
        self.cracks, self.horizon = text["cracks"], text["time"]["horizon"]
        self.pull = {side: load["normal_velocity"] for side, load in text["loads"].items() if load != "free"}
        h = min(self.width / self.cells[0], self.height / self.cells[1])
        self.edge = h / np.sqrt((self.lam + 3 * self.mu) / self.density)  # explicit step limit, s
        self.wave_time = h / np.sqrt((self.lam + 2 * self.mu) / self.density)  # of a P wave through a cell, s

    def slots(self):
        """Mask (rows, columns) of the four nodes of every cell that a crack runs through."""
        nx, nz = self.cells
        mask = np.zeros((nz + 1, nx + 1), bool)
        for x0, z0, x1, z1 in self.cracks:
            t = np.linspace(0, 1, 20000)
            i = np.clip((x0 + t * (x1 - x0)) / self.width * nx, 0, nx - 1e-9).astype(int)
            j = np.clip((z0 + t * (z1 - z0)) / self.height * nz, 0, nz - 1e-9).astype(int)
            for di in (0, 1):
                for dj in (0, 1):
                    mask[j + dj, i + di] = True
        return mask


class Plate:
    """Spaces, forms and solvers; everything that a step needs is made here."""

    def __init__(self, scene, integrator, solver):
        self.scene, self.solver = scene, solver
        s = scene
        nx, nz = s.cells
        box = [np.array([0.0, 0.0]), np.array([s.width, s.height])]
        self.mesh = mesh.create_rectangle(MPI.COMM_SELF, box, [nx, nz], mesh.CellType.quadrilateral)
        self.V, self.S = fem.VectorFunctionSpace(self.mesh, ("CG", 1)), fem.FunctionSpace(self.mesh, ("CG", 1))
        Q = fem.FunctionSpace(self.mesh, ufl.FiniteElement("Quadrature", self.mesh.ufl_cell(), 2, quad_scheme="default"))
        self.dx = ufl.Measure("dx", domain=self.mesh, metadata={"quadrature_degree": 2, "quadrature_scheme": "default"})
        self.u, self.psi, self.H = fem.Function(self.V), fem.Function(self.S), fem.Function(Q)
        self.v, self.a = np.zeros(self.u.x.array.size), np.zeros(self.u.x.array.size)
        self.cell_list = np.arange(nx * nz, dtype=np.int32)
        self.grid_of_nodes()
        self.make_forms()
        self.make_damage_solver()
        self.hold_sides()
        if integrator == "newmark":
            self.make_motion_solver(2.0 * s.wave_time)

    def grid_of_nodes(self):
        x = self.S.tabulate_dof_coordinates()
        nx, nz = self.scene.cells
        self.column = np.rint(x[:, 0] / self.scene.width * nx).astype(int)
        self.row = np.rint(x[:, 1] / self.scene.height * nz).astype(int)

    def field(self):
        """psi as (rows, columns), row 0 at the bottom."""
        out = np.empty((self.scene.cells[1] + 1, self.scene.cells[0] + 1))
        out[self.row, self.column] = self.psi.x.array[: self.row.size]
        return out

    def make_forms(self):
        s, dx, form = self.scene, self.dx, lambda f: fem.form(f, jit_params=QUICK)
        v, p, q = ufl.TestFunction(self.V), ufl.TrialFunction(self.S), ufl.TestFunction(self.S)
        eps, pos = ufl.sym(ufl.grad(self.u)), lambda x: ufl.max_value(x, 0.0)
        C11, C13 = s.lam + 2 * s.mu, s.lam
        drive = 0.5 * (C11 * (pos(eps[0, 0]) ** 2 + pos(eps[1, 1]) ** 2) + 2 * C13 * pos(eps[0, 0]) * pos(eps[1, 1]) + 4 * s.mu * eps[0, 1] ** 2)
        points, _ = basix.make_quadrature(basix.CellType.quadrilateral, 2)
        self.drive = fem.Expression(drive, points, jit_params=QUICK)
        stress = lambda w: s.lam * ufl.tr(ufl.sym(ufl.grad(w))) * ufl.Identity(2) + 2 * s.mu * ufl.sym(ufl.grad(w))
        g = (1 - s.eta) * (1 - self.psi) ** 2 + s.eta
        self.force_form = form(-g * ufl.inner(stress(self.u), ufl.sym(ufl.grad(v))) * dx)
        self.mean_stress_form = form(g * stress(self.u)[1, 1] * dx)
        self.psi_matrix_form = form(((s.Gc / s.w0 + 2 * self.H) * p * q + s.Gc * s.w0 * ufl.inner(ufl.grad(p), ufl.grad(q))) * dx)
        self.psi_vector_form = form(2 * self.H * q * dx)
        w = ufl.TrialFunction(self.V)
        self.mass_form, self.stiffness_form = form(s.density * ufl.inner(w, v) * dx), form(g * ufl.inner(stress(w), ufl.sym(ufl.grad(v))) * dx)
        one = fem.Constant(self.mesh, (1.0, 1.0))
        self.lumped_mass = petsc.assemble_vector(form(s.density * ufl.inner(one, v) * dx)).array.copy()
        self.force = fem.petsc.create_vector(self.force_form)
        self.psi_vector = fem.petsc.create_vector(self.psi_vector_form)

    def make_damage_solver(self):
        slots = self.scene.slots()[self.row, self.column]
        held = fem.Function(self.S)
        held.x.array[:] = 1.0
        self.psi_bc = [fem.dirichletbc(held, np.flatnonzero(slots).astype(np.int32))]
        self.psi_matrix = fem.petsc.create_matrix(self.psi_matrix_form)
        self.psi_solver = linear_solver(self.psi_matrix, self.solver)

    def hold_sides(self):
        """Vertical velocity of bottom and top, horizontal velocity of left and right: dofs of V, m/s outward."""
        nx, nz = self.scene.cells
        sides = {"left": (self.column == 0, 0, -1), "right": (self.column == nx, 0, 1), "bottom": (self.row == 0, 1, -1), "top": (self.row == nz, 1, 1)}
        dofs, speeds = [], []
        for side, speed in self.scene.pull.items():
            nodes, component, outward = sides[side]
            dofs.append(2 * np.flatnonzero(nodes) + component)
            speeds.append(np.full(dofs[-1].size, outward * speed))
        self.held, self.speed = np.concatenate(dofs), np.concatenate(speeds)

    def make_motion_solver(self, dt):
        self.dt = dt
        self.mass = petsc.assemble_matrix(self.mass_form)
        self.mass.assemble()
        self.stiffness = fem.petsc.create_matrix(self.stiffness_form)
        self.motion_matrix = self.mass.duplicate()
        self.motion_solver = linear_solver(self.motion_matrix, self.solver)

    # One pass of the damage equation: H from u, psi from H.
    def solve_damage(self):
        self.H.x.array[:] = np.maximum(self.H_before, self.drive.eval(self.cell_list).ravel())
        self.psi_matrix.zeroEntries()
        petsc.assemble_matrix(self.psi_matrix, self.psi_matrix_form, self.psi_bc)
        self.psi_matrix.assemble()
        assemble_into(self.psi_vector, self.psi_vector_form)
        petsc.apply_lifting(self.psi_vector, [self.psi_matrix_form], [self.psi_bc])
        petsc.set_bc(self.psi_vector, self.psi_bc)
        self.psi_solver.solve(self.psi_vector, self.psi.vector)

    def start(self):
        self.H_before = np.zeros(self.H.x.array.size)
        self.solve_damage()
        self.v[self.held] = self.speed

    def explicit_step(self, dt):
        self.v += dt * self.force.array / self.lumped_mass
        self.v[self.held] = self.speed
        self.u.x.array[:] += dt * self.v
        self.solve_damage()
        self.H_before[:] = self.H.x.array
        assemble_into(self.force, self.force_form)

    # (4 M / dt^2 + K) u = M (4 u_n / dt^2 + 4 v_n / dt + a_n), u of the held sides given; the passes share what they can.
    def newmark_step(self, dt):
        u_before, target = self.u.x.array.copy(), self.u.x.array[self.held] + dt * self.speed
        rhs, product = self.mass.createVecLeft(), self.mass.createVecLeft()
        rhs.array[:] = 4 / dt**2 * u_before + 4 / dt * self.v + self.a
        self.mass.mult(rhs, product)
        self.u.x.array[:] += dt * self.v
        for _ in range(20):
            before = self.psi.x.array.copy()
            self.solve_motion(product, target, dt)
            self.solve_damage()
            if np.abs(self.psi.x.array - before).max() < 1e-4:
                break
        self.H_before[:] = self.H.x.array
        a_before = self.a
        self.a = 4 / dt**2 * (self.u.x.array - u_before - dt * self.v) - a_before
        self.v = self.v + dt / 2 * (a_before + self.a)
        self.v[self.held], self.a[self.held] = self.speed, 0.0

    def solve_motion(self, inertia, target, dt):
        self.stiffness.zeroEntries()
        petsc.assemble_matrix(self.stiffness, self.stiffness_form)
        self.stiffness.assemble()
        self.mass.copy(self.motion_matrix, PETSc.Mat.Structure.SAME_NONZERO_PATTERN)
        self.motion_matrix.scale(4 / dt**2)
        self.motion_matrix.axpy(1.0, self.stiffness, PETSc.Mat.Structure.SAME_NONZERO_PATTERN)
        self.u.x.array[self.held] = target
        b = inertia.copy()
        self.motion_matrix.zeroRowsColumns(self.held.astype(np.int32), 1.0, self.u.vector, b)
        self.motion_solver.solve(b, self.u.vector)

    def mean_stress(self):
        return fem.assemble_scalar(self.mean_stress_form) / (self.scene.width * self.scene.height)


# Conjugate gradients with Jacobi: for these well-conditioned systems faster than hypre or a factorisation.
def linear_solver(matrix, kind):
    solver = PETSc.KSP().create(MPI.COMM_SELF)
    solver.setOperators(matrix)
    solver.setType("cg" if kind == "cg" else "preonly")
    solver.getPC().setType("jacobi" if kind == "cg" else "lu")
    solver.setTolerances(rtol=1e-8)
    solver.setInitialGuessNonzero(kind == "cg")
    return solver


def assemble_into(vector, form):
    with vector.localForm() as local:
        local.set(0.0)
    petsc.assemble_vector(vector, form)


def through_crack(psi):
    """psi > 0.9 joins left and right over eight neighbours."""
    open_ = psi > 0.9
    if not (open_[:, 0].any() and open_[:, -1].any()):
        return False
    reached = np.zeros_like(open_)
    reached[:, 0] = open_[:, 0]
    while True:
        wide = np.pad(reached, 1)
        rows, columns = open_.shape
        grown = open_ & np.any([wide[i : i + rows, j : j + columns] for i in range(3) for j in range(3)], axis=0)
        if grown[:, -1].any():
            return True
        if (grown == reached).all():
            return False
        reached = grown


def run(scene, integrator, solver, steps):
    plate = Plate(scene, integrator, solver)
    dt = 0.9 * scene.edge if integrator == "explicit" else plate.dt
    advance = plate.explicit_step if integrator == "explicit" else plate.newmark_step
    last = int(np.ceil(scene.horizon / dt)) if steps is None else steps
    peak, failed, told = 0.0, None, time.perf_counter()
    begun, cpu_begun = told, time.process_time()
    plate.start()
    n = 0
    while n < last and failed is None:
        advance(dt)
        n += 1
        if n % 4 == 0:
            peak = max(peak, plate.mean_stress())
        if through_crack(plate.field()):
            failed = n * dt
        if time.perf_counter() - told > 2.0:
            told = time.perf_counter()
            left = (told - begun) / n * (last - n)
            print(f"  step {n}, {n * dt * 1e6:.0f} us, {told - begun:.0f} s, at most {left:.0f} s left", file=sys.stderr)
    seconds, wall_s = time.process_time() - cpu_begun, time.perf_counter() - begun
    return dict(seconds=seconds, wall_s=wall_s, steps=n, dt=dt, peak_stress=peak, time_to_failure=failed or np.nan, psi=plate.field())


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("scene")
    parser.add_argument("output", help="results as .npz")
    parser.add_argument("--integrator", choices=["explicit", "newmark"], default="newmark")
    parser.add_argument("--solver", choices=["cg", "lu"], default="cg")
    parser.add_argument("--steps", type=int, help="stop after so many; else at the through crack or the horizon")
    given = parser.parse_args()
    np.savez(given.output, **run(Scene(given.scene), given.integrator, given.solver, given.steps))

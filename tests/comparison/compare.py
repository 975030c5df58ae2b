# fracfarm against FEniCSx on one scene: seconds, ratio, and the errors of both against references of fracfarm's own, with a quarter of the step
# on the same grid and on a grid twice as fine. `deploy/compare-fenicsx.sh` installs what it needs and runs it.
import argparse
import json
import os
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

# What FEniCSx is run as: explicit, the cheapest way to write it, and by Newmark, as the seed paper has it; each with the best solver that was found
# (conjugate gradients, Jacobi) and with dolfinx's own choice, a factorisation in every solve, of which a few steps are enough to tell.
FENICSX = [("explicit", "cg"), ("newmark", "cg"), ("explicit", "lu"), ("newmark", "lu")]
FACTORISED_STEPS = 6
HERE = os.path.dirname(os.path.abspath(__file__))


def say(text):
    print(text, file=sys.stderr, flush=True)


def fracfarm(programs, scene, folder, repeat=1, **settings):
    """Runs `fracfarm-solve` so often; the fastest run counts, all give the same numbers. None where it refuses the settings."""
    scene = json.loads(json.dumps(scene))
    scene.setdefault("phase_field", {}).update(settings)
    path, record = os.path.join(folder, "scene.json"), os.path.join(folder, "record.h5")
    json.dump(scene, open(path, "w"))
    runs = []
    for _ in range(repeat):
        done = subprocess.run([os.path.join(programs, "fracfarm-solve"), path, "-o", record, "--json", "--quiet"], stdout=subprocess.PIPE, text=True)
        if done.returncode == 2:
            return None
        if done.returncode != 0:
            raise SystemExit("fracfarm-solve ended with %d: %s" % (done.returncode, done.stdout))
        runs.append(json.loads(done.stdout))
    best = min(runs, key=lambda run: run["cpu_s"])
    psi = np.array(h5py.File(record, "r")["psi_failure"])
    return dict(seconds=best["cpu_s"], wall_s=best["wall_s"], steps=best["steps"], dt=best["dt"], kernel=best["kernel"],
                time_to_failure=best["time_to_failure"], peak_stress=best["peak_stress"], psi=psi)


def fenicsx(scene_path, folder, integrator, solver, steps):
    out = os.path.join(folder, "fenicsx.npz")
    script = os.path.join(HERE, "fenicsx_phase_field.py")
    command = [sys.executable, script, scene_path, out, "--integrator", integrator, "--solver", solver]
    command += ["--steps", str(steps)] if steps else []
    one_core = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
    if subprocess.run(command, env=one_core).returncode != 0:
        raise SystemExit("the FEniCSx script failed; is python3-dolfinx 0.5 there?")
    result = {name: np.load(out)[name] for name in ("seconds", "wall_s", "steps", "dt", "peak_stress", "time_to_failure", "psi")}
    row = {name: value.item() for name, value in result.items() if name != "psi"}
    row["time_to_failure"] = None if np.isnan(row["time_to_failure"]) else row["time_to_failure"]
    return dict(row, psi=result["psi"])


def dice(a, b):
    a, b = a > 0.5, b > 0.5
    return 2.0 * np.count_nonzero(a & b) / max(1, np.count_nonzero(a) + np.count_nonzero(b))


def errors(row, reference):
    """Relative errors of time and peak, and the overlap of the broken regions on the nodes that both grids have."""
    factor = (reference["psi"].shape[0] - 1) // (row["psi"].shape[0] - 1)
    late = lambda name: None if row[name] is None or reference[name] is None else row[name] / reference[name] - 1.0
    return dict(time_to_failure=late("time_to_failure"), peak_stress=late("peak_stress"), dice=dice(row["psi"], reference["psi"][::factor, ::factor]))


def compare(arguments, folder):
    scene = json.load(open(arguments.scene))
    cells = scene.get("phase_field", {}).get("cells", [127, 127])
    rows = {}
    say("fracfarm, double and float")
    for precision in ("double", "float"):
        rows["fracfarm " + precision] = fracfarm(arguments.programs, scene, folder, 5, precision=precision)
    if rows["fracfarm double"] is None:
        raise SystemExit("fracfarm-solve refuses the scene; see `fracfarm scene --check`")
    rows = {name: row for name, row in rows.items() if row}
    say("references: CFL 0.225 on the same grid, then on one twice as fine")
    references = {"CFL 0.225": fracfarm(arguments.programs, scene, folder, cfl=0.225, precision="double")}
    references["CFL 0.225, h/2"] = fracfarm(arguments.programs, scene, folder, cfl=0.225, cells=[2 * n for n in cells], precision="double")
    whole = {}  # steps of a whole run
    for integrator, solver in arguments.integrators:
        steps = arguments.steps or (FACTORISED_STEPS if solver == "lu" else None)
        say("FEniCSx, %s, %s%s" % (integrator, solver, ", %d steps" % steps if steps else ""))
        row = fenicsx(arguments.scene, folder, integrator, solver, steps)
        if not steps:
            whole[integrator] = row["steps"]
        row["whole_run_s"] = row["seconds"] / row["steps"] * whole[integrator] if integrator in whole else None
        rows["FEniCSx %s %s" % (integrator, solver)] = row
    for row in rows.values():
        row["ms_per_step"] = 1e3 * row["seconds"] / row["steps"]
        row["errors"] = {} if row["time_to_failure"] is None else {name: errors(row, reference) for name, reference in references.items()}
    for name, row in rows.items():
        if name.startswith("FEniCSx"):
            row["ratios"] = {own: dict(run=row["whole_run_s"] and row["whole_run_s"] / ours["seconds"], step=row["ms_per_step"] / ours["ms_per_step"])
                             for own, ours in rows.items() if own.startswith("fracfarm")}
    for row in list(rows.values()) + list(references.values()):
        del row["psi"]
    return dict(schema="fracfarm.comparison/1", scene=os.path.basename(arguments.scene), target_ratio=500, rows=rows, references=references)


def problems_of(arguments):
    """All that keeps the FEniCSx script from this scene, as key, value, allowed."""
    try:
        scene = json.load(open(arguments.scene))
    except (OSError, ValueError) as error:
        return [("scene", arguments.scene, "a scene file: %s" % error)]
    found = []
    material, loads, settings = scene.get("material"), scene.get("loads", {}), scene.get("phase_field", {})
    if not isinstance(material, dict) or not {"density", "young", "poisson", "Gc", "characteristic_width"} <= set(material):
        found.append(("material", json.dumps(material), "an object with density, young, poisson, Gc and characteristic_width"))
    elif {"yield", "hardening"} & set(material):
        found.append(("material.yield", material.get("yield"), "none: the FEniCSx script has no plasticity"))
    for side, load in loads.items():
        if load != "free" and (not isinstance(load, dict) or set(load) != {"normal_velocity"}):
            found.append(("loads." + side, json.dumps(load), '"free" or an object with normal_velocity alone'))
    for key in sorted(set(settings) - {"cells", "residual_stiffness"}):
        found.append(("phase_field." + key, json.dumps(settings[key]), "the default: the FEniCSx script knows cells and residual_stiffness"))
    if "horizon" not in scene.get("time", {}):
        found.append(("time.horizon", "missing", "seconds"))
    if arguments.steps is not None and arguments.steps < 1:
        found.append(("--steps", arguments.steps, "at least 1"))
    return found


def percent(value):
    return "%+.2f %%" % (100 * value) if value is not None else "none"


def show(result):
    print("%-22s %9s %7s %8s %9s %9s" % ("", "CPU s", "steps", "ms/step", "t_f, us", "peak, MPa"))
    for name, row in list(result["rows"].items()) + list(result["references"].items()):
        failed = "%9.1f" % (1e6 * row["time_to_failure"]) if row["time_to_failure"] else "    none "
        per_step, peak = 1e3 * row["seconds"] / row["steps"], row["peak_stress"] / 1e6
        print("%-22s %9.3f %7d %8.3f %s %9.3f" % (name, row["seconds"], row["steps"], per_step, failed, peak))
    for name, row in result["rows"].items():
        for reference, error in row["errors"].items():
            late, strong = percent(error["time_to_failure"]), percent(error["peak_stress"])
            print("%-22s against %-14s: time %s, peak %s, Dice %.3f" % (name, reference, late, strong, error["dice"]))
    for name, row in result["rows"].items():
        for own, ratio in row.get("ratios", {}).items():
            run = "%.0fx a whole run, " % ratio["run"] if ratio["run"] else ""
            met = "" if not ratio["run"] else "; target %dx %s" % (result["target_ratio"], "met" if ratio["run"] >= result["target_ratio"] else "MISSED")
            print("%s over %s: %s%.0fx a step%s" % (name, own, run, ratio["step"], met))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--programs", required=True, help="folder of fracfarm-solve")
    parser.add_argument("--scene", default=os.path.join(HERE, "plate.json"), help="isotropic material written out, velocities on whole sides")
    parser.add_argument("--explicit-only", action="store_true", help="leave FEniCSx's Newmark runs out")
    parser.add_argument("--steps", type=int, help="so many steps of FEniCSx only: seconds a step, no errors")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    arguments.integrators = FENICSX[:1] if arguments.explicit_only else FENICSX
    found = problems_of(arguments)
    for key, value, allowed in found:
        say("%s = %s; allowed: %s" % (key, value, allowed))
    if found:
        raise SystemExit(2)
    begun = time.time()
    with tempfile.TemporaryDirectory() as folder:
        result = compare(arguments, folder)
    print(json.dumps(result, indent=2)) if arguments.json else show(result)
    say("took %.0f s" % (time.time() - begun))


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: Apache-2.0
"""Simbody's elastic foundation, as OpenSim has it, beside volcontact: a ball and a cube on a plane.

    ./run python tests/benchmarks/simbody.py

writes results/simbody.csv; `docs/generate/make_comparison.py` takes it from there. Needs
the package `opensim` (CPython 3.11 to 3.13; `./run benchmark` installs it). Both models are a
bed of springs: Simbody's stand at the faces of a mesh, with a stiffness in N/m^3 that is k_v. Its
integrator has error control, but takes as many steps at other accuracies: stability limits them.
"""

from __future__ import annotations

import csv
import math
import tempfile
import time
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import mujoco
import numpy as np
import opensim
import trimesh

import volcontact as vc

RESULT = Path(__file__).parent / "results" / "simbody.csv"
GRAVITY, MASS = 9.81, 1.0  # [m/s^2], [kg]
RADIUS, BALL_STIFFNESS, PRESSED = 0.05, 1e8, 1e-3  # [m], [N/m^3], [m]
HALF, CUBE_STIFFNESS = 0.1, 1e7  # [m], [N/m^3]
FRICTION, SHARE, SLIP_SPEED = 0.5, 0.9, 1e-3  # [-], of the cone, [m/s]
DAMPING = 100.0  # [s/m], nearly critical for the cube
ACCURACY, DURATION = 1e-5, 2.0  # [-], [s]
UP, ALONG = 5, 3  # coordinates of a free joint


@dataclass
class Row:
    """One figure of one library."""

    case: str
    library: str
    variant: str
    unit: str
    expected: float
    value: float
    seconds: float | None = None  # of a processor, for a simulated one, at rest
    steps: int | None = None  # in a simulated second, at rest


class Scene:
    """A mesh on the half-space z <= 0, in Simbody."""

    def __init__(self, mesh: trimesh.Trimesh, stiffness: float, slope: float = 0.0) -> None:
        self.model = opensim.Model()
        down = -GRAVITY * math.cos(slope)
        self.model.setGravity(opensim.Vec3(GRAVITY * math.sin(slope), 0, down))
        inertia = opensim.Inertia(*[MASS * value for value in np.diag(mesh.moment_inertia)])
        self.body = opensim.Body("body", MASS, opensim.Vec3(0), inertia)
        self.model.addBody(self.body)
        joint = opensim.FreeJoint("joint", self.model.getGround(), self.body)
        self.model.addJoint(joint)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "mesh.obj"
            mesh.export(file)
            # A half-space of Simbody is at x > 0 of its frame.
            turned = opensim.Vec3(0, 0.5 * math.pi, 0)
            floor = opensim.ContactHalfSpace(
                opensim.Vec3(0), turned, self.model.getGround(), "floor"
            )
            faces = opensim.ContactMesh(
                str(file), opensim.Vec3(0), opensim.Vec3(0), self.body, "faces"
            )
            self.model.addContactGeometry(floor)
            self.model.addContactGeometry(faces)
            self.force = opensim.ElasticFoundationForce()
            for name in ("faces", "floor"):
                self.force.addGeometry(name)
            self.force.setStiffness(stiffness)
            self.force.setDissipation(DAMPING)
            self.force.setStaticFriction(FRICTION)
            self.force.setDynamicFriction(FRICTION)
            self.force.setViscousFriction(0.0)
            self.force.setTransitionVelocity(SLIP_SPEED)
            self.model.addForce(self.force)
            self.state = self.model.initSystem()
        self.kept = (joint, floor, faces)  # Python must not end what the model owns
        self.coordinates = [joint.get_coordinates(i) for i in range(6)]

    def place(self, height: float) -> None:
        """Puts the body's centre there."""
        self.coordinates[UP].setValue(self.state, height)

    def normal_force(self) -> float:
        """On the body [N]."""
        self.model.realizeDynamics(self.state)
        return self.force.getRecordValues(self.state).get(2)

    def run(self, until: float) -> tuple[float, int]:
        """Goes on until then; processor time [s] and steps."""
        manager = opensim.Manager(self.model)
        manager.setIntegratorAccuracy(ACCURACY)
        manager.initialize(self.state)
        begin = time.process_time()
        self.state = manager.integrate(until)
        spent = time.process_time() - begin
        self.kept = (*self.kept, manager, self.state)
        return spent, manager.getStateStorage().getSize()

    def at(self, coordinate: int) -> float:
        """Where it is [m]."""
        return self.coordinates[coordinate].getValue(self.state)


def ball_mesh(divisions: int) -> trimesh.Trimesh:
    """A unit of mass as a ball."""
    return _of_unit_mass(trimesh.creation.icosphere(divisions, RADIUS))


def cube_mesh(divisions: int) -> trimesh.Trimesh:
    """A cube whose faces are halved so often."""
    mesh = trimesh.creation.box((2 * HALF,) * 3)
    for _ in range(divisions):
        mesh = mesh.subdivide()
    return _of_unit_mass(mesh)


def _of_unit_mass(mesh: trimesh.Trimesh) -> trimesh.Trimesh:
    mesh.density = 1.0 / mesh.volume
    return mesh


def simbody() -> list[Row]:
    """The figures of Simbody."""
    rows, version = [], f"Simbody (OpenSim {opensim.GetVersion().split('-')[0]})"
    cap = math.pi * PRESSED**2 * (3 * RADIUS - PRESSED) / 3
    for divisions in (3, 4, 5):
        mesh = ball_mesh(divisions)
        variant = f"{len(mesh.faces)} faces"
        scene = Scene(mesh, BALL_STIFFNESS)
        scene.place(RADIUS - PRESSED)
        force = scene.normal_force()
        rows.append(Row(BALL_FORCE, version, variant, "N", BALL_STIFFNESS * cap, force))
        scene.run(DURATION)
        depth = RADIUS - scene.at(UP)
        rows.append(Row(BALL_DEPTH, version, variant, "m", rest_of_the_ball(), depth))
    for divisions in (2, 3):
        mesh = cube_mesh(divisions)
        variant = f"{len(mesh.faces)} faces"
        for slope in (0.0, math.atan(SHARE * FRICTION)):
            scene = Scene(mesh, CUBE_STIFFNESS, slope)
            scene.place(HALF - rest_of_the_cube() * math.cos(slope))
            scene.run(DURATION)
            before = scene.at(ALONG)
            spent, steps = scene.run(2.0 * DURATION)
            cost = spent / DURATION, round(steps / DURATION)
            if slope == 0.0:
                depth = HALF - scene.at(UP)
                rows.append(
                    Row(CUBE_DEPTH, version, variant, "m", rest_of_the_cube(), depth, *cost)
                )
            else:
                speed = (scene.at(ALONG) - before) / DURATION
                rows.append(Row(CREEP, version, variant, "m/s", 0.0, speed, *cost))
    return rows


BALL_FORCE = "force of a ball pressed in by 1 mm"
BALL_DEPTH = "depth of a ball at rest"
CUBE_DEPTH = "depth of a cube at rest"
CREEP = "creep of a cube at 0.9 of the friction cone"


def rest_of_the_cube() -> float:
    """Where k_v V is the weight [m]."""
    return MASS * GRAVITY / (CUBE_STIFFNESS * 4 * HALF**2)


def rest_of_the_ball() -> float:
    """The same, by halving [m]."""
    low, high = 0.0, RADIUS
    for _ in range(80):
        h = 0.5 * (low + high)
        heavy = BALL_STIFFNESS * math.pi * h**2 * (3 * RADIUS - h) / 3 < MASS * GRAVITY
        low, high = (h, high) if heavy else (low, h)
    return h


def ours() -> list[Row]:
    """The figures of volcontact."""
    X_WA = np.eye(4)
    X_WA[2, 3] = RADIUS - PRESSED
    overlap = vc.interference(vc.HalfSpace(), vc.Sphere(RADIUS), X_WA)
    cap = math.pi * PRESSED**2 * (3 * RADIUS - PRESSED) / 3
    force = BALL_STIFFNESS * overlap.volume
    rows = [Row(BALL_FORCE, "volcontact", "", "N", BALL_STIFFNESS * cap, force)]
    ball = f'type="sphere" size="{RADIUS}"'
    depth, _, _ = run_ours(ball, RADIUS, BALL_STIFFNESS, 0.0, "bristle")
    rows.append(Row(BALL_DEPTH, "volcontact", "", "m", rest_of_the_ball(), depth))
    box = f'type="box" size="{HALF} {HALF} {HALF}"'
    depth, _, cost = run_ours(box, HALF, CUBE_STIFFNESS, 0.0, "bristle")
    rows.append(Row(CUBE_DEPTH, "volcontact", "", "m", rest_of_the_cube(), depth, cost, 1000))
    slope = math.atan(SHARE * FRICTION)
    # An explicit step bears this friction up to 0.12 ms; longer ones are implicit.
    for law, step in (
        ("bristle", 1e-3),
        ("regularized_coulomb", 1e-4),
        ("regularized_coulomb", 1e-3),
    ):
        _, speed, cost = run_ours(box, HALF, CUBE_STIFFNESS, slope, law, step)
        variant = f"{law}, steps of {1e3 * step:g} ms"
        rows.append(Row(CREEP, "volcontact", variant, "m/s", 0.0, speed, cost, round(1 / step)))
    return rows


def run_ours(
    geom: str, height: float, stiffness: float, slope: float, law: str, step: float = 1e-3
) -> tuple[float, float, float]:
    """Depth [m], speed along the slope [m/s] and processor time of a second, at rest."""
    gravity = f"{GRAVITY * math.sin(slope)} 0 {-GRAVITY * math.cos(slope)}"
    material = {
        "stiffness": 2 * stiffness,  # of a side; both have it
        "damping": DAMPING,
        "friction": FRICTION,
        "friction_law": law,
    }
    if law == "regularized_coulomb":
        material["slip_speed"] = SLIP_SPEED
    model = vc.load(
        f"""<mujoco><option timestep="{step}" gravity="{gravity}"/>
        <worldbody><geom name="floor" type="plane" size="9 9 1"/>
        <body pos="0 0 {height}"><freejoint/><geom name="body" {geom} mass="{MASS}"/></body>
        </worldbody></mujoco>""",
        material=material,
    )
    data = mujoco.MjData(model)
    with vc.attach(model, material=material) as contact:
        mujoco.mj_step(model, data, round(DURATION / model.opt.timestep))
        before, begin = data.qpos[0], time.process_time()
        mujoco.mj_step(model, data, round(DURATION / model.opt.timestep))
        spent = time.process_time() - begin
        (site,) = contact.sites(data)
    depth = site["depth"] if slope == 0.0 else math.nan
    return depth, (data.qpos[0] - before) / DURATION, spent / DURATION


def main() -> None:
    """Measures, prints and writes."""
    opensim.Logger.setLevelString("Error")
    rows = ours() + simbody()
    with RESULT.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, [f.name for f in fields(Row)], lineterminator="\n")
        writer.writeheader()
        for row in rows:
            kept = {
                key: f"{value:.6g}" if isinstance(value, float) else value
                for key, value in asdict(row).items()
            }
            print(kept)
            writer.writerow(kept)


if __name__ == "__main__":
    main()

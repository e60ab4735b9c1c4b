# SPDX-License-Identifier: Apache-2.0
"""Two scenes for simulators of others: a ball in a cylinder, a tippe-top. docs/hosts.md."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

import volcontact as vc

GRAVITY = np.array([0.0, 0.0, -9.81])  # [m/s^2]
SAMPLE = 1e-3  # from row to row of a run [s]


@dataclass(frozen=True)
class Scene:
    """A free rigid body and what it touches; poses and twists are of its centre of mass.

    Attributes:
        mass: [kg].
        inertia: principal moments, along the body's axes, shape (3,) [kg m^2].
        contact: of the body with the world.
        position: at the start, shape (3,) [m].
        quaternion: of the attitude then, w, x, y, z.
        V_WA: twist then, angular and linear, in the world frame, shape (6,) [rad/s], [m/s].
        duration: [s].
        step: for hosts that take steps of one length [s].
        gap: of a pose: the way to the wall that is watched for a touch [m].
        events: of times and poses: when what happened [s].
    """

    mass: float
    inertia: np.ndarray
    contact: vc.ContactModel
    position: np.ndarray
    quaternion: np.ndarray
    V_WA: np.ndarray
    duration: float
    step: float
    gap: Callable[[np.ndarray], np.ndarray]
    events: Callable[[np.ndarray, np.ndarray], dict[str, float]]

    @property
    def X_WA(self) -> np.ndarray:
        """The pose at the start, shape (4, 4)."""
        return pose(self.position, self.quaternion)


class Memory:
    """What the laws keep: evaluate as often as you like, keep when a step is accepted."""

    def __init__(self, contact: vc.ContactModel) -> None:
        self.contact, self.time, self.state = contact, 0.0, None

    def report(self, time: float, X_WA: np.ndarray, V_WA: np.ndarray) -> vc.ContactReport:
        """The wrench now, from the memory of the last accepted step."""
        since = time - self.time
        return self.contact.evaluate(X_WA=X_WA, V_WA=V_WA, state=self.state, elapsed=since)

    def keep(self, time: float, report: vc.ContactReport) -> None:
        """The step is accepted."""
        self.time, self.state = time, report.state


def pose(position: np.ndarray, quaternion: np.ndarray) -> np.ndarray:
    """X_WA of a place and a quaternion w, x, y, z."""
    w, x, y, z = (quaternion / np.linalg.norm(quaternion)).tolist()
    a, b, c = position
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y), a],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x), b],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y), c],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def moved(X_WA: np.ndarray, V_WA: np.ndarray, time: float) -> np.ndarray:
    """The pose a time later, with the twist kept up."""
    angle = time * np.linalg.norm(V_WA[:3])
    axis = 0.5 * time * np.sinc(0.5 * angle / np.pi) * V_WA[:3]
    turn = np.array([np.cos(0.5 * angle), *axis])
    X = pose(X_WA[:3, 3] + time * V_WA[3:], turn)
    X[:3, :3] = X[:3, :3] @ X_WA[:3, :3]
    return X


def cross(v: np.ndarray) -> np.ndarray:
    """The matrix of v x."""
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def zeros(times: np.ndarray, values: np.ndarray) -> np.ndarray:
    """When samples fall through zero, on straight lines between them."""
    i = np.nonzero((values[:-1] > 0.0) & (values[1:] <= 0.0))[0]
    return times[i] + (times[i + 1] - times[i]) * values[i] / (values[i] - values[i + 1])


def first(found: np.ndarray) -> float:
    """The first, nan for none."""
    return float(found[0]) if len(found) else float("nan")


# ---- A ball of 0.1 m in a horizontal cylinder of 1 m, a demonstration of the CSA paper -----------

BORE, BALL = 1.0, 0.1  # radii [m]


def bore_gap(X: np.ndarray) -> np.ndarray:
    """From the ball to the wall."""
    return BORE - BALL - np.hypot(X[..., 0, 3], X[..., 2, 3])


def ball_events(t: np.ndarray, X: np.ndarray) -> dict[str, float]:
    """The first touch, and each time the ball passes the lowest line of the bore."""
    passes = np.sort(np.r_[zeros(t, X[:, 0, 3]), zeros(t, -X[:, 0, 3])])
    return {"touches": first(zeros(t, bore_gap(X)))} | {
        f"passes the bottom, {i}": float(time) for i, time in enumerate(passes, 1)
    }


def ball_in_cylinder() -> Scene:
    """Thrown along the bore, with a spin; bristles keep its deflection from step to step."""
    along_y = pose(np.zeros(3), np.array([1.0, 1.0, 0.0, 0.0]))
    hole = vc.Cylinder(radius=BORE, half_length=1.1).posed(along_y)
    bristles = dict(bristle_stiffness=1e4, bristle_damping=100.0, stribeck_speed=1e-2)
    contact = vc.ContactModel(
        pairs=[vc.Pair(vc.Sphere(radius=BALL), vc.Box((1.2, 1.0, 1.2)) - hole)],
        normal=vc.HuntCrossley(stiffness=1e6, damping=8.0),
        friction=vc.Bristle(friction=0.1, static_friction=0.1, coupling="quadrature", **bristles),
    )
    return Scene(
        mass=1.0,
        inertia=np.full(3, 0.4 * BALL**2),
        contact=contact,
        position=np.array([-0.5, 0.0, 0.0]),
        quaternion=np.array([1.0, 0.0, 0.0, 0.0]),
        V_WA=np.array([0.0, 0.0, 20.0, 0.0, 0.1, 0.0]),
        duration=4.0,
        step=2e-4,
        gap=bore_gap,
        events=ball_events,
    )


# ---- The tippe-top of Leine and Glocker ----------------------------------------------------------

BODY, STEM = 15e-3, 5e-3  # radii of the two spheres [m]
TO_BODY, TO_STEM = 3e-3, 16e-3  # their centres on the axis [m]


def stem_gap(X: np.ndarray) -> np.ndarray:
    """From the stem to the table."""
    return X[..., 2, 3] + TO_STEM * X[..., 2, 2] - STEM


def top_events(t: np.ndarray, X: np.ndarray) -> dict[str, float]:
    """Upright before it turns over, the stem's touch, and the tilt of 150 degrees."""
    up = X[:, 2, 2]
    return {
        "upright": float(t[np.argmax(up[t < 0.6])]),
        "stem touches": first(zeros(t, stem_gap(X))),
        "beyond 150 degrees": first(zeros(t, up - np.cos(np.radians(150.0)))),
    }


def tippe_top() -> Scene:
    """Starts at 180 rad/s and a tilt of 0.1 rad, and turns over onto its stem."""
    spheres = []
    for radius, height in ((BODY, TO_BODY), (STEM, TO_STEM)):
        at = pose(np.array([0.0, 0.0, height]), np.array([1.0, 0.0, 0.0, 0.0]))
        spheres.append(vc.Pair(vc.Sphere(radius=radius), vc.HalfSpace(), X_Aa=at))
    contact = vc.ContactModel(
        pairs=spheres,
        normal=vc.HuntCrossley(stiffness=5e8, damping=0.0),
        friction=vc.RegularizedCoulomb(friction=0.3, slip_speed=1e-3, coupling="quadrature"),
    )
    return Scene(
        mass=6e-3,
        inertia=np.array([8e-7, 8e-7, 7e-7]),
        contact=contact,
        position=np.array([0.0, 0.0, 0.0119649787527]),
        quaternion=np.array([np.cos(0.05), np.sin(0.05), 0.0, 0.0]),
        V_WA=np.array([0.0, -180.0 * np.sin(0.1), 180.0 * np.cos(0.1), 0.0, 0.0, 0.0]),
        duration=1.65,
        step=4e-5,
        gap=stem_gap,
        events=top_events,
    )


SCENES = {"ball_in_cylinder": ball_in_cylinder, "tippe_top": tippe_top}


def show(run: Callable[[Scene], tuple[np.ndarray, np.ndarray]]) -> None:
    """Runs both scenes and prints when what happened."""
    for name, make in SCENES.items():
        scene = make()
        for event, time in scene.events(*run(scene)).items():
            print(f"{name}: {event} {time:.6f} s")

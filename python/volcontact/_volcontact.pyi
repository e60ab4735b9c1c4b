# SPDX-License-Identifier: Apache-2.0
"""
Compiled core of volcontact: solids, interference volumes, laws, contact models.
"""

from collections.abc import Callable, Sequence
from typing import Annotated

import numpy
import numpy.typing
from numpy.typing import NDArray


class VolumeMetrics:
    """
    Metrics of an interference volume, in one frame and about its origin (docs/theory.md, 'Volume metrics').
    """

    @property
    def volume(self) -> float:
        """V [m^3]"""

    @property
    def centroid(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """Centroid of the volume [m], shape (3,)"""

    @property
    def inertia(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3, 3), order='C')]:
        """Inertia tensor about the centroid, unit density [m^5], shape (3, 3)"""

    @property
    def second_moment(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3, 3), order='C')]:
        """
        Integral of r r^T over the volume, r from the centroid [m^5], shape (3, 3)
        """

    @property
    def area_vector(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """
        Integral of A's outward normal over A's surface inside B = dV/dx of A [m^2], shape (3,)
        """

    @property
    def area_moment(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """
        Integral of x cross that normal, about the frame's origin = dV/dtheta of A [m^3], shape (3,)
        """

    @property
    def area(self) -> float:
        """Area of A's surface inside B [m^2]"""

    @property
    def counter_area(self) -> float:
        """Area of B's surface inside A [m^2]"""

    @property
    def depth_moment(self) -> float:
        """
        Integral of L^2/2 over the patch, L the column length along the normal [m^4]
        """

    @property
    def depth(self) -> float:
        """How deep one solid lies in the other, along the normal [m]"""

    @property
    def volume_error(self) -> float:
        """Bound or estimate of the error of the volume [m^3]"""

    @property
    def normal(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """Contact normal on A, from B to A, shape (3,); zero where there is none"""

    @property
    def flatness(self) -> float:
        """|area_vector| over the smaller surface, 1 for a flat patch [-]"""

    @property
    def touching(self) -> bool:
        """Whether the volume is positive"""

    @property
    def status(self) -> str:
        """'ok', 'contained', 'approximate', 'unbounded' or 'invalid'"""

    def __repr__(self) -> str: ...

class Csg:
    """
    Solid 'csg', composed of others: a + b, a & b, a - b, nested as wanted.

    Made by the operators of any solid, and by solid.posed(X), which puts a member in its place:

        bored = vc.Box((0.1, 0.1, 0.02)) - vc.Cylinder(0.01, 0.05).posed(X)

    A half-space may be a member; where the solid stays unbounded it can only meet bounded ones.
    """

    def __add__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """Union with another solid, in one common frame"""

    def __and__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """What both solids hold, in one common frame"""

    def __sub__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """This solid without the other, in one common frame"""

    def posed(self, X: Annotated[NDArray[numpy.float64], dict(shape=(4, 4), order='C')]) -> Csg:
        """
        The same solid elsewhere, as a member of a composed solid.

        Args:
            X: pose of this solid in the frame of the new one, shape (4, 4)

        Returns:
            Csg: the solid in its place

        Raises:
            ValueError: X is no pose
        """

    def own_metrics(self) -> VolumeMetrics:
        """Volume, centroid and inertia of the whole solid"""

    def signed_distance(self, point: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> float:
        """
        Negative inside; never larger in magnitude than the distance to the surface [m]
        """

    @property
    def bounds(self) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')], Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]]:
        """
        Corners (low, high) of a box around the solid [m], shape (3,) each; infinite where the solid is unbounded
        """

    @property
    def members(self) -> int:
        """How many simple solids it is made of"""

    def __repr__(self) -> str: ...

class Mesh:
    """
    Solid 'mesh': the inside of a closed oriented triangle mesh, in its own frame.

    The triangles are taken as given, not their hull; cavities and several parts are welcome. Equal
    vertices are welded. A mesh that is inside out as a whole is turned: see `turned`. Parts that
    overlap each other count twice.
    """

    def __init__(self, vertices: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C')], faces: Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C')]) -> None:
        """
        vertices [m], shape (n, 3); faces: indices of vertices from 0, counterclockwise seen from outside, shape (m, 3). Raises ValueError when they bound no solid, and says where
        """

    def __add__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """Union with another solid, in one common frame"""

    def __and__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """What both solids hold, in one common frame"""

    def __sub__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """This solid without the other, in one common frame"""

    def posed(self, X: Annotated[NDArray[numpy.float64], dict(shape=(4, 4), order='C')]) -> Csg:
        """
        The same solid elsewhere, as a member of a composed solid.

        Args:
            X: pose of this solid in the frame of the new one, shape (4, 4)

        Returns:
            Csg: the solid in its place

        Raises:
            ValueError: X is no pose
        """

    def own_metrics(self) -> VolumeMetrics:
        """Volume, centroid and inertia of the whole solid"""

    def signed_distance(self, point: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> float:
        """
        Negative inside; never larger in magnitude than the distance to the surface [m]
        """

    @property
    def bounds(self) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')], Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]]:
        """
        Corners (low, high) of a box around the solid [m], shape (3,) each; infinite where the solid is unbounded
        """

    @property
    def vertices(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C')]:
        """Corners after welding [m], shape (n, 3)"""

    @property
    def faces(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 3), order='C')]:
        """Triangles after welding, shape (m, 3)"""

    @property
    def turned(self) -> bool:
        """Whether all triangles pointed inwards and were turned"""

    @property
    def parts(self) -> int:
        """How many connected surfaces it has"""

    def __repr__(self) -> str: ...

class HalfSpace:
    """Solid 'half_space' in its own frame."""

    def __init__(self) -> None: ...

    def __add__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """Union with another solid, in one common frame"""

    def __and__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """What both solids hold, in one common frame"""

    def __sub__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """This solid without the other, in one common frame"""

    def posed(self, X: Annotated[NDArray[numpy.float64], dict(shape=(4, 4), order='C')]) -> Csg:
        """
        The same solid elsewhere, as a member of a composed solid.

        Args:
            X: pose of this solid in the frame of the new one, shape (4, 4)

        Returns:
            Csg: the solid in its place

        Raises:
            ValueError: X is no pose
        """

    def own_metrics(self) -> VolumeMetrics:
        """Volume, centroid and inertia of the whole solid"""

    def signed_distance(self, point: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> float:
        """
        Negative inside; never larger in magnitude than the distance to the surface [m]
        """

    @property
    def bounds(self) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')], Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]]:
        """
        Corners (low, high) of a box around the solid [m], shape (3,) each; infinite where the solid is unbounded
        """

    def support(self, direction: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """A point of the solid farthest along the direction [m]"""

    def __repr__(self) -> str: ...

class Sphere:
    """
    Solid 'sphere' in its own frame.

    Args:
        radius [m]: radius; >= 0
    """

    def __init__(self, radius: float) -> None: ...

    @property
    def radius(self) -> float:
        """radius [m]"""

    def __add__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """Union with another solid, in one common frame"""

    def __and__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """What both solids hold, in one common frame"""

    def __sub__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """This solid without the other, in one common frame"""

    def posed(self, X: Annotated[NDArray[numpy.float64], dict(shape=(4, 4), order='C')]) -> Csg:
        """
        The same solid elsewhere, as a member of a composed solid.

        Args:
            X: pose of this solid in the frame of the new one, shape (4, 4)

        Returns:
            Csg: the solid in its place

        Raises:
            ValueError: X is no pose
        """

    def own_metrics(self) -> VolumeMetrics:
        """Volume, centroid and inertia of the whole solid"""

    def signed_distance(self, point: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> float:
        """
        Negative inside; never larger in magnitude than the distance to the surface [m]
        """

    @property
    def bounds(self) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')], Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]]:
        """
        Corners (low, high) of a box around the solid [m], shape (3,) each; infinite where the solid is unbounded
        """

    def support(self, direction: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """A point of the solid farthest along the direction [m]"""

    def __repr__(self) -> str: ...

class Ellipsoid:
    """
    Solid 'ellipsoid' in its own frame.

    Args:
        semi_axes [m]: half the axis lengths, shape (3,); >= 0
    """

    def __init__(self, semi_axes: Sequence[float]) -> None: ...

    @property
    def semi_axes(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """half the axis lengths [m]"""

    def __add__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """Union with another solid, in one common frame"""

    def __and__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """What both solids hold, in one common frame"""

    def __sub__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """This solid without the other, in one common frame"""

    def posed(self, X: Annotated[NDArray[numpy.float64], dict(shape=(4, 4), order='C')]) -> Csg:
        """
        The same solid elsewhere, as a member of a composed solid.

        Args:
            X: pose of this solid in the frame of the new one, shape (4, 4)

        Returns:
            Csg: the solid in its place

        Raises:
            ValueError: X is no pose
        """

    def own_metrics(self) -> VolumeMetrics:
        """Volume, centroid and inertia of the whole solid"""

    def signed_distance(self, point: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> float:
        """
        Negative inside; never larger in magnitude than the distance to the surface [m]
        """

    @property
    def bounds(self) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')], Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]]:
        """
        Corners (low, high) of a box around the solid [m], shape (3,) each; infinite where the solid is unbounded
        """

    def support(self, direction: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """A point of the solid farthest along the direction [m]"""

    def __repr__(self) -> str: ...

class Capsule:
    """
    Solid 'capsule' in its own frame.

    Args:
        radius [m]: radius; >= 0
        half_length [m]: half the length of the cylinder, without the round ends; >= 0
    """

    def __init__(self, radius: float, half_length: float) -> None: ...

    @property
    def radius(self) -> float:
        """radius [m]"""

    @property
    def half_length(self) -> float:
        """half the length of the cylinder, without the round ends [m]"""

    def __add__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """Union with another solid, in one common frame"""

    def __and__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """What both solids hold, in one common frame"""

    def __sub__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """This solid without the other, in one common frame"""

    def posed(self, X: Annotated[NDArray[numpy.float64], dict(shape=(4, 4), order='C')]) -> Csg:
        """
        The same solid elsewhere, as a member of a composed solid.

        Args:
            X: pose of this solid in the frame of the new one, shape (4, 4)

        Returns:
            Csg: the solid in its place

        Raises:
            ValueError: X is no pose
        """

    def own_metrics(self) -> VolumeMetrics:
        """Volume, centroid and inertia of the whole solid"""

    def signed_distance(self, point: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> float:
        """
        Negative inside; never larger in magnitude than the distance to the surface [m]
        """

    @property
    def bounds(self) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')], Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]]:
        """
        Corners (low, high) of a box around the solid [m], shape (3,) each; infinite where the solid is unbounded
        """

    def support(self, direction: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """A point of the solid farthest along the direction [m]"""

    def __repr__(self) -> str: ...

class Cylinder:
    """
    Solid 'cylinder' in its own frame.

    Args:
        radius [m]: radius; >= 0
        half_length [m]: half the length between the flat ends; >= 0
    """

    def __init__(self, radius: float, half_length: float) -> None: ...

    @property
    def radius(self) -> float:
        """radius [m]"""

    @property
    def half_length(self) -> float:
        """half the length between the flat ends [m]"""

    def __add__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """Union with another solid, in one common frame"""

    def __and__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """What both solids hold, in one common frame"""

    def __sub__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """This solid without the other, in one common frame"""

    def posed(self, X: Annotated[NDArray[numpy.float64], dict(shape=(4, 4), order='C')]) -> Csg:
        """
        The same solid elsewhere, as a member of a composed solid.

        Args:
            X: pose of this solid in the frame of the new one, shape (4, 4)

        Returns:
            Csg: the solid in its place

        Raises:
            ValueError: X is no pose
        """

    def own_metrics(self) -> VolumeMetrics:
        """Volume, centroid and inertia of the whole solid"""

    def signed_distance(self, point: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> float:
        """
        Negative inside; never larger in magnitude than the distance to the surface [m]
        """

    @property
    def bounds(self) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')], Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]]:
        """
        Corners (low, high) of a box around the solid [m], shape (3,) each; infinite where the solid is unbounded
        """

    def support(self, direction: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """A point of the solid farthest along the direction [m]"""

    def __repr__(self) -> str: ...

class Frustum:
    """
    Solid 'frustum' in its own frame.

    Args:
        bottom_radius [m]: radius at z = -half_length; >= 0
        top_radius [m]: radius at z = +half_length; >= 0
        half_length [m]: half the length between the flat ends; >= 0
    """

    def __init__(self, bottom_radius: float, top_radius: float, half_length: float) -> None: ...

    @property
    def bottom_radius(self) -> float:
        """radius at z = -half_length [m]"""

    @property
    def top_radius(self) -> float:
        """radius at z = +half_length [m]"""

    @property
    def half_length(self) -> float:
        """half the length between the flat ends [m]"""

    def __add__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """Union with another solid, in one common frame"""

    def __and__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """What both solids hold, in one common frame"""

    def __sub__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """This solid without the other, in one common frame"""

    def posed(self, X: Annotated[NDArray[numpy.float64], dict(shape=(4, 4), order='C')]) -> Csg:
        """
        The same solid elsewhere, as a member of a composed solid.

        Args:
            X: pose of this solid in the frame of the new one, shape (4, 4)

        Returns:
            Csg: the solid in its place

        Raises:
            ValueError: X is no pose
        """

    def own_metrics(self) -> VolumeMetrics:
        """Volume, centroid and inertia of the whole solid"""

    def signed_distance(self, point: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> float:
        """
        Negative inside; never larger in magnitude than the distance to the surface [m]
        """

    @property
    def bounds(self) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')], Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]]:
        """
        Corners (low, high) of a box around the solid [m], shape (3,) each; infinite where the solid is unbounded
        """

    def support(self, direction: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """A point of the solid farthest along the direction [m]"""

    def __repr__(self) -> str: ...

class Box:
    """
    Solid 'box' in its own frame.

    Args:
        half_sizes [m]: half the edge lengths, shape (3,); >= 0
    """

    def __init__(self, half_sizes: Sequence[float]) -> None: ...

    @property
    def half_sizes(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """half the edge lengths [m]"""

    def __add__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """Union with another solid, in one common frame"""

    def __and__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """What both solids hold, in one common frame"""

    def __sub__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """This solid without the other, in one common frame"""

    def posed(self, X: Annotated[NDArray[numpy.float64], dict(shape=(4, 4), order='C')]) -> Csg:
        """
        The same solid elsewhere, as a member of a composed solid.

        Args:
            X: pose of this solid in the frame of the new one, shape (4, 4)

        Returns:
            Csg: the solid in its place

        Raises:
            ValueError: X is no pose
        """

    def own_metrics(self) -> VolumeMetrics:
        """Volume, centroid and inertia of the whole solid"""

    def signed_distance(self, point: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> float:
        """
        Negative inside; never larger in magnitude than the distance to the surface [m]
        """

    @property
    def bounds(self) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')], Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]]:
        """
        Corners (low, high) of a box around the solid [m], shape (3,) each; infinite where the solid is unbounded
        """

    def support(self, direction: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """A point of the solid farthest along the direction [m]"""

    def __repr__(self) -> str: ...

class RoundedBox:
    """
    Solid 'rounded_box' in its own frame.

    Args:
        half_sizes [m]: half the lengths from face to face, shape (3,); > 0
        radius [m]: of the edges and corners, no more than the smallest half size; > 0
    """

    def __init__(self, half_sizes: Sequence[float], radius: float) -> None: ...

    @property
    def half_sizes(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """half the lengths from face to face [m]"""

    @property
    def radius(self) -> float:
        """of the edges and corners, no more than the smallest half size [m]"""

    def __add__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """Union with another solid, in one common frame"""

    def __and__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """What both solids hold, in one common frame"""

    def __sub__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """This solid without the other, in one common frame"""

    def posed(self, X: Annotated[NDArray[numpy.float64], dict(shape=(4, 4), order='C')]) -> Csg:
        """
        The same solid elsewhere, as a member of a composed solid.

        Args:
            X: pose of this solid in the frame of the new one, shape (4, 4)

        Returns:
            Csg: the solid in its place

        Raises:
            ValueError: X is no pose
        """

    def own_metrics(self) -> VolumeMetrics:
        """Volume, centroid and inertia of the whole solid"""

    def signed_distance(self, point: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> float:
        """
        Negative inside; never larger in magnitude than the distance to the surface [m]
        """

    @property
    def bounds(self) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')], Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]]:
        """
        Corners (low, high) of a box around the solid [m], shape (3,) each; infinite where the solid is unbounded
        """

    def support(self, direction: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """A point of the solid farthest along the direction [m]"""

    def __repr__(self) -> str: ...

class Torus:
    """
    Solid 'torus' in its own frame.

    Args:
        major_radius [m]: from the axis to the middle of the tube; >= 0
        minor_radius [m]: of the tube, at most major_radius; >= 0
    """

    def __init__(self, major_radius: float, minor_radius: float) -> None: ...

    @property
    def major_radius(self) -> float:
        """from the axis to the middle of the tube [m]"""

    @property
    def minor_radius(self) -> float:
        """of the tube, at most major_radius [m]"""

    def __add__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """Union with another solid, in one common frame"""

    def __and__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """What both solids hold, in one common frame"""

    def __sub__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """This solid without the other, in one common frame"""

    def posed(self, X: Annotated[NDArray[numpy.float64], dict(shape=(4, 4), order='C')]) -> Csg:
        """
        The same solid elsewhere, as a member of a composed solid.

        Args:
            X: pose of this solid in the frame of the new one, shape (4, 4)

        Returns:
            Csg: the solid in its place

        Raises:
            ValueError: X is no pose
        """

    def own_metrics(self) -> VolumeMetrics:
        """Volume, centroid and inertia of the whole solid"""

    def signed_distance(self, point: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> float:
        """
        Negative inside; never larger in magnitude than the distance to the surface [m]
        """

    @property
    def bounds(self) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')], Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]]:
        """
        Corners (low, high) of a box around the solid [m], shape (3,) each; infinite where the solid is unbounded
        """

    def support(self, direction: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """A point of the solid farthest along the direction [m]"""

    def __repr__(self) -> str: ...

class ConvexPolytope:
    """Solid 'convex_polytope' in its own frame."""

    def __init__(self, vertices: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order='C', writable=False)]) -> None:
        """vertices [m], shape (n, 3): the solid is their convex hull"""

    def __add__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """Union with another solid, in one common frame"""

    def __and__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """What both solids hold, in one common frame"""

    def __sub__(self, other: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh) -> Csg:
        """This solid without the other, in one common frame"""

    def posed(self, X: Annotated[NDArray[numpy.float64], dict(shape=(4, 4), order='C')]) -> Csg:
        """
        The same solid elsewhere, as a member of a composed solid.

        Args:
            X: pose of this solid in the frame of the new one, shape (4, 4)

        Returns:
            Csg: the solid in its place

        Raises:
            ValueError: X is no pose
        """

    def own_metrics(self) -> VolumeMetrics:
        """Volume, centroid and inertia of the whole solid"""

    def signed_distance(self, point: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> float:
        """
        Negative inside; never larger in magnitude than the distance to the surface [m]
        """

    @property
    def bounds(self) -> tuple[Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')], Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]]:
        """
        Corners (low, high) of a box around the solid [m], shape (3,) each; infinite where the solid is unbounded
        """

    def support(self, direction: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """A point of the solid farthest along the direction [m]"""

    def __repr__(self) -> str: ...

class SignedDistance:
    """
    Solid given by a Python callable, for vc.interference only.

    The callable gets points [m], shape (n, 3), in the solid's frame, and returns their signed distances
    [m], shape (n,): negative inside. It need not be the true distance, only no steeper than `lipschitz`.
    It is called once for each batch of cells.

    A contact model or a scene is stepped without the interpreter lock and takes no such solid; write it
    in C++ for that (docs/theory.md, 'Solids with a signed distance').

    Args:
        distance: the callable
        bounds [m]: a box that holds the solid, shape (2, 3), the lower corner first
        lipschitz [-]: nowhere is the function steeper; > 0
        curvature [1/m]: bound of its second derivatives in any direction, where the function is below
            lipschitz^2 / (2 curvature) in magnitude; >= 0; a ball of radius r has 1.5/r. With it the
            certified bounds are of second order and meet a per cent; without it of first order,
            and the status is 'approximate' below a few per cent, though the volume itself is better
    """

    def __init__(self, distance: Callable[[numpy.typing.NDArray[numpy.float64]], numpy.typing.ArrayLike], bounds: Sequence[Sequence[float]], *, lipschitz: float = 1.0, curvature: float | None = None) -> None: ...

    @property
    def bounds(self) -> Annotated[NDArray[numpy.float64], dict(shape=(2, 3), order='C')]:
        """[m], shape (2, 3), the lower corner first"""

    def signed_distance(self, point: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]) -> float:
        """What the callable says there, over `lipschitz` [m]"""

    def __repr__(self) -> str: ...

class Interference(VolumeMetrics):
    """Metrics of a whole overlap and, in `sites`, of each connected region."""

    @property
    def sites(self) -> list[VolumeMetrics]:
        """One VolumeMetrics a contact site"""

    @property
    def engine(self) -> str:
        """The engine that made the numbers"""

def interference(a: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh, b: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh, X_AB: Annotated[NDArray[numpy.float64], dict(shape=(4, 4), order='C')] | None = None, *, tolerance: float = 0.001, engine: str = 'auto', threads: int = 1) -> Interference:
    """
    Interference volume of two solids, in A's frame and about its origin.

    Args:
        a: solid A
        b: solid B
        X_AB: pose of B in A, shape (4, 4); the identity when left out
        tolerance [-]: relative error asked of the volume, between 0 and 1
        engine: 'auto', 'closed_form', 'clip', 'lines', 'surface_sweep', 'columns' or 'octree'
        threads: threads for this one pair, 0 = decide by work; never changes a bit

    Returns:
        Interference: the metrics; `volume` is 0 when the solids are apart

    Raises:
        ValueError: X_AB is no pose, a value is out of range, the engine does not serve the pair, or a
            SignedDistance returned no numbers of the right shape
        whatever a SignedDistance raised itself, and KeyboardInterrupt where Ctrl-C ends it
    """

class NormalForce:
    """Base of all normal laws."""

    @property
    def name(self) -> str:
        """As in MJCF keys"""

    @property
    def state_size(self) -> int:
        """Doubles of state per contact site"""

class Friction:
    """Base of all friction laws."""

    @property
    def name(self) -> str:
        """As in MJCF keys"""

    @property
    def state_size(self) -> int:
        """Doubles of state per contact site"""

class HuntCrossley(NormalForce):
    """
    Normal law 'hunt_crossley'.

    Args:
        stiffness [N/m^3]: k_v, force per interference volume; > 0
        damping [s/m]: a, relative rise of the force per approach speed; >= 0
        restitution [-]: e, instead of damping: a then follows from the impact speed; > 0 and <= 1
        restitution_speed_floor [m/s]: slower impacts are damped as if they had this speed; > 0

    Keeps, for each contact site:
        impact_speed [m/s]: of the last impact, negative once the bodies part, 0 before the first
    """

    def __init__(self, *, stiffness: float = 10000000.0, damping: float = 0.0, restitution: float = 1.0, restitution_speed_floor: float = 0.01) -> None: ...

    @property
    def stiffness(self) -> float:
        """k_v, force per interference volume [N/m^3]"""

    @property
    def damping(self) -> float:
        """a, relative rise of the force per approach speed [s/m]"""

    @property
    def restitution(self) -> float:
        """e, instead of damping: a then follows from the impact speed [-]"""

    @property
    def restitution_speed_floor(self) -> float:
        """slower impacts are damped as if they had this speed [m/s]"""

class VolumeSpring(NormalForce):
    """
    Normal law 'volume_spring'.

    Args:
        stiffness [N/m^3]: k_v, force per interference volume; > 0
    """

    def __init__(self, *, stiffness: float = 10000000.0) -> None: ...

    @property
    def stiffness(self) -> float:
        """k_v, force per interference volume [N/m^3]"""

class ElasticCoulomb(Friction):
    """
    Friction law 'elastic_coulomb'.

    Args:
        friction [-]: mu; >= 0
        tangential_ratio [-]: k_t/k_n, tangential over normal stiffness of a patch; > 0
        tangential_damping [-]: zeta, damping ratio of sticking (1: critical for a ball); >= 0
        presliding [m]: smallest deflection at which a patch begins to slide; >= 0
        coupling: how sliding and spinning share the friction; one of 'ellipsoid' 'quadrature' 'none'

    Keeps, for each contact site:
        deflection [m]: of the spring along the plane, shape (3,)
        twist [m]: deflection of the spin, at the radius r_g
        stiffness [N/m]: k_t, the largest since it last slid
        strength [N]: most that it could hold since then
    """

    def __init__(self, *, friction: float = 0.2, tangential_ratio: float = 0.8, tangential_damping: float = 10.0, presliding: float = 1e-06, coupling: str = 'ellipsoid') -> None: ...

    @property
    def friction(self) -> float:
        """mu [-]"""

    @property
    def tangential_ratio(self) -> float:
        """k_t/k_n, tangential over normal stiffness of a patch [-]"""

    @property
    def tangential_damping(self) -> float:
        """zeta, damping ratio of sticking (1: critical for a ball) [-]"""

    @property
    def presliding(self) -> float:
        """smallest deflection at which a patch begins to slide [m]"""

    @property
    def coupling(self) -> str:
        """how sliding and spinning share the friction"""

class RegularizedCoulomb(Friction):
    """
    Friction law 'regularized_coulomb'.

    Args:
        friction [-]: mu, kinetic; >= 0
        slip_speed [m/s]: slip speed above which friction has its full strength; > 0
        coupling: how sliding and spinning share the friction; one of 'ellipsoid' 'quadrature' 'none'
    """

    def __init__(self, *, friction: float = 0.2, slip_speed: float = 0.001, coupling: str = 'ellipsoid') -> None: ...

    @property
    def friction(self) -> float:
        """mu, kinetic [-]"""

    @property
    def slip_speed(self) -> float:
        """slip speed above which friction has its full strength [m/s]"""

    @property
    def coupling(self) -> str:
        """how sliding and spinning share the friction"""

class Bristle(Friction):
    """
    Friction law 'bristle'.

    Args:
        friction [-]: mu_C, kinetic; >= 0
        static_friction [-]: mu_S, after a long rest; at least mu_C; >= 0
        bristle_stiffness [N/m]: sigma_0, tangential stiffness of a contact site; > 0
        bristle_damping [N s/m]: sigma_1, damping of the deflection; > 0
        viscous_friction [N s/m]: sigma_2, viscous friction per slip speed; >= 0
        stribeck_speed [m/s]: v_s, where sticking gives way to sliding; > 0
        dwell_time [s]: tau_dw, time constant with which friction at rest grows to mu_S; > 0
        coupling: how sliding and spinning share the friction; one of 'ellipsoid' 'quadrature' 'none'

    Keeps, for each contact site:
        deflection [m]: of the bristles along the plane, shape (3,)
        twist [m]: deflection of the spin, at the radius r_g
        dwell [-]: how much of the rise to mu_S is there, 0 to 1
    """

    def __init__(self, *, friction: float = 0.2, static_friction: float = 0.2, bristle_stiffness: float = 100000.0, bristle_damping: float = 500.0, viscous_friction: float = 0.0, stribeck_speed: float = 0.01, dwell_time: float = 0.1, coupling: str = 'ellipsoid') -> None: ...

    @property
    def friction(self) -> float:
        """mu_C, kinetic [-]"""

    @property
    def static_friction(self) -> float:
        """mu_S, after a long rest; at least mu_C [-]"""

    @property
    def bristle_stiffness(self) -> float:
        """sigma_0, tangential stiffness of a contact site [N/m]"""

    @property
    def bristle_damping(self) -> float:
        """sigma_1, damping of the deflection [N s/m]"""

    @property
    def viscous_friction(self) -> float:
        """sigma_2, viscous friction per slip speed [N s/m]"""

    @property
    def stribeck_speed(self) -> float:
        """v_s, where sticking gives way to sliding [m/s]"""

    @property
    def dwell_time(self) -> float:
        """tau_dw, time constant with which friction at rest grows to mu_S [s]"""

    @property
    def coupling(self) -> str:
        """how sliding and spinning share the friction"""

def make_normal(name: str, **parameters: float | str) -> NormalForce:
    """
    The normal law called `name`, as in MJCF keys, with its parameters as keywords: also one that was built in by VOLCONTACT_LAWS
    """

def make_friction(name: str, **parameters: float | str) -> Friction:
    """The same for friction laws"""

def units_of_law_fields() -> dict[str, str]:
    """Unit of each parameter of the laws by its name, such as N/m^3"""

def layer_stiffness(*, modulus: float, thickness: float, poisson_ratio: float | None = None) -> float:
    """
    Stiffness of an elastic layer on a rigid core.

    Args:
        modulus [Pa]: Young's modulus E
        thickness [m]: H
        poisson_ratio [-]: nu of a layer that cannot bulge sideways; left out, it can

    Returns:
        E / H, or (1 - nu) E / ((1 + nu) (1 - 2 nu) H) [N/m^3]
    """

def series_stiffness(stiffness_a: float, stiffness_b: float) -> float:
    """k_v [N/m^3] of two layers in series"""

def series_damping(stiffness_a: float, damping_a: float, stiffness_b: float, damping_b: float) -> float:
    """
    a [s/m] of two layers in series, each with its own against a rigid body
    """

def series_restitution(stiffness_a: float, restitution_a: float, stiffness_b: float, restitution_b: float) -> float:
    """e [-] of two layers in series, each with its own against a rigid body"""

class NormalInput:
    """All a normal law knows of a contact site."""

    @property
    def volume(self) -> float:
        """V [m^3]"""

    @property
    def depth_moment(self) -> float:
        """int L^2/2 dA [m^4]"""

    @property
    def approach_speed(self) -> float:
        """> 0 while approaching [m/s]"""

    @property
    def mass(self) -> float:
        """Reduced mass of the bodies, 0 where not known [kg]"""

class Patch:
    """The contact patch as a friction law sees it."""

    @property
    def gyration_radius(self) -> float:
        """[m]"""

    @property
    def volume(self) -> float:
        """[m^3]"""

    @property
    def area(self) -> float:
        """Projected along the normal [m^2]"""

    @property
    def second_moment(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3, 3), order='C')]:
        """int r r^T dV about the centroid [m^5], shape (3, 3)"""

class FrictionInput:
    """All a friction law knows of a contact site; world frame."""

    @property
    def normal_force(self) -> float:
        """[N]"""

    @property
    def normal(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """On A, shape (3,)"""

    @property
    def slip(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """Tangential velocity of A against B at the centroid [m/s], shape (3,)"""

    @property
    def spin(self) -> float:
        """Of A against B about the normal [rad/s]"""

    @property
    def travel(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """Way of A against B since the committed time [m], shape (3,)"""

    @property
    def turn(self) -> float:
        """About the normal since then [rad]"""

    @property
    def patch(self) -> Patch: ...

    @property
    def normal_stiffness(self) -> float:
        """Elastic part of the normal force per depth V/|S| [N/m]"""

    @property
    def mass(self) -> float:
        """Reduced mass of the bodies, 0 where not known [kg]"""

class NormalOutput:
    """What a normal law returns."""

    def __init__(self, *, magnitude: float, elastic: float, elastic_energy: float, rolling_damping: float = 0.0) -> None:
        """
        Args:
            magnitude [N]: f_n, >= 0
            elastic [N]: the part of it that is stored
            elastic_energy [J]: what is stored
            rolling_damping [N s/m^4]: torque per rolling speed and second moment of the volume
        """

class FrictionOutput:
    """What a friction law returns."""

    def __init__(self, *, force: Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')], torque: float = 0.0, slide_energy: float = 0.0, spin_energy: float = 0.0, slide_power: float, spin_power: float = 0.0) -> None:
        """
        Args:
            force [N]: on A, tangential, shape (3,)
            torque [N m]: on A, about the normal
            slide_energy, spin_energy [J]: stored in deflection and in twist
            slide_power, spin_power [W]: dissipated: work done against friction less what is being stored
        """

class PythonNormal(NormalForce):
    """Base of vc.NormalLaw."""

    def __init__(self, name: str, states: Sequence[tuple[str, str, str]]) -> None: ...

class PythonFriction(Friction):
    """Base of vc.FrictionLaw."""

    def __init__(self, name: str, states: Sequence[tuple[str, str, str]]) -> None: ...

class Pair:
    """A solid fixed on body A and a solid fixed on body B."""

    def __init__(self, a: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh, b: HalfSpace | Sphere | Ellipsoid | Capsule | Cylinder | Frustum | Box | RoundedBox | Torus | ConvexPolytope | Csg | SignedDistance | Mesh, *, X_Aa: Annotated[NDArray[numpy.float64], dict(shape=(4, 4), order='C')] | None = None, X_Bb: Annotated[NDArray[numpy.float64], dict(shape=(4, 4), order='C')] | None = None) -> None:
        """X_Aa, X_Bb: poses of the solids in their bodies, shape (4, 4)"""

class ByChannel:
    """One number for each way in which a contact dissipates."""

    @property
    def normal(self) -> float: ...

    @property
    def roll(self) -> float: ...

    @property
    def slide(self) -> float: ...

    @property
    def spin(self) -> float: ...

    @property
    def sum(self) -> float: ...

class SiteReport:
    """One contact site, in the world frame."""

    @property
    def pair(self) -> int:
        """Index of the geometric pair"""

    @property
    def metrics(self) -> VolumeMetrics:
        """About the world origin"""

    @property
    def normal(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """On A, from B to A, shape (3,)"""

    @property
    def normal_force(self) -> float:
        """[N]"""

    @property
    def force_on_A(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """Normal force and friction, at the centroid [N], shape (3,)"""

    @property
    def torque_on_A(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """Rolling and spin torque, about the centroid [N m], shape (3,)"""

    @property
    def approach_speed(self) -> float:
        """> 0 while approaching [m/s]"""

    @property
    def slip(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """Tangential velocity of A against B at the centroid [m/s], shape (3,)"""

    @property
    def spin(self) -> float:
        """Of A against B about the normal [rad/s]"""

    @property
    def elastic_energy(self) -> float:
        """Of the volume and the bristles [J]"""

    @property
    def bristle_energy(self) -> ByChannel:
        """The part of it that sliding and spinning stored [J]"""

    @property
    def power(self) -> ByChannel:
        """Dissipated [W]"""

class ContactTangent:
    """
    How the wrenches change with the motion: rows are the torque and force on A, then those on B; columns the turn [rad] and displacement [m] of A's frame, then of B's, or their speeds.
    """

    @property
    def by_motion(self) -> Annotated[NDArray[numpy.float64], dict(shape=(12, 12), order='C')]:
        """Analytic, of a flat patch, at fixed states, shape (12, 12)"""

    @property
    def by_speed(self) -> Annotated[NDArray[numpy.float64], dict(shape=(12, 12), order='C')]:
        """Shape (12, 12)"""

class ContactReport:
    """What an evaluation of a contact model returns."""

    @property
    def metrics(self) -> VolumeMetrics:
        """Sum over all sites, in the world frame"""

    @property
    def sites(self) -> list[SiteReport]: ...

    @property
    def force_on_A(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """[N], shape (3,), world frame"""

    @property
    def torque_on_A(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """About A's origin [N m], shape (3,), world frame"""

    @property
    def force_on_B(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """[N], shape (3,), world frame"""

    @property
    def torque_on_B(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order='C')]:
        """About B's origin [N m], shape (3,), world frame"""

    @property
    def touching(self) -> bool: ...

    @property
    def elastic_energy(self) -> float:
        """[J]"""

    @property
    def power(self) -> ByChannel:
        """Dissipated [W]"""

    @property
    def tangent(self) -> ContactTangent | None:
        """None unless it was asked for"""

    @property
    def state(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C')]:
        """What the sites keep for the next evaluation, shape (sites, row_size)"""

class ContactModel:
    """
    Geometric pairs x normal law x friction law: the CSA paper's contact model container.
    """

    def __init__(self, *, pairs: Sequence[Pair], normal: NormalForce, friction: Friction | None = None, rolling: bool = True, tolerance: float = 0.001, engine: str = 'auto', threads: int = 1, formulation: str = 'gonthier', share_of_a: float = 0.5, mass: float = 0.0) -> None:
        """
        Const once made.

        Args:
            pairs, normal, friction, rolling: the solids and the laws
            tolerance [-], engine, threads: as in `interference`
            formulation: 'gonthier', k V along the area vector at the centroid of the volume, or
                'potential', the gradient of int min(p_A, p_B) dV: conservative for every pair it takes
            share_of_a [-]: share of the compliance 1/k_v that is A's layer, 0 to 1; for 'potential'
            mass [kg]: reduced mass of the two bodies, 1 / (1/m_A + 1/m_B), of which sticking friction
                takes its damping and a restitution the speed of a blow; 0: not known

        Raises:
            ValueError: a forced engine or the formulation does not serve a pair
        """

    @property
    def row_size(self) -> int:
        """Numbers kept for each contact site; 0 when the laws keep nothing"""

    @property
    def text(self) -> str:
        """
        All of it as text, as the C container reads it (docs/c_container.md). Raises ValueError with a SignedDistance or a law of your own
        """

    def evaluate(self, *, X_WA: Annotated[NDArray[numpy.float64], dict(shape=(4, 4), order='C')] | None = None, X_WB: Annotated[NDArray[numpy.float64], dict(shape=(4, 4), order='C')] | None = None, V_WA: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')] | None = None, V_WB: Annotated[NDArray[numpy.float64], dict(shape=(6), order='C')] | None = None, state: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', writable=False)] | None = None, elapsed: float = 0.0, tangent: bool = False) -> ContactReport:
        """
        Wrenches on both bodies from their poses and twists.

        Args:
            X_WA, X_WB: poses of the bodies in the world, shape (4, 4); identity when left out
            V_WA, V_WB: twists, angular [rad/s] then linear [m/s] of the frame origin, world frame,
                shape (6,); zero when left out
            state: `state` of the report of the last accepted time, shape (sites, row_size); left out, all
                sites are new
            elapsed [s]: time since then
            tangent: whether to find how the wrenches change with the motion, for an implicit solver

        Returns:
            ContactReport: wrenches, sites, energy, dissipated power and the new state

        Raises:
            ValueError: a pose, twist or state is not what it should be
        """

def instruction_set() -> str:
    """
    The instructions the kernels use on this machine: 'portable', 'avx2' or 'avx512'; the results are the same to the last bit
    """

def most_threads() -> int:
    """
    How many threads an evaluation may use: the processors, or OMP_NUM_THREADS
    """

def version() -> str:
    """Of the package, as in its pyproject.toml"""

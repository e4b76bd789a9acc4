"""Quality of hexahedra."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

CORNERS = ((0, 1, 3, 4), (1, 2, 0, 5), (2, 3, 1, 6), (3, 0, 2, 7), (4, 7, 5, 0), (5, 4, 6, 1), (6, 5, 7, 2), (7, 6, 4, 3))


def scaled_jacobians(points: NDArray[np.float64], hexahedra: NDArray[Any]) -> NDArray[np.float64]:
    """Return the least scaled Jacobian of each hexahedron: over corners, of the unit vectors along its three edges there."""
    corners = points[hexahedra]
    least = np.full(len(hexahedra), np.inf)
    for at, *ends in CORNERS:
        ways = corners[:, ends] - corners[:, [at]]
        ways /= np.maximum(np.linalg.norm(ways, axis=2, keepdims=True), 1e-300)
        least = np.minimum(least, np.linalg.det(ways))
    return least

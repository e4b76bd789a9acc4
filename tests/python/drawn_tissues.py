"""Tissues drawn as voxels, with the corners that they have: cells around even points on a middle surface."""
import numpy as np
from scipy import spatial


class Drawn:
    """Layer of cells between two surfaces. Cells are regions of the middle surface, extended along its rays.

    `place(surface, depth)` and `project(points)` are inverse: a place on the middle surface, and a depth from 0 (inner side) to 1.
    """

    def __init__(self, count, seed=1, lean=0.0, exchange=0.0):
        self.random = np.random.default_rng(seed)
        many = self.surface(60 * count)
        seeds = many[self.random.choice(len(many), count, replace=False)]
        for _ in range(12):
            nearest = spatial.cKDTree(seeds).query(many)[1]
            number = np.maximum(np.bincount(nearest, minlength=count), 1)
            seeds = np.column_stack([np.bincount(nearest, many[:, axis], count) / number for axis in range(3)])
            seeds = self.project(seeds)[0]
        self.seeds, self.lean = seeds, lean
        self.drift = exchange * self.random.normal(size=seeds.shape)
        self.tree = spatial.cKDTree(seeds)

    def labels(self, spacing, margin=3):
        """Return labels, and the place of the first voxel; spacing z, y, x in µm."""
        spacing = np.array(spacing, dtype=float)
        low, high = self.box()
        low, high = low[::-1] - margin * spacing, high[::-1] + margin * spacing
        shape = np.ceil((high - low) / spacing).astype(int)
        labels = np.zeros(shape, dtype=np.uint16)
        for plane in range(shape[0]):
            rows, columns = np.mgrid[:shape[1], :shape[2]]
            points = np.column_stack([low[2] + columns.ravel() * spacing[2], low[1] + rows.ravel() * spacing[1],
                                      np.full(rows.size, low[0] + plane * spacing[0])])
            surface, depth = self.project(points)
            inside = (depth >= 0) & (depth <= 1) & self.within(surface)
            labels[plane].reshape(-1)[inside] = 1 + self.cell(surface[inside], depth[inside])
        return labels, low[::-1]

    def cell(self, surface, depth):
        if not self.drift.any():
            return self.tree.query(self.turned(surface, depth))[1]
        found = np.zeros(len(surface), dtype=int)
        levels = np.round(depth * 16).astype(int)
        for level in np.unique(levels):
            moved = spatial.cKDTree(self.seeds + (level / 16 - 0.5) * self.drift)
            found[levels == level] = moved.query(surface[levels == level])[1]
        return found

    def turned(self, surface, depth, sign=1):
        """Walls lean around x."""
        angle = sign * self.lean * (depth - 0.5)
        turned = surface.copy()
        turned[:, 1] = np.cos(angle) * surface[:, 1] - np.sin(angle) * surface[:, 2]
        turned[:, 2] = np.sin(angle) * surface[:, 1] + np.cos(angle) * surface[:, 2]
        return turned

    def corners(self):
        """Return triples of cells, from 1, and their corners at depths 0, 1/2 and 1; shape (n, 3, 3)."""
        points = self.surface(600 * len(self.seeds))
        triples = np.unique(np.sort(self.tree.query(points, k=3)[1], axis=1), axis=0)
        a, b, c = (self.seeds[triples[:, k]] for k in range(3))
        u, v = b - a, c - a
        normal = np.cross(u, v)
        area = (normal**2).sum(axis=1, keepdims=True)
        centre = a + (np.cross(normal, u) * (v**2).sum(axis=1, keepdims=True) + np.cross(v, normal) * (u**2).sum(axis=1, keepdims=True)) / (2 * area)
        normal /= np.sqrt(area)
        for _ in range(40):  # along the line of equal distances to the surface
            way = self.project(centre)[0] - centre
            centre = centre + 0.7 * (way * normal).sum(axis=1, keepdims=True) * normal
        surface = self.project(centre)[0]
        right = (np.linalg.norm(surface - centre, axis=1) < 1e-3) & self.within(surface)
        nearest = np.sort(self.tree.query(surface, k=3)[1], axis=1)
        right &= (nearest == triples).all(axis=1)
        surface, triples = surface[right], triples[right]
        places = [self.place(self.turned(surface, np.full(len(surface), depth), -1), depth) for depth in (0.0, 0.5, 1.0)]
        return triples + 1, np.stack(places, axis=1)

    def neighbours(self):
        """Return pairs of cells that share an edge in the middle, each once."""
        triples, places = self.corners()
        pairs = np.concatenate([triples[:, [0, 1]], triples[:, [1, 2]], triples[:, [0, 2]]])
        pairs, number = np.unique(pairs, axis=0, return_counts=True)
        return {tuple(pair) for pair in pairs.tolist()}

    def within(self, surface):
        return np.ones(len(surface), dtype=bool)


class Cyst(Drawn):
    """Closed layer around a ball, or an egg of three half-axes."""

    def __init__(self, count, axes=(30, 30, 30), height=12, **how):
        self.axes, self.height = np.array(axes, dtype=float), height
        super().__init__(count, **how)

    def radius(self, directions):
        return 1 / np.maximum(np.linalg.norm(directions / self.axes, axis=1), 1e-9)

    def surface(self, count):
        points = self.random.normal(size=(3 * count, 3))
        points /= np.linalg.norm(points, axis=1, keepdims=True)
        weight = np.linalg.norm(points / self.axes, axis=1)
        points = points[self.random.uniform(size=len(points)) < weight / weight.max()]
        return points * self.axes

    def project(self, points):
        size = np.linalg.norm(points, axis=1)
        directions = points / np.maximum(size, 1e-9)[:, None]
        radius = self.radius(directions)
        cosine = self.cosine(directions * radius[:, None], directions)
        return directions * radius[:, None], (size - radius) * cosine / self.height + 0.5

    def cosine(self, surface, directions):
        normal = surface / self.axes**2
        return (normal * directions).sum(axis=1) / np.linalg.norm(normal, axis=1)

    def place(self, surface, depth):
        directions = surface / np.linalg.norm(surface, axis=1, keepdims=True)
        return surface + directions * ((depth - 0.5) * self.height / self.cosine(surface, directions))[:, None]

    def box(self):
        most = self.axes + 0.5 * self.height
        return -most, most


class Tube(Drawn):
    """Tube along x, or a sector of it: a bent sheet. Ends are free or, with `beyond`, outside the image."""

    def __init__(self, count, radius=20, length=80, height=10, sector=2 * np.pi, beyond=0.0, **how):
        self.tube, self.length, self.height, self.sector, self.beyond = radius, length, height, sector, beyond
        super().__init__(count, **how)

    def surface(self, count):
        angle = self.random.uniform(-0.5, 0.5, count) * self.sector
        x = self.random.uniform(-0.5, 0.5, count) * self.length
        return np.column_stack([x, self.tube * np.sin(angle), self.tube * np.cos(angle)])

    def project(self, points):
        size = np.linalg.norm(points[:, 1:], axis=1)
        surface = np.column_stack([points[:, 0], points[:, 1:] * (self.tube / np.maximum(size, 1e-9))[:, None]])
        return surface, (size - self.tube) / self.height + 0.5

    def place(self, surface, depth):
        factor = 1 + (depth - 0.5) * self.height / self.tube
        return surface * [1, factor, factor]

    def within(self, surface):
        angle = np.arctan2(surface[:, 1], surface[:, 2])
        return (abs(surface[:, 0]) <= self.length / 2) & (abs(angle) <= self.sector / 2 + 1e-9)

    def box(self):
        outer = self.tube + self.height / 2
        half = min(self.sector / 2, np.pi)
        y = outer * (np.sin(half) if half < np.pi / 2 else 1)
        z = min(outer * np.cos(half), (self.tube - self.height / 2) * np.cos(half)) if half < np.pi else -outer
        x = self.length / 2 - self.beyond
        return np.array([-x, -y, z]), np.array([x, y, outer])


def pairs_of(tissue):
    """Return pairs of labels of cells that share an edge."""
    edges = {}
    for cell, label in zip(tissue.cells, tissue.cell_data["label"]):
        for pair in zip(cell.tolist(), np.roll(cell, -1).tolist()):
            edges.setdefault(frozenset(pair), []).append(int(label))
    assert max(map(len, edges.values())) == 2
    return {tuple(sorted(cells)) for cells in edges.values() if len(cells) == 2}


def disagreement(tissue, drawing, origin, apical):
    """Return the share of pairs of neighbours, of both, that both have, and how far corners are from those of the drawing, µm."""
    ours, theirs = pairs_of(tissue), drawing.neighbours()
    of_column = {}
    for cell, label in zip(tissue.cells, tissue.cell_data["label"]):
        for column in cell.tolist():
            of_column.setdefault(column, set()).add(int(label))
    columns = {frozenset(cells): column for column, cells in of_column.items() if len(cells) == 3}
    off = []
    triples, places = drawing.corners()
    for triple, (inner, _, outer) in zip(triples.tolist(), places - origin):
        if (column := columns.get(frozenset(triple))) is not None:
            top, bottom = (inner, outer) if apical == "inside" else (outer, inner)
            off += [np.linalg.norm(tissue.apical[column] - top), np.linalg.norm(tissue.basal[column] - bottom)]
    return len(ours & theirs) / len(ours | theirs), np.array(off)

"""Damage good tissue files at random and check that none ends in silence with a wrong tissue.

One sheet of twelve cells is written in every format of polygons, one block of twelve in every format of hexahedra, one set of
centres as CSV. A draw damages one of them in one way. Then plica reads it, and must

- give the same tissue, where the damage changes the file and not the tissue (byte-order mark, other order, doubled corners),
- refuse it or say something new, where the tissue is another one (other units, NaN, doubled cells, several pieces),
- neither crash nor give numbers that are not finite, whatever was done to the bytes (truncated, flipped, lines lost).

Usage: bad_files.py PROGRAM [--count N] [--seed S] [--first I] [--keep DIR]
"""
import copy
import math
import re
import struct
import subprocess
import sys
from dataclasses import dataclass, field

import trials
from trials import Broken

POLYGONS, HEXAHEDRA, CENTRES = "polygons", "hexahedra", "centres"
HEADS = {
    POLYGONS: '[embryo]\nshape = "surface"\nfile = "NAME"\ncell_height_um = 5\nrim = "held"\n',
    HEXAHEDRA: '[embryo]\nshape = "file"\nfile = "NAME"\napical_array = "apical"\n[vitelline]\nenabled = false\n',
    CENTRES: '[embryo]\nshape = "points"\nfile = "NAME"\ncell_height_um = 15\n',
}
SCENARIO = "format = 1\n{head}[region.high]\narray = \"myosin\"\nabove = 5\n[contraction.all]\nregion = \"high\"\nstiffness_nN_per_um = 1\n"


@dataclass
class Tissue:
    """Points, cells as lists of points, and numbers by cell."""

    kind: str
    points: list
    cells: list
    arrays: dict = field(default_factory=dict)


def sheet():
    """Twelve hexagons; each corner once."""
    places, points, cells = {}, [], []
    for row in range(3):
        for column in range(4):
            cell = []
            for corner in range(6):
                turn = math.radians(60 * corner + 30)
                x = 8 * (column + row % 2 / 2) + 8 / math.sqrt(3) * math.cos(turn)
                y = 8 * row * math.sqrt(0.75) + 8 / math.sqrt(3) * math.sin(turn)
                at = (round(x, 6), round(y, 6), 0.25)
                if at not in places:
                    places[at] = len(points)
                    points.append(at)
                cell.append(places[at])
            cells.append(cell)
    return Tissue(POLYGONS, points, cells, {"myosin": [float(k) for k in range(12)]})


def block():
    number = {(a, b, c): (a * 4 + b) * 2 + c for a in range(5) for b in range(4) for c in range(2)}
    points = [(20.0 * a, 20.0 * b, 30.0 * c) for a, b, c in number]
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    cells = [[number[a + i, b + j, k] for i, j, k in corners] for a in range(4) for b in range(3)]
    return Tissue(HEXAHEDRA, points, cells, {"apical": [5] * 12, "myosin": [float(k) for k in range(12)]})


def centres():
    """Sixty points on an ellipsoid, by the golden angle."""
    points = []
    for k in range(60):
        z = 1 - (2 * k + 1) / 60
        turn = k * math.pi * (3 - math.sqrt(5))
        r = math.sqrt(1 - z * z)
        points.append((round(90 * r * math.cos(turn), 4), round(60 * r * math.sin(turn), 4), round(60 * z, 4)))
    return Tissue(CENTRES, points, [[k] for k in range(60)], {"myosin": [float(k) for k in range(60)]})


# Writers: format to (ending, function of a tissue that returns bytes). OBJ and OFF hold no arrays.

def rows(values, front=""):
    return "".join(front + " ".join(map(str, row)) + "\n" for row in values)


def obj(t):
    return (rows(t.points, "v ") + rows([[p + 1 for p in cell] for cell in t.cells], "f ")).encode()


def off(t):
    return (f"OFF\n{len(t.points)} {len(t.cells)} 0\n" + rows(t.points) + rows([[len(c), *c] for c in t.cells])).encode()


def ply_header(t, form):
    arrays = "".join(f"property double {name}\n" for name in t.arrays)
    return (f"ply\nformat {form} 1.0\nelement vertex {len(t.points)}\nproperty double x\nproperty double y\nproperty double z\n"
            f"element face {len(t.cells)}\nproperty list uchar int vertex_indices\n{arrays}end_header\n")


def ply(t):
    faces = [[len(c), *c, *(values[k] for values in t.arrays.values())] for k, c in enumerate(t.cells)]
    return (ply_header(t, "ascii") + rows(t.points) + rows(faces)).encode()


def binary_ply(t):
    data = ply_header(t, "binary_little_endian").encode()
    data += b"".join(struct.pack("<3d", *map(float, p)) for p in t.points)
    for k, c in enumerate(t.cells):
        data += struct.pack(f"<B{len(c)}i{len(t.arrays)}d", len(c), *c, *(float(v[k]) for v in t.arrays.values()))
    return data


def ends(cells):
    count, out = 0, []
    for cell in cells:
        count += len(cell)
        out.append(count)
    return out


def xml_array(name, values, kind="Float64", components=1):
    return f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="ascii">{" ".join(map(str, values))}</DataArray>\n'


def xml_cells(t):
    return xml_array("connectivity", sum(t.cells, []), "Int64") + xml_array("offsets", ends(t.cells), "Int64")


def xml(t, kind, counts, cells):
    arrays = "".join(xml_array(name, values) for name, values in t.arrays.items())
    return (f'<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian"><{kind}><Piece NumberOfPoints="{len(t.points)}" {counts}>\n'
            f'<CellData>{arrays}</CellData><Points>{xml_array("Points", sum(map(list, t.points), []), components=3)}</Points>{cells}'
            f"</Piece></{kind}></VTKFile>\n").encode()


def vtp(t):
    return xml(t, "PolyData", f'NumberOfPolys="{len(t.cells)}"', f"<Polys>{xml_cells(t)}</Polys>")


def vtu(t):
    types = xml_array("types", [12] * len(t.cells), "UInt8")
    return xml(t, "UnstructuredGrid", f'NumberOfCells="{len(t.cells)}"', f"<Cells>{xml_cells(t)}{types}</Cells>")


def legacy(t, kind, word):
    size = sum(len(c) + 1 for c in t.cells)
    text = f"# vtk DataFile Version 3.0\ntissue\nASCII\nDATASET {kind}\nPOINTS {len(t.points)} double\n{rows(t.points)}"
    text += f"{word} {len(t.cells)} {size}\n" + rows([[len(c), *c] for c in t.cells])
    if word == "CELLS":
        text += f"CELL_TYPES {len(t.cells)}\n" + "12\n" * len(t.cells)
    text += f"CELL_DATA {len(t.cells)}\n"
    for name, values in t.arrays.items():
        text += f"SCALARS {name} double 1\nLOOKUP_TABLE default\n" + rows([[v] for v in values])
    return text.encode()


def csv(t):
    head = ",".join(["x_um", "y_um", "z_um", *t.arrays])
    body = "".join(",".join(map(str, [*t.points[c[0]], *(v[k] for v in t.arrays.values())])) + "\n" for k, c in enumerate(t.cells))
    return (head + "\n" + body).encode()


FORMATS = {
    POLYGONS: {"obj": ("obj", obj), "off": ("off", off), "ply": ("ply", ply), "binary ply": ("ply", binary_ply), "vtp": ("vtp", vtp),
               "vtk": ("vtk", lambda t: legacy(t, "POLYDATA", "POLYGONS"))},
    HEXAHEDRA: {"vtu": ("vtu", vtu), "vtk": ("vtk", lambda t: legacy(t, "UNSTRUCTURED_GRID", "CELLS"))},
    CENTRES: {"csv": ("csv", csv)},
}
NO_ARRAYS = ("obj", "off")
TEXT = ("obj", "off", "ply", "vtk", "csv", "vtp", "vtu")

# Damages of a tissue: function of tissue and random numbers. SAME: the tissue is the one that it was. TOLD: it is not.


def reorder(t, order):
    t.cells = [t.cells[k] for k in order]
    t.arrays = {name: [values[k] for k in order] for name, values in t.arrays.items()}


def add_cell(t, points, cell, like=0):
    t.cells.append([len(t.points) + p for p in cell])
    t.points += points
    for values in t.arrays.values():
        values.append(values[like])


def renumber_points(t, r):
    order = list(range(len(t.points)))
    r.shuffle(order)
    new = {old: k for k, old in enumerate(order)}
    t.points, t.cells = [t.points[k] for k in order], [[new[p] for p in cell] for cell in t.cells]


def shuffle_cells(t, r):
    order = list(range(len(t.cells)))
    r.shuffle(order)
    reorder(t, order)


def turn_rings(t, r):
    t.cells = [cell[k:] + cell[:k] for cell in t.cells for k in [r.randrange(len(cell))]]


def flip_all(t, _):
    t.cells = [cell[::-1] for cell in t.cells]


def flip_some(t, r):
    for k in r.sample(range(len(t.cells)), 3):
        t.cells[k] = t.cells[k][::-1]


def double_points(t, _):
    t.points, t.cells = [t.points[p] for cell in t.cells for p in cell], [
        list(range(start - len(cell), start)) for cell, start in zip(t.cells, ends(t.cells))]


def close_twice(t, _):
    t.cells = [[*cell, cell[0]] for cell in t.cells]


def repeat_corner(t, r):
    """A corner given twice, a very short way apart."""
    k = r.randrange(len(t.cells))
    corner = r.randrange(len(t.cells[k]))
    x, y, z = t.points[t.cells[k][corner]]
    t.cells[k].insert(corner, len(t.points))
    t.points.append((x + 10 ** -r.uniform(4, 9), y, z))


def unused_point(t, _):
    t.points.append((3.0, 4.0, 5.0))


def scaled(factor):
    def scale(t, _):
        t.points = [tuple(c * factor for c in p) for p in t.points]
    scale.__name__ = f"scaled by {factor:g}"
    return scale


def bad_number(t, r):
    k, axis = r.choice(r.choice(t.cells)), r.randrange(3)
    point = list(t.points[k])
    point[axis] = r.choice(["nan", "inf", "-nan", "NaN", "1e400"])
    t.points[k] = tuple(point)


def nan_in_array(t, r):
    t.arrays["myosin"][r.randrange(len(t.cells))] = "nan"


def doubled_cells(t, r):
    for k in r.sample(range(len(t.cells)), r.choice([1, 3])):
        reorder(t, [*range(len(t.cells)), k])


def copy_apart(t, _):
    far = len(t.points)
    t.points += [(x + 500, y, z) for x, y, z in t.points]
    t.cells += [[p + far for p in cell] for cell in t.cells]
    t.arrays = {name: values * 2 for name, values in t.arrays.items()}


def lone_cell(t, _):
    cell = t.cells[0]
    add_cell(t, [(t.points[p][0] - 300, *t.points[p][1:]) for p in cell], list(range(len(cell))))


def missing_point(t, r):
    r.choice(t.cells)[0] = len(t.points) + r.choice([0, 7, 10**9])


def swapped_corners(t, r):
    cell = r.choice(t.cells)
    a, b = r.sample(range(len(cell)), 2)
    if abs(a - b) in (1, len(cell) - 1):
        cell[a], cell[b] = cell[b], cell[a]
    else:
        cell[0], cell[1] = cell[1], cell[0]


def far_point(t, r):
    k = r.choice(r.choice(t.cells))
    t.points[k] = (t.points[k][0] + 60, *t.points[k][1:])


SAME = {POLYGONS: [renumber_points, shuffle_cells, turn_rings, flip_all, flip_some, double_points, close_twice, repeat_corner, unused_point],
        HEXAHEDRA: [renumber_points, shuffle_cells, unused_point], CENTRES: [shuffle_cells]}
TOLD = {POLYGONS: [scaled(1e-6), scaled(1e-3), scaled(1e3), bad_number, doubled_cells, copy_apart, lone_cell,
                   missing_point, swapped_corners, far_point],
        HEXAHEDRA: [scaled(1e-6), scaled(1e-3), scaled(1e3), bad_number, doubled_cells, copy_apart, lone_cell,
                    missing_point, swapped_corners, far_point, double_points],
        CENTRES: [scaled(1e-6), scaled(1e-3), scaled(1e3), bad_number, doubled_cells]}

# Damages of bytes.


def mark(data, _):
    return b"\xef\xbb\xbf" + data


def windows(data, _):
    return data.replace(b"\n", b"\r\n")


def blank_lines(data, _):
    return data + b"\n\n"


def truncated(data, r):
    return data[: r.randrange(len(data))]


def flipped(data, r):
    data = bytearray(data)
    for _ in range(r.choice([1, 3, 20])):
        data[r.randrange(len(data))] = r.randrange(256)
    return bytes(data)


def lost_lines(data, r):
    lines = data.split(b"\n")
    del lines[r.randrange(len(lines))]
    return b"\n".join(lines)


def moved_lines(data, r):
    lines = data.split(b"\n")
    a, b = r.randrange(len(lines)), r.randrange(len(lines))
    lines[a], lines[b] = lines[b], lines[a]
    return b"\n".join(lines)


def doubled_lines(data, r):
    lines = data.split(b"\n")
    k = r.randrange(len(lines))
    return b"\n".join([*lines[:k], lines[k], *lines[k:]])


def emptied(_data, r):
    return r.choice([b"", b"\n", b"\0" * 100, b"PK\x03\x04", b"<html></html>"])


SAME_BYTES, ANY_BYTES = [mark, windows, blank_lines], [truncated, truncated, flipped, flipped, lost_lines, moved_lines, doubled_lines, emptied]


class Reader:
    def __init__(self, program, folder):
        self.program, self.folder, self.known = program, folder, {}

    def read(self, kind, name, data):
        """Return status, lines of quality, and what was said beside."""
        (self.folder / name).write_bytes(data)
        scenario = SCENARIO.format(head=HEADS[kind].replace("NAME", name))
        if name.endswith(NO_ARRAYS):
            scenario = scenario[: scenario.index("[region")]
        (self.folder / "draw.toml").write_text(scenario)
        try:
            done = subprocess.run([self.program, "mesh", "draw.toml", "--out", "rest.vtu", "--overwrite"], cwd=self.folder,
                                  capture_output=True, encoding="utf-8", timeout=120, check=False)
        except subprocess.TimeoutExpired:
            raise Broken("waits forever") from None
        except UnicodeDecodeError as error:
            raise Broken(f"bytes of the file reach the terminal: {error}") from None
        if done.returncode not in (0, 2, 4):
            raise Broken(f"status {done.returncode}: {done.stderr.strip()[-500:]}")
        if done.returncode != 0 and not re.search(r"[^:]+:.+[;:] .+", done.stderr):
            raise Broken(f"refused without a reason: {done.stderr}")
        quality = [line for line in done.stdout.splitlines() if re.match(r"\d+ cells|cell volume|apical area|basal area|cell height", line)]
        said = [line for line in (done.stdout + done.stderr).splitlines() if line not in quality and not line.startswith("note: ")]
        if done.returncode == 0:
            result = (self.folder / "rest.vtu").read_bytes()
            if re.search(r"\b(nan|inf)\b", done.stdout.lower()) or b"nan" in result:
                raise Broken(f"numbers that are not finite: {done.stdout}")
        return done.returncode, quality, {re.sub(r"[\d.]+", "N", line) for line in said}, done.stderr.strip()

    def good(self, kind, form):
        if (kind, form) not in self.known:
            status, quality, said, error = self.read(kind, f"good.{FORMATS[kind][form][0]}", FORMATS[kind][form][1](MAKERS[kind]()))
            if status != 0:
                sys.exit(f"a good file is refused, {form}: {error}")
            self.known[kind, form] = quality, said
        return self.known[kind, form]


MAKERS = {POLYGONS: sheet, HEXAHEDRA: block, CENTRES: centres}


def numbers(lines):
    return [float(n) for line in lines for n in re.findall(r"\d+\.?\d*", line.split("in cell")[0])]


def alike(a, b):
    a, b = numbers(a), numbers(b)
    return len(a) == len(b) and all(math.isclose(x, y, rel_tol=2e-3, abs_tol=0.11) for x, y in zip(a, b))


def draw(reader, r):
    """One damaged file: its kind, format and damage, and how plica took it."""
    kind = r.choice([POLYGONS, POLYGONS, POLYGONS, HEXAHEDRA, HEXAHEDRA, CENTRES])
    form = r.choice(list(FORMATS[kind]))
    ending, write = FORMATS[kind][form]
    damages = [(d, "same") for d in SAME[kind]] + [(d, "told") for d in TOLD[kind]]
    damages += [(d, "any") for d in ANY_BYTES] + [(nan_in_array, "any")] * (form not in NO_ARRAYS)
    if form in TEXT:
        damages += [(d, "same") for d in SAME_BYTES if ending not in ("vtp", "vtu", "vtk") or d is not mark]
    damage, right = r.choice(damages)
    tissue = copy.deepcopy(MAKERS[kind]())
    if damage in SAME_BYTES or damage in ANY_BYTES:
        data = damage(write(tissue), r)
    else:
        damage(tissue, r)
        if form == "binary ply" and damage is missing_point:
            tissue.cells = [[min(p, 2**31 - 1) for p in c] for c in tissue.cells]
        data = write(tissue)
    name = f"{form}, {damage.__name__}"
    good_quality, good_said = reader.good(kind, form)
    try:
        status, quality, said, error = reader.read(kind, f"draw.{ending}", data)
        said_new = bool(said - good_said)
        if right == "same" and status != 0:
            raise Broken(f"refused, and it is the same tissue: {error}")
        if right == "same" and not alike(quality, good_quality):
            raise Broken(f"read as another tissue: {quality} instead of {good_quality}")
        if right == "told" and status == 0 and not said_new:
            raise Broken(f"another tissue, in silence: {quality}")
    except Broken as broken:
        raise Broken(f"{name}: {broken}") from None
    return f"{right}: " + ("read" if status == 0 and not said_new else "read, told" if status == 0 else "refused")


def main():
    given = trials.arguments(__doc__, "file", 300).parse_args()

    def prepare(folder):
        reader = Reader(given.program, folder)
        return lambda r: draw(reader, r)

    sys.exit(1 if trials.run(given, "file", prepare)["FAILED"] else 0)


if __name__ == "__main__":
    main()

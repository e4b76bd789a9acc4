// Section of the elements by a plane, as for pictures in src/show/boundary_surface.cpp.
import type { Cut } from "./state";
import type { Topology } from "./run";

const hexEdges = [
  [0, 1], [3, 2], [4, 5], [7, 6], [0, 3], [1, 2], [4, 7], [5, 6], [0, 4], [1, 5], [2, 6], [3, 7],
];

/** Corner of a section between two nodes: (1 - part) first + part second. */
interface Corner {
  first: number;
  second: number;
  part: number;
  point: [number, number, number];
}

export interface CutPolygon {
  element: number;
  corners: Corner[]; // around their centre
}

export function cutByPlane(topology: Topology, positions: Float32Array, cut: Cut): CutPolygon[] {
  const { elements } = topology;
  const polygons: CutPolygon[] = [];
  for (let e = 0; e < elements.length / 8; ++e) {
    let least = Infinity;
    let greatest = -Infinity;
    for (let k = 0; k < 8; ++k) {
      const height = positions[3 * elements[8 * e + k] + cut.axis];
      least = Math.min(least, height);
      greatest = Math.max(greatest, height);
    }
    if (least >= cut.at || greatest < cut.at) continue;
    const corners: Corner[] = [];
    for (const [a, b] of hexEdges) {
      const first = elements[8 * e + a];
      const second = elements[8 * e + b];
      const before = positions[3 * first + cut.axis] - cut.at;
      const after = positions[3 * second + cut.axis] - cut.at;
      if (before < 0 === after < 0) continue;
      const part = before / (before - after);
      const point = [0, 1, 2].map((i) => (1 - part) * positions[3 * first + i] + part * positions[3 * second + i]);
      corners.push({ first, second, part, point: point as [number, number, number] });
    }
    if (corners.length >= 3) polygons.push({ element: e, corners: aroundMiddle(corners, cut.axis) });
  }
  return polygons;
}

/** Outline of a capsule along x in a plane: pairs of points, 3 coordinates each; empty outside of it. */
export function capsuleOutline(halfAxis: number, radius: number, cut: Cut): number[] {
  const beyond = cut.axis === 0 ? Math.max(Math.abs(cut.at) - halfAxis, 0) : Math.abs(cut.at);
  if (beyond >= radius) return [];
  const [r, count] = [Math.sqrt(radius ** 2 - beyond ** 2), 96];
  const point = (i: number): number[] => {
    const angle = (2 * Math.PI * i) / count;
    const [a, b] = [r * Math.cos(angle), r * Math.sin(angle)];
    if (cut.axis === 0) return [cut.at, a, b];
    const along = a + Math.sign(Math.round(1e6 * a)) * halfAxis;
    return cut.axis === 1 ? [along, cut.at, b] : [along, b, cut.at];
  };
  return Array.from({ length: count }, (_, i) => [...point(i), ...point(i + 1)]).flat();
}

function aroundMiddle(corners: Corner[], axis: number): Corner[] {
  const [across, up] = [(axis + 1) % 3, (axis + 2) % 3];
  const mean = (i: number) => corners.reduce((sum, corner) => sum + corner.point[i], 0) / corners.length;
  const [middleAcross, middleUp] = [mean(across), mean(up)];
  const angle = (corner: Corner) => Math.atan2(corner.point[up] - middleUp, corner.point[across] - middleAcross);
  return corners.sort((a, b) => angle(a) - angle(b));
}

/** Sides of polygons that separate cells: not shared by polygons of one cell. */
export function cutOutlines(topology: Topology, polygons: CutPolygon[]): [Corner, Corner][] {
  const sides = new Map<string, [Corner, Corner] | null>();
  const name = (corner: Corner) => `${Math.min(corner.first, corner.second)}-${Math.max(corner.first, corner.second)}`;
  for (const { element, corners } of polygons)
    corners.forEach((corner, i) => {
      const next = corners[(i + 1) % corners.length];
      const key = `${topology.cellOfElement[element]} ${[name(corner), name(next)].sort().join(" ")}`;
      sides.set(key, sides.has(key) ? null : [corner, next]);
    });
  return [...sides.values()].filter((side) => side !== null) as [Corner, Corner][];
}

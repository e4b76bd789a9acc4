// Scene of one run for three.js: boundary surface, outlines of cells, section, shell.
import * as three from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import { colourAt, partOf } from "./colour";
import type { Field, PageData, RunData } from "./page_data";
import type { Place, Run, Topology } from "./run";
import { capsuleOutline, cutByPlane, cutOutlines, type CutPolygon } from "./section";
import type { Cut } from "./state";

const texels = 256;
const mostFine = 8000; // facets drawn as four triangles about their centre, which preserves symmetry; more are drawn as two
const lineColour = 0x1c1c22;
const pickedColour = 0xe6007e;
const shellColour = 0x7f8fa6;

// Colour map as a texture: values become its first coordinate, so that values, not colours, are interpolated.
function mapTexture(map: string[], steps: boolean): three.DataTexture {
  const count = steps ? map.length : texels;
  const data = new Uint8Array(4 * count);
  for (let i = 0; i < count; ++i) data.set([...colourAt(map, i / (count - 1)), 255], 4 * i);
  const texture = new three.DataTexture(data, count, 1);
  texture.colorSpace = three.SRGBColorSpace;
  texture.magFilter = texture.minFilter = steps ? three.NearestFilter : three.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

// A thin film: opaque where it is seen edge-on. The offset keeps it above cells that touch it.
function membraneMaterial(): three.MeshLambertMaterial {
  const material = new three.MeshLambertMaterial({
    color: 0, emissive: shellColour, transparent: true, depthWrite: false, side: three.DoubleSide,
    polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2,
  });
  material.onBeforeCompile = (shader) => {
    const edge = "diffuseColor.a = 0.06 + 0.8 * pow(1.0 - abs(normal.z), 2.5);";
    shader.fragmentShader = shader.fragmentShader.replace("#include <opaque_fragment>", `${edge}\n#include <opaque_fragment>`);
  };
  return material;
}

export class EmbryoScene {
  readonly scene = new three.Scene();
  private readonly light = new three.DirectionalLight(0xffffff, 1.5);
  private readonly textures = new Map<string, three.DataTexture>();
  private readonly plane = new three.Plane();
  private readonly skinMaterial = new three.MeshLambertMaterial({
    flatShading: true, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
  });
  private readonly capMaterial = new three.MeshBasicMaterial({
    side: three.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
  });
  private readonly lineMaterial = new three.LineBasicMaterial({ color: lineColour, transparent: true, opacity: 0.6 });
  private readonly capLineMaterial = new three.LineBasicMaterial({ color: lineColour });
  private readonly shellMaterial = membraneMaterial();
  private readonly shellCutMaterial = new LineMaterial({ color: shellColour, linewidth: 4 });
  private readonly pickedMaterial = new LineMaterial({ color: pickedColour, linewidth: 3.5 });

  private readonly boundary = new three.Mesh(new three.BufferGeometry(), this.skinMaterial);
  private readonly lines = new three.LineSegments(new three.BufferGeometry(), this.lineMaterial);
  private readonly cap = new three.Mesh(new three.BufferGeometry(), this.capMaterial);
  private readonly capLines = new three.LineSegments(new three.BufferGeometry(), this.capLineMaterial);
  private readonly pickedLines = new LineSegments2(new LineSegmentsGeometry(), this.pickedMaterial);
  private readonly shell = new three.Mesh(new three.BufferGeometry(), this.shellMaterial);
  private shellSize: RunData["shell"] = null;
  private readonly shellCut = new LineSegments2(new LineSegmentsGeometry(), this.shellCutMaterial);

  private topology: Topology | null = null;
  private positions = new Float32Array(0);
  private values = new Float32Array(0);
  private trianglesOfFacet = 4;
  private polygons: CutPolygon[] = [];
  private elementOfCapTriangle: number[] = [];

  constructor(private readonly run: Run, page: PageData) {
    for (const [name, map] of Object.entries(page.maps)) this.textures.set(name, mapTexture(map, name === "steps"));
    this.scene.add(new three.AmbientLight(0xffffff, 2.1), this.light, this.light.target);
    for (const object of [this.boundary, this.lines, this.cap, this.capLines, this.pickedLines, this.shell, this.shellCut]) {
      object.frustumCulled = false;
      this.scene.add(object);
    }
  }

  /** Light from the upper left of the viewer. */
  lightFrom(camera: three.Camera): void {
    this.light.position.set(-0.5, 0.7, 1).applyQuaternion(camera.quaternion);
  }

  show(place: Place, field: Field, cut: Cut | null, options: { edges: boolean; shell: boolean }, picked: readonly number[]): void {
    if (place.topology !== this.topology) this.take(place.topology);
    const topology = place.topology;
    topology.positions(place.moment, place.part, this.positions);
    topology.values(field, place.moment, place.part, this.values);
    const texture = this.textures.get(field.map)!;
    for (const material of [this.skinMaterial, this.capMaterial])
      if (material.map !== texture) {
        material.map = texture;
        material.needsUpdate = true;
      }
    this.fillBoundary(topology, field);
    this.fillLines(topology);
    this.fillCut(topology, field, cut);
    this.fillPicked(topology, picked);
    this.lines.visible = options.edges;
    this.capLines.visible = options.edges && cut !== null;
    this.shell.visible = options.shell && this.shellSize !== null;
    this.shellCut.visible = options.shell && this.fillShellCut(cut);
  }

  /** The boundary in the present shape, and the cell of each of its facets (five points), for drawings of ids. */
  get ids(): { boundary: three.Mesh; cellOfFacet: (facet: number) => number; facets: number; plane: three.Plane | null } {
    const topology = this.topology!;
    return {
      boundary: this.boundary, facets: topology.facets.length / 4,
      cellOfFacet: (facet) => topology.cellOfElement[topology.elementOfFacet[facet]],
      plane: this.cap.visible ? this.plane : null,
    };
  }

  /** First cell hit by a ray; -1 if none. */
  cellOn(ray: three.Raycaster, cut: Cut | null): number {
    const topology = this.topology;
    if (!topology) return -1;
    const skinHit = ray.intersectObject(this.boundary, false).find((hit) => !cut || this.plane.distanceToPoint(hit.point) > 0);
    const capHit = cut ? ray.intersectObject(this.cap, false)[0] : undefined;
    const element = (hit: three.Intersection) =>
      topology.elementOfFacet[Math.floor(hit.faceIndex! / this.trianglesOfFacet)];
    if (capHit && (!skinHit || capHit.distance <= skinHit.distance))
      return topology.cellOfElement[this.elementOfCapTriangle[capHit.faceIndex!]];
    return skinHit ? topology.cellOfElement[element(skinHit)] : -1;
  }

  /** Extent of the nodes, and of the membrane if it is shown, from the centre in a direction of the picture (right, up), um. */
  reach(right: three.Vector3, up: three.Vector3, along: three.Vector2): number {
    const direction = right.clone().multiplyScalar(along.x).addScaledVector(up, along.y);
    const { x, y, z } = direction;
    let reach = -Infinity;
    for (let n = 0; n < this.positions.length; n += 3)
      reach = Math.max(reach, x * this.positions[n] + y * this.positions[n + 1] + z * this.positions[n + 2]);
    const size = this.shell.visible ? this.shellSize : null;
    if (size) reach = Math.max(reach, size.half_axis_um * Math.abs(x) + size.radius_um);
    return reach - direction.dot(new three.Vector3(...this.run.centre));
  }

  private fillShell(size: RunData["shell"]): void {
    this.shellSize = size;
    this.shell.geometry.dispose();
    this.shell.geometry = size
      ? new three.CapsuleGeometry(size.radius_um, 2 * size.half_axis_um, 24, 64, 1).rotateZ(Math.PI / 2)
      : new three.BufferGeometry();
  }

  // New cells: arrays of the right size, and corners of triangles. Each facet has a fifth corner at its centre.
  private take(topology: Topology): void {
    this.topology = topology;
    if (this.run.data.shell !== this.shellSize) this.fillShell(this.run.data.shell);
    this.positions = new Float32Array(3 * topology.nodes);
    this.values = new Float32Array(Math.max(topology.nodes, topology.cells));
    const facets = topology.facets.length / 4;
    const corners = facets > mostFine ? [0, 1, 2, 0, 2, 3] : [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4];
    this.trianglesOfFacet = corners.length / 3;
    const triangles = new Uint32Array(corners.length * facets);
    for (let f = 0; f < facets; ++f) corners.forEach((corner, i) => (triangles[corners.length * f + i] = 5 * f + corner));
    this.boundary.geometry.dispose();
    this.boundary.geometry = new three.BufferGeometry();
    this.boundary.geometry.setIndex(new three.BufferAttribute(triangles, 1));
    this.boundary.geometry.setAttribute("position", dynamic(new Float32Array(15 * facets), 3));
    this.boundary.geometry.setAttribute("uv", dynamic(new Float32Array(10 * facets).fill(0.5), 2));
    this.lines.geometry.dispose();
    this.lines.geometry = new three.BufferGeometry();
    this.lines.geometry.setAttribute("position", dynamic(new Float32Array(3 * topology.outlines.length), 3));
  }

  private fillBoundary(topology: Topology, field: Field): void {
    const { facets, elementOfFacet, cellOfElement } = topology;
    const points = this.boundary.geometry.getAttribute("position") as three.BufferAttribute;
    const uv = this.boundary.geometry.getAttribute("uv") as three.BufferAttribute;
    const [to, parts] = [points.array as Float32Array, uv.array as Float32Array];
    const { positions, values } = this;
    for (let f = 0; f < facets.length / 4; ++f) {
      const [centre, cell] = [15 * f + 12, cellOfElement[elementOfFacet[f]]];
      to[centre] = to[centre + 1] = to[centre + 2] = 0;
      let mean = 0;
      for (let i = 0; i < 4; ++i) {
        const node = facets[4 * f + i];
        for (let k = 0; k < 3; ++k) {
          to[15 * f + 3 * i + k] = positions[3 * node + k];
          to[centre + k] += positions[3 * node + k] / 4;
        }
        if (!field.on_nodes) continue;
        parts[10 * f + 2 * i] = this.texel(field, values[node]);
        mean += values[node] / 4;
      }
      if (field.on_nodes) parts[10 * f + 8] = this.texel(field, mean);
      else for (let i = 0, part = this.texel(field, values[cell]); i < 5; ++i) parts[10 * f + 2 * i] = part;
    }
    points.needsUpdate = uv.needsUpdate = true;
    this.boundary.geometry.boundingSphere = null;
  }

  // Texture coordinate: the centres of the first and last texel are the ends of the scale.
  private texel(field: Field, value: number): number {
    const count = field.scale === "steps" ? this.textures.get("steps")!.image.width : texels;
    return (0.5 + partOf(field, value) * (count - 1)) / count;
  }

  private fillLines(topology: Topology): void {
    const points = this.lines.geometry.getAttribute("position") as three.BufferAttribute;
    const to = points.array as Float32Array;
    const { outlines } = topology;
    for (let i = 0; i < outlines.length; ++i)
      for (let k = 0; k < 3; ++k) to[3 * i + k] = this.positions[3 * outlines[i] + k];
    points.needsUpdate = true;
  }

  private fillCut(topology: Topology, field: Field, cut: Cut | null): void {
    const planes = cut ? [this.plane] : null;
    for (const material of [this.skinMaterial, this.lineMaterial, this.shellMaterial, this.pickedMaterial])
      material.clippingPlanes = planes;
    this.cap.visible = cut !== null;
    this.polygons = [];
    if (!cut) return;
    this.plane.normal.set(0, 0, 0).setComponent(cut.axis, cut.keep);
    this.plane.constant = -cut.keep * cut.at;
    this.polygons = cutByPlane(topology, this.positions, cut);
    const points: number[] = [];
    const parts: number[] = [];
    this.elementOfCapTriangle = [];
    for (const { element, corners } of this.polygons) {
      const values = corners.map((corner) =>
        field.on_nodes
          ? (1 - corner.part) * this.values[corner.first] + corner.part * this.values[corner.second]
          : this.values[topology.cellOfElement[element]],
      );
      const middle = [0, 1, 2].map((i) => corners.reduce((sum, corner) => sum + corner.point[i], 0) / corners.length);
      const middleValue = values.reduce((sum, value) => sum + value, 0) / values.length;
      corners.forEach((corner, i) => {
        const next = (i + 1) % corners.length;
        points.push(...corner.point, ...corners[next].point, ...middle);
        for (const value of [values[i], values[next], middleValue]) parts.push(this.texel(field, value), 0.5);
        this.elementOfCapTriangle.push(element);
      });
    }
    refill(this.cap, points, parts);
    refill(this.capLines, cutOutlines(topology, this.polygons).flatMap(([a, b]) => [...a.point, ...b.point]));
  }

  // Outline of the membrane in the plane of the cut; false if there is none.
  private fillShellCut(cut: Cut | null): boolean {
    const size = this.shellSize;
    const outline = size && cut ? capsuleOutline(size.half_axis_um, size.radius_um, cut) : [];
    this.shellCut.geometry.dispose();
    this.shellCut.geometry = new LineSegmentsGeometry().setPositions(outline.length > 0 ? outline : [0, 0, 0, 0, 0, 0]);
    return outline.length > 0;
  }

  private fillPicked(topology: Topology, cells: readonly number[]): void {
    this.pickedLines.visible = cells.length > 0;
    if (cells.length === 0) return;
    const points: number[] = [];
    const own = new Set(cells.flatMap((cell) => topology.elementsOfCell[cell]));
    const push = (a: number, b: number) => {
      for (const node of [a, b]) points.push(...this.positions.subarray(3 * node, 3 * node + 3));
    };
    topology.elementOfFacet.forEach((element, f) => {
      if (own.has(element))
        for (let i = 0; i < 4; ++i) push(topology.facets[4 * f + i], topology.facets[4 * f + ((i + 1) % 4)]);
    });
    for (const { element, corners } of this.polygons)
      if (own.has(element))
        corners.forEach((corner, i) => points.push(...corner.point, ...corners[(i + 1) % corners.length].point));
    this.pickedLines.geometry.dispose();
    this.pickedLines.geometry = new LineSegmentsGeometry().setPositions(points);
  }
}

function dynamic(array: Float32Array, size: number): three.BufferAttribute {
  return new three.BufferAttribute(array, size).setUsage(three.DynamicDrawUsage);
}

function refill(object: three.Mesh | three.LineSegments, points: number[], parts?: number[]): void {
  object.geometry.dispose();
  object.geometry = new three.BufferGeometry();
  object.geometry.setAttribute("position", new three.BufferAttribute(new Float32Array(points), 3));
  if (parts) object.geometry.setAttribute("uv", new three.BufferAttribute(new Float32Array(parts), 2));
}

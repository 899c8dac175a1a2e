// SPDX-License-Identifier: Apache-2.0
// Pieces of the model as objects in space, coloured by a field.
import { BufferAttribute, BufferGeometry, Color, DoubleSide, Mesh, MeshLambertMaterial, type Object3D, type Plane, Points, PointsMaterial, SRGBColorSpace } from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import type { Range } from "./fields";
import type { Piece } from "./model";

/** Shares from 0 to 1 to colours, in the linear numbers that light is computed with. */
export class Colours {
  private readonly linear: Float32Array;
  private readonly none = new Color().setRGB(0.62, 0.62, 0.62, SRGBColorSpace);

  constructor(private readonly table: number[]) {
    const colour = new Color();
    this.linear = new Float32Array(table.length);
    for (let k = 0; k < table.length; k += 3) colour.setRGB(table[k]! / 255, table[k + 1]! / 255, table[k + 2]! / 255, SRGBColorSpace).toArray(this.linear, k);
  }

  css(share: number): string {
    const k = this.place(share);
    return `rgb(${this.table[k]} ${this.table[k + 1]} ${this.table[k + 2]})`;
  }

  /** Three numbers per value; values are multiplied by `scale` first. */
  of(values: Float32Array, scale: number, [low, high]: Range): Float32Array {
    const colours = new Float32Array(3 * values.length);
    values.forEach((value, point) => {
      const k = Number.isNaN(value) ? undefined : this.place((value * scale - low) / (high - low));
      if (k === undefined) this.none.toArray(colours, 3 * point);
      else colours.set(this.linear.subarray(k, k + 3), 3 * point);
    });
    return colours;
  }

  private place(share: number): number {
    return 3 * Math.round(Math.min(1, Math.max(0, share)) * (this.table.length / 3 - 1));
  }
}

export interface Look {
  colours?: Float32Array | undefined; // three per point; else one colour for all
  colour?: number;
  opacity?: number;
  planes: Plane[];
}

function geometryOf(piece: Piece, { colours }: Look): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(piece.positions, 3));
  if (colours) geometry.setAttribute("color", new BufferAttribute(colours, 3));
  if (piece.triangles.length) geometry.setIndex(new BufferAttribute(piece.triangles, 1));
  return geometry;
}

export function surfaceOf(piece: Piece, look: Look): Mesh<BufferGeometry, MeshLambertMaterial> {
  const geometry = geometryOf(piece, look);
  geometry.computeVertexNormals();
  const opacity = look.opacity ?? 1;
  const material = new MeshLambertMaterial({
    vertexColors: look.colours !== undefined, color: look.colour ?? 0xffffff, side: DoubleSide, clippingPlanes: look.planes,
    transparent: opacity < 1, opacity, depthWrite: opacity === 1,
  });
  return new Mesh(geometry, material);
}

export function pointsOf(piece: Piece, look: Look): Points {
  const material = new PointsMaterial({ size: 3, sizeAttenuation: false, vertexColors: look.colours !== undefined, color: look.colour ?? 0xffffff, clippingPlanes: look.planes });
  return new Points(geometryOf(piece, look), material);
}

/** Lines whose points follow each other. */
export function linesOf(piece: Piece, look: Look): Object3D {
  const places: number[] = [];
  const colours: number[] = [];
  let first = 0;
  for (const length of piece.lines) {
    for (let k = first; k + 1 < first + length; k++)
      for (const end of [k, k + 1]) {
        places.push(...piece.positions.subarray(3 * end, 3 * end + 3));
        if (look.colours) colours.push(...look.colours.subarray(3 * end, 3 * end + 3));
      }
    first += length;
  }
  const geometry = new LineSegmentsGeometry().setPositions(places);
  if (look.colours) geometry.setColors(colours);
  const material = new LineMaterial({ linewidth: 2, vertexColors: look.colours !== undefined, clipping: true, clippingPlanes: look.planes });
  return new LineSegments2(geometry, material);
}

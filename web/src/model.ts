// SPDX-License-Identifier: Apache-2.0
// What the program put into the page (src/patency/report/page_data.h), unpacked.
import { dataText } from "./dom";

export type Vec = [number, number, number];

interface FieldAbout {
  name: string;
  unit: string;
  low: number;
  high: number;
}

export interface PieceAbout {
  data: string;
  points: number;
  triangles: number;
  lines: number;
  origin_mm: Vec;
  step_mm: number;
  fields: FieldAbout[];
  time_s?: number;
}

export interface Lesion {
  branch: string;
  throat_mm: number;
  start_mm: number;
  end_mm: number;
  read_mm: number;
  flow_m3_per_s: number;
}

export interface Flow {
  key: string;
  title: string;
  pieces: Partial<Record<PieceName, PieceAbout>>;
  lesions: Lesion[];
  pullback: string | null;
  outlets: string[]; // in the order of their numbers in the pullback
}
export type PieceName = "wall" | "cut" | "streamlines";

export interface Body {
  name: string;
  frames: PieceAbout[];
}

export interface Model {
  name: string;
  flows: Flow[];
  bodies: Body[];
  files: { name: string; data: string }[];
  outlets: string[];
  worst_lesion: number | null;
  stent: { start_mm: number; end_mm: number } | null;
  space: string;
  view: { right: Vec; up: Vec; toward: Vec };
  colours: number[];
}

export function readModel(): Model {
  return JSON.parse(dataText("model")) as Model;
}

/** Points in mm, fields in the file's units (NaN where there is no value), what joins the points. */
export interface Piece {
  positions: Float32Array;
  fields: Map<string, Float32Array>;
  triangles: Uint16Array;
  lines: number[];
}

/** The bytes behind an id: base64 of a zlib stream. */
export async function readBytes(id: string): Promise<ArrayBuffer> {
  const packed = Uint8Array.from(atob(dataText(id)), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

const noValue = 65535;

/** `joints`: the piece whose triangles and lines this one shares, when it has none of its own. */
export async function readPiece(about: PieceAbout, joints?: Piece): Promise<Piece> {
  const bytes = new DataView(await readBytes(about.data));
  let at = 0;
  const next = (): number => {
    const value = bytes.getUint16(at, true);
    at += 2;
    return value;
  };
  const positions = new Float32Array(3 * about.points);
  for (let k = 0; k < positions.length; k++) positions[k] = about.origin_mm[k % 3]! + about.step_mm * next();
  const fields = new Map<string, Float32Array>();
  for (const { name, low, high } of about.fields) {
    const values = new Float32Array(about.points);
    for (let k = 0; k < values.length; k++) {
      const share = next();
      values[k] = share === noValue ? NaN : low + (share / (noValue - 1)) * (high - low);
    }
    fields.set(name, values);
  }
  const triangles = new Uint16Array(3 * about.triangles);
  for (let k = 0; k < triangles.length; k++) triangles[k] = next();
  const lines: number[] = [];
  for (let k = 0; k < about.lines; k++) lines.push(next());
  const shares = joints && triangles.length === 0 && joints.positions.length === positions.length;
  return { positions, fields, triangles: shares ? joints.triangles : triangles, lines };
}

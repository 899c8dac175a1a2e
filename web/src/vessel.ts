// SPDX-License-Identifier: Apache-2.0
// The run's pieces, and what of them is seen: one part of the run, one field.
import type { Mesh, Object3D, Plane } from "three";
import type { Choice } from "./dom";
import { rangeOf, styleOf, type FieldStyle, type Range } from "./fields";
import { readPiece, type Flow, type Model, type Piece, type PieceName } from "./model";
import { Colours, linesOf, pointsOf, surfaceOf } from "./shapes";

const groups: Record<PieceName, string> = { wall: "On the wall", cut: "On a cut along the vessel", streamlines: "Along streamlines" };
const pieceNames: PieceName[] = ["wall", "cut", "streamlines"];
export const deployed = "deploy"; // the part's key, and the group of its fields

const isMetal = (body: string): boolean => /stent|ring|strut/i.test(body);

export interface Seen {
  objects: Object3D[];
  targets: Mesh[];
  values: Map<Mesh, Float32Array>; // of the field, at the targets' points
  style: FieldStyle | undefined;
  range: Range;
}

export class Vessel {
  readonly colours: Colours;
  private readonly flows = new Map<string, Map<PieceName, Piece>>();
  private readonly bodies: { name: string; frames: Piece[]; times: number[] }[] = [];

  private constructor(private readonly model: Model) {
    this.colours = new Colours(model.colours);
  }

  static async read(model: Model): Promise<Vessel> {
    const vessel = new Vessel(model);
    for (const flow of model.flows) {
      const pieces = new Map<PieceName, Piece>();
      for (const name of pieceNames) {
        const about = flow.pieces[name];
        if (about && about.points > 0) pieces.set(name, await readPiece(about));
      }
      vessel.flows.set(flow.key, pieces);
    }
    for (const { name, frames } of model.bodies) {
      const pieces: Piece[] = [];
      for (const about of frames) pieces.push(await readPiece(about, pieces.at(-1)));
      vessel.bodies.push({ name, frames: pieces, times: frames.map((frame) => frame.time_s ?? 0) });
    }
    return vessel;
  }

  /** The run's parts that can be seen, in their order in time. */
  parts(): Choice[] {
    const seen = (flow: Flow): boolean => (this.flows.get(flow.key)?.size ?? 0) > 0;
    const parts = this.model.flows.filter(seen).map(({ key, title }) => ({ value: key, label: title }));
    if (this.bodies.length) parts.splice(parts.length && parts[0]!.value !== "after" ? 1 : 0, 0, { value: deployed, label: "Deployment" });
    return parts;
  }

  frameCount(part: string): number {
    return part === deployed ? Math.max(...this.bodies.map((body) => body.frames.length)) : 0;
  }
  timeOf(frame: number): number {
    return Math.max(...this.bodies.map(({ times }) => times[Math.min(frame, times.length - 1)] ?? 0));
  }

  /** Fields as "piece:name". */
  fields(part: string): Choice[] {
    if (part === deployed) {
      const names = new Set(this.bodies.flatMap((body) => body.frames.flatMap((frame) => [...frame.fields.keys()])));
      return [{ value: `${deployed}:`, label: "Shape alone" }, ...[...names].map((name) => ({ value: `${deployed}:${name}`, label: styleOf(name).label }))];
    }
    const pieces = this.flows.get(part);
    return pieceNames.flatMap((piece) => [...(pieces?.get(piece)?.fields.keys() ?? [])].map((name) => ({ value: `${piece}:${name}`, label: styleOf(name).label, group: groups[piece] })));
  }

  see(part: string, field: string, frame: number, isFitted: boolean, planes: Plane[]): Seen {
    const [piece, name] = field.split(":") as [PieceName | typeof deployed, string];
    const style = name ? styleOf(name) : undefined;
    const range = style ? (style.fixed && !isFitted ? style.fixed : rangeOf(this.everywhere(piece, name), style)) : ([0, 1] as Range);
    const seen: Seen = { objects: [], targets: [], values: new Map(), style, range };
    if (part === deployed) this.addBodies(seen, name, frame, planes);
    else this.addFlow(seen, this.flows.get(part) ?? new Map(), piece as PieceName, name, planes);
    return seen;
  }

  /** A field in all parts and frames: one scale for all, so that parts compare. */
  private everywhere(piece: string, name: string): Float32Array[] {
    const pieces = piece === deployed ? this.bodies.flatMap((body) => body.frames) : [...this.flows.values()].map((flow) => flow.get(piece as PieceName));
    return pieces.flatMap((p) => p?.fields.get(name) ?? []);
  }

  private addFlow(seen: Seen, pieces: Map<PieceName, Piece>, chosen: PieceName, name: string, planes: Plane[]): void {
    const wall = pieces.get("wall");
    const piece = pieces.get(chosen);
    const values = piece?.fields.get(name);
    const colours = values && seen.style ? this.colours.of(values, seen.style.scale, seen.range) : undefined;
    if (piece && chosen === "streamlines") seen.objects.push(linesOf(piece, { colours, planes }));
    if (piece && chosen === "cut") this.add(seen, surfaceOf(piece, { colours, planes: [] }), values);
    if (wall) {
      const mesh = chosen === "wall" ? surfaceOf(wall, { colours, planes }) : surfaceOf(wall, { colour: 0x8fa3b8, opacity: 0.18, planes });
      this.add(seen, mesh, chosen === "wall" ? values : undefined);
    }
  }

  private addBodies(seen: Seen, name: string, frame: number, planes: Plane[]): void {
    const context = [...this.flows.values()][0]?.get("wall");
    if (context && this.bodies.every((body) => isMetal(body.name))) this.add(seen, surfaceOf(context, { colour: 0x8fa3b8, opacity: 0.18, planes }), undefined);
    for (const body of this.bodies) {
      const piece = body.frames[Math.min(frame, body.frames.length - 1)]!;
      const values = piece.fields.get(name);
      const metal = isMetal(body.name);
      const look = {
        colours: values && seen.style ? this.colours.of(values, seen.style.scale, seen.range) : undefined,
        colour: metal ? 0x9aa3ad : 0xd8a08f, opacity: metal ? 1 : 0.5, planes: metal ? [] : planes,
      };
      if (piece.triangles.length) this.add(seen, surfaceOf(piece, look), values);
      else seen.objects.push(pointsOf(piece, look));
    }
  }

  private add(seen: Seen, mesh: Mesh, values: Float32Array | undefined): void {
    seen.objects.push(mesh);
    seen.targets.push(mesh);
    if (values) seen.values.set(mesh, values);
  }
}

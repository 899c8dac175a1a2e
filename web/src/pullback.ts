// SPDX-License-Identifier: Apache-2.0
// pullback.csv: what the blood does along the line to every outlet.
import type { Vec } from "./model";

/** A section across the vessel. */
export interface Station {
  outlet: number; // from 1
  arc: number; // mm
  place: Vec; // mm
  radius: number; // mm, of a circle of its area
  values: Record<string, number>; // by column, SI
}

export interface Quantity {
  key: string;
  label: string;
  unit: string;
  least?: number; // the axis reaches down to it, or farther
  of: (values: Record<string, number>) => number | undefined;
  estimate?: (values: Record<string, number>) => number | undefined;
}

const mmHg = 1 / 133.322387415;
const scaled = (column: string, scale: number) => (values: Record<string, number>) => {
  const value = values[column];
  return value === undefined ? undefined : value * scale;
};

export const quantities: Quantity[] = [
  { key: "ffr", label: "FFR", unit: "", least: 0.7, of: scaled("ffr", 1) },
  { key: "pressure", label: "Pressure", unit: "mmHg", of: scaled("pressure_pa", mmHg), estimate: scaled("estimated_pressure_pa", mmHg) },
  { key: "diameter", label: "Diameter of the section's area", unit: "mm", of: (v) => (v["area_m2"] === undefined ? undefined : 2e3 * Math.sqrt(v["area_m2"] / Math.PI)) },
  { key: "flow", label: "Flow", unit: "mL/min", of: scaled("flow_m3_per_s", 6e7) },
  { key: "mean", label: "Mean velocity", unit: "m/s", of: scaled("mean_velocity_m_per_s", 1) },
  { key: "peak", label: "Peak velocity", unit: "m/s", of: scaled("peak_velocity_m_per_s", 1) },
];

export function readStations(csv: string): Station[] {
  const [head, ...rows] = csv.trim().split("\n");
  const columns = head!.split(",");
  return rows.map((row) => {
    const values = Object.fromEntries(row.split(",").map((cell, k) => [columns[k]!, Number(cell)]));
    const at = (column: string): number => values[column] ?? NaN;
    return {
      outlet: at("outlet"),
      arc: 1e3 * at("arc_m"),
      place: [1e3 * at("x_m"), 1e3 * at("y_m"), 1e3 * at("z_m")],
      radius: 1e3 * Math.sqrt(at("area_m2") / Math.PI),
      values,
    };
  });
}

/** The nearest to a place among some; a place far outside of all vessels has none. */
export function nearestTo(stations: Station[], place: Vec, reach: number): Station | undefined {
  let best: Station | undefined;
  let least = Infinity;
  for (const station of stations) {
    const apart = Math.hypot(...station.place.map((x, k) => x - place[k]!)) / Math.max(station.radius, 0.1);
    if (apart < least) [best, least] = [station, apart];
  }
  return least < reach ? best : undefined;
}

export function nearestArc(stations: Station[], arc: number): Station | undefined {
  return stations.reduce<Station | undefined>((best, s) => (!best || Math.abs(s.arc - arc) < Math.abs(best.arc - arc) ? s : best), undefined);
}

/** The direction of the line at one of its stations. */
export function directionAt(line: Station[], station: Station): Vec {
  const k = line.indexOf(station);
  const a = line[Math.max(0, k - 1)]!.place;
  const b = line[Math.min(line.length - 1, k + 1)]!.place;
  const d: Vec = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
  const length = Math.hypot(...d) || 1;
  return [d[0] / length, d[1] / length, d[2] / length];
}

/** The outlet whose line runs through the lesion: among those that reach its throat, the one with its branch's flow. */
export function outletThrough(stations: Station[], throat: number, flow: number): number {
  const badness = (s: Station): number => Math.abs(s.arc - throat) + (10 * Math.abs(s.values["flow_m3_per_s"]! - flow)) / Math.max(Math.abs(flow), 1e-12);
  return stations.reduce((best, s) => (badness(s) < badness(best) ? s : best), stations[0]!).outlet;
}

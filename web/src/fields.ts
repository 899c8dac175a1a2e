// SPDX-License-Identifier: Apache-2.0
// How each field is shown: its name, the unit that clinicians use, its range.

export interface FieldStyle {
  label: string;
  unit: string;
  scale: number; // shown = SI * scale
  fixed?: [number, number]; // a range that is the same in every report, as shown
  mark?: number; // a value worth a tick
}

const styles: Record<string, FieldStyle> = {
  FFR: { label: "FFR", unit: "", scale: 1, fixed: [0.5, 1], mark: 0.8 },
  Pressure: { label: "Pressure", unit: "mmHg", scale: 1 / 133.322387415 },
  WSS: { label: "WSS", unit: "Pa", scale: 1 },
  TAWSS: { label: "TAWSS", unit: "Pa", scale: 1 },
  OSI: { label: "OSI", unit: "", scale: 1, fixed: [0, 0.5] },
  Velocity: { label: "Speed", unit: "m/s", scale: 1 },
  VonMises: { label: "von Mises stress", unit: "MPa", scale: 1e-6 },
  PlasticStrain: { label: "Plastic strain", unit: "%", scale: 100 },
  Gap: { label: "Gap to the wall", unit: "mm", scale: 1e3 },
  Displacement: { label: "Displacement", unit: "mm", scale: 1e3 },
};

export function styleOf(field: string): FieldStyle {
  return styles[field] ?? { label: field, unit: "", scale: 1 };
}

export type Range = [number, number];

/** Of values as shown, without the outermost hundredths: single points do not set the scale. */
export function rangeOf(fields: Float32Array[], style: FieldStyle): Range {
  const sample: number[] = [];
  for (const values of fields) {
    const every = Math.max(1, Math.floor(values.length / 5000));
    for (let k = 0; k < values.length; k += every) if (!Number.isNaN(values[k]!)) sample.push(values[k]! * style.scale);
  }
  if (sample.length === 0) return [0, 1];
  sample.sort((a, b) => a - b);
  const low = sample[Math.floor(0.01 * (sample.length - 1))]!;
  const high = sample[Math.ceil(0.99 * (sample.length - 1))]!;
  return high > low ? [low, high] : [low - 0.5, low + 0.5];
}

/** Round numbers in a range, at least four: the coarsest that are. */
export function ticksOf([low, high]: Range): number[] {
  const power = 10 ** Math.floor(Math.log10(high - low));
  const steps = [1, 0.5, 0.25, 0.2, 0.1].map((factor) => factor * power);
  const first = (step: number): number => Math.ceil(low / step - 1e-9);
  const last = (step: number): number => Math.floor(high / step + 1e-9);
  const step = steps.find((s) => last(s) - first(s) >= 3) ?? steps.at(-1)!;
  return Array.from({ length: last(step) - first(step) + 1 }, (_, k) => (first(step) + k) * step);
}

/** Digits behind the point that a row of evenly spread marks needs. */
export function digitsOf(marks: number[]): number {
  const step = Math.abs((marks[1] ?? 1) - (marks[0] ?? 0));
  for (let digits = 0; digits < 6; digits++) if (Math.abs(step * 10 ** digits - Math.round(step * 10 ** digits)) < 1e-6) return digits;
  return 6;
}

/** With as many digits as tell neighbours of that range apart. */
export function format(value: number, [low, high]: Range): string {
  const digits = Math.min(6, Math.max(0, 2 - Math.floor(Math.log10(Math.max(high - low, 1e-6)))));
  return value.toFixed(digits).replace(/^-(0(\.0*)?)$/, "$1");
}

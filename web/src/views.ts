// SPDX-License-Identifier: Apache-2.0
// From where the vessel is looked at.
import type { Model, Vec } from "./model";

export interface Look {
  key: string;
  label: string;
  toward: Vec; // from the vessel to the eye
  up: Vec;
}

const negated = ([x, y, z]: Vec): Vec => [-x, -y, -z];

/** Of a C-arm: degrees to the patient's left (negative: right) and toward the head (negative: feet). Axes are the patient's: x to
 * the left, y to the back, z to the head (LPS). */
function angiographic(left: number, head: number): { toward: Vec; up: Vec } {
  const a = (left * Math.PI) / 180;
  const b = (head * Math.PI) / 180;
  return {
    toward: [Math.sin(a) * Math.cos(b), -Math.cos(a) * Math.cos(b), Math.sin(b)],
    up: [-Math.sin(a) * Math.sin(b), Math.cos(a) * Math.sin(b), Math.cos(b)],
  };
}

const angles: [string, string, number, number][] = [
  ["ap", "AP", 0, 0],
  ["rao-cau", "RAO 30 CAU 20", -30, -20],
  ["rao-cra", "RAO 30 CRA 30", -30, 30],
  ["lao-cra", "LAO 45 CRA 25", 45, 25],
  ["spider", "LAO 45 CAU 30", 45, -30],
];

/** The broad view and those around it; a cardiologist's, where the axes are a patient's. */
export function looksOf({ view, space }: Model): Look[] {
  const { right, up, toward } = view;
  const looks: Look[] = [
    { key: "front", label: "Broad side", toward, up },
    { key: "back", label: "From behind", toward: negated(toward), up },
    { key: "side", label: "From the side", toward: right, up },
    { key: "top", label: "From above", toward: up, up: negated(toward) },
  ];
  if (space !== "LPS" && space !== "RAS") return looks;
  const turned = ([x, y, z]: Vec): Vec => (space === "LPS" ? [x, y, z] : [-x, -y, z]);
  for (const [key, label, left, head] of angles) {
    const look = angiographic(left, head);
    looks.push({ key, label, toward: turned(look.toward), up: turned(look.up) });
  }
  return looks;
}

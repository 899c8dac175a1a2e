// SPDX-License-Identifier: Apache-2.0
// Folders of results to make pages of: real flows, and a run of three parts put together from two of them.
import { execFileSync } from "node:child_process";
import { cpSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

export const read = (path) => JSON.parse(readFileSync(path, "utf8"));
const write = (path, json) => writeFileSync(path, JSON.stringify(json, null, 2) + "\n");

export class Fixture {
  constructor(binary, cases, folder) {
    Object.assign(this, { binary, cases, folder });
    mkdirSync(folder, { recursive: true });
  }

  patency(...words) {
    return execFileSync(this.binary, words, { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
  }

  /** The bifurcation with its lesion, coarse, on cells: a real flow in seconds. */
  flow(command, name, ...settings) {
    const out = join(this.folder, name);
    const all = ["numerics.across=null", "numerics.spacing=0.4 mm", ...settings];
    this.patency(command, join(this.cases, "coronary_bifurcation.yaml"), "-o", out, "--fresh", ...all.flatMap((setting) => ["--set", setting]));
    return out;
  }

  /** Before and after from two lesions of the same vessel; the deployment's numbers and frames are made up here. */
  run() {
    const out = this.flow("run", "run", "aorta.pressure=93 mmHg");
    this.flow("flow", "run/after", "aorta.pressure=93 mmHg", "geometry.lesion.diameter_stenosis_percent=27");
    const summary = read(join(out, "summary.json"));
    const { estimate, before } = summary;
    const materials = [...summary.materials, { part: "wall", what: "coronary_wall", source: "arXiv 2511.08745", density_kg_per_m3: 1080, young_mpa: 1, poisson: 0.45 }];
    const estimate_after = { at_lesions: [{ ffr: 0.9951, ffr_band: [0.9917, 0.9973] }] };
    const deploy = {
      mode: "balloon", arc_length_mm: before.lesions[0].throat_arc_mm + 0.4, length_mm: 11.8, minimum_diameter_mm: 2.93, minimum_stent_area_mm2: 6.74,
      expansion_index: 0.884, malapposed_percent: 2.4, largest_gap_mm: 0.113, recoil_percent: 3.1, foreshortening_percent: 1.7, dogboning_percent: 4.2,
      penetration_over_spacing: 0.08, kinetic_to_internal: 0.012, lumen: { residual_stenosis_percent: 8.1 }, stresses: { wall_von_mises_pa: { media: { p50: 61000.3, p99: 214000.7 } } },
    };
    write(join(out, "summary.json"), { name: summary.name, materials, estimate, estimate_after, before, deploy, after: read(join(out, "after", "summary.json")) });
    const timing = read(join(out, "timing.json"));
    write(join(out, "timing.json"), { ...timing, deploy: { wall_s: 61.5, cpu_s: 120.3 }, after: read(join(out, "after", "timing.json")) });
    writeFrames(out, before.lesions[0]);
    this.patency("report", out);
    return out;
  }

  /** A copy of results with another summary, deck or files, and its page. */
  changed(from, name, change) {
    const out = join(this.folder, name);
    cpSync(from, out, { recursive: true });
    const summary = read(join(out, "summary.json"));
    change(summary, out);
    write(join(out, "summary.json"), summary);
    this.patency("report", out);
    return out;
  }
}

/** A zigzag ring that widens at the lesion, in four frames, and a sleeve of wall around it. */
function writeFrames(out, lesion) {
  const rows = readFileSync(join(out, "before", "pullback.csv"), "utf8").trim().split("\n").map((row) => row.split(","));
  const column = Object.fromEntries(rows[0].map((name, k) => [name, k]));
  const along = rows.slice(1).filter((row) => row[column.outlet] === "2").map((row) => row.map(Number));
  const at = (arc) => along.reduce((best, row) => (Math.abs(1e3 * row[0] - arc) < Math.abs(1e3 * best[0] - arc) ? row : best));
  const place = (row) => [row[column.x_m], row[column.y_m], row[column.z_m]].map((x) => 1e3 * x);
  const [centre, next] = [place(at(lesion.throat_arc_mm)), place(at(lesion.throat_arc_mm + 3))];
  const axis = unit(next.map((x, k) => x - centre[k]));
  const side = unit(cross(axis, [0.3, 0.5, 0.8]));
  const other = cross(axis, side);
  mkdirSync(join(out, "deploy", "frames"), { recursive: true });
  const around = (radius, angle, lift) => centre.map((x, j) => x + radius * (Math.cos(angle) * side[j] + Math.sin(angle) * other[j]) + lift * axis[j]);
  const series = { stent: "", wall: "" };
  const writeFrame = (body, frame, ...geometry) => {
    writeFileSync(join(out, "deploy", "frames", `${body}_${frame}.vtp`), vtp(...geometry));
    series[body] += `<DataSet timestep="${0.001 * frame}" part="0" file="frames/${body}_${frame}.vtp"/>\n`;
  };
  for (let frame = 0; frame < 4; frame++) {
    const radius = 0.7 + 0.25 * frame;
    const [points, triangles, stress] = [[], [], []];
    const count = 240;
    for (let k = 0; k < count; k++) {
      const [angle, lift] = [(2 * Math.PI * k) / count, 1.2 * Math.sin((2 * Math.PI * 8 * k) / count)];
      for (const edge of [-0.08, 0.08]) {
        points.push(around(radius, angle, lift + edge));
        stress.push(1e8 * frame * (1 + Math.cos(16 * angle)));
      }
      const [a, b, c, d] = [2 * k, 2 * k + 1, 2 * ((k + 1) % count), 2 * ((k + 1) % count) + 1];
      triangles.push([a, b, c], [b, d, c]);
    }
    writeFrame("stent", frame, points, triangles, stress);
  }
  const sleeve = { points: [], triangles: [] };
  const sides = 24;
  for (let k = 0; k < sides; k++) {
    for (const lift of [-4, 4]) sleeve.points.push(around(1.8, (2 * Math.PI * k) / sides, lift));
    const [a, b, c, d] = [2 * k, 2 * k + 1, 2 * ((k + 1) % sides), 2 * ((k + 1) % sides) + 1];
    sleeve.triangles.push([a, b, c], [b, d, c]);
  }
  writeFrame("wall", 0, sleeve.points, sleeve.triangles, sleeve.points.map((_, k) => 1e5 * (1 + Math.cos(k))));
  for (const [body, list] of Object.entries(series))
    writeFileSync(join(out, "deploy", `${body}.pvd`), `<?xml version="1.0"?>\n<VTKFile type="Collection">\n<Collection>\n${list}</Collection>\n</VTKFile>\n`);
}

const unit = (v) => v.map((x) => x / Math.hypot(...v));
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

function vtp(points, triangles, stress) {
  const array = (type, name, values, more = "") => `<DataArray type="${type}" Name="${name}"${more} format="ascii">${values.join(" ")}</DataArray>`;
  return `<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64"><PolyData>
<Piece NumberOfPoints="${points.length}" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="${triangles.length}">
<PointData>${array("Float32", "VonMises_stress", stress)}</PointData>
<Points>${array("Float32", "Points", points.flat(), ' NumberOfComponents="3"')}</Points>
<Polys>${array("Int32", "connectivity", triangles.flat())}${array("Int32", "offsets", triangles.map((_, k) => 3 * k + 3))}</Polys>
</Piece></PolyData></VTKFile>
`;
}

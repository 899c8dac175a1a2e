// SPDX-License-Identifier: Apache-2.0
// The curves' part of the page: which outlet, which quantity, and the chart.
import { Chart, valuesAt, type Band, type ChartContent } from "./chart";
import { chooser, fill, make } from "./dom";
import { readBytes, type Lesion, type Model, type Vec } from "./model";
import { nearestArc, nearestTo, outletThrough, quantities, readStations, type Station } from "./pullback";

export class Curves {
  readonly root = make("div", { className: "curves" });
  private readonly stations = new Map<string, Station[]>(); // by flow
  private readonly chart: Chart;
  private readonly outlet;
  private readonly quantity;
  private content: ChartContent | undefined;

  private constructor(private readonly model: Model, private readonly onHover: (station: Station | undefined, line: Station[], words: string) => void) {
    this.chart = new Chart((arc) => this.hovered(arc));
    this.outlet = chooser("to", [], () => this.show());
    this.quantity = chooser("Along the vessel", [], () => this.show());
    this.root.append(make("div", { className: "tools" }, this.quantity.root, this.outlet.root), this.chart.root);
  }

  static async read(model: Model, onHover: Curves["onHover"]): Promise<Curves | undefined> {
    const curves = new Curves(model, onHover);
    for (const flow of model.flows) {
      const file = model.files.find(({ name }) => name === flow.pullback);
      if (!file) continue;
      // Outlets are numbered by their areas, which may come in another order after a cut: here they have the first flow's numbers.
      const number = (own: number) => model.outlets.indexOf(flow.outlets[own - 1] ?? "") + 1 || own;
      const stations = readStations(new TextDecoder().decode(await readBytes(file.data)));
      curves.stations.set(flow.key, stations.map((station) => ({ ...station, outlet: number(station.outlet) })));
    }
    if (curves.stations.size === 0) return undefined;
    const known = [...curves.stations.values()].flat();
    fill(curves.outlet.select, model.outlets.map((label, k) => ({ value: String(k + 1), label })));
    fill(curves.quantity.select, quantities.filter(({ of }) => known.some((s) => of(s.values) !== undefined)).map(({ key, label }) => ({ value: key, label })));
    curves.outlet.select.value = String(curves.outletOfLesion());
    // An FFR far from its bands is a flat line on its scale; the pressure says more then.
    const ffr = known.map((s) => s.values["ffr"]).filter((value) => value !== undefined);
    if (ffr.length && ffr.every((value) => value > 0.95)) curves.quantity.select.value = "pressure";
    return curves;
  }

  lesion(): Lesion | undefined {
    return this.model.worst_lesion === null ? undefined : this.model.flows[0]?.lesions[this.model.worst_lesion];
  }

  /** Where the lesion is tightest. */
  throat(): Station | undefined {
    const lesion = this.lesion();
    const line = this.line(this.model.flows[0]?.key ?? "");
    return lesion && nearestArc(line, lesion.throat_mm);
  }

  show(): void {
    const quantity = quantities.find(({ key }) => key === this.quantity.select.value)!;
    const lines = this.model.flows.map(({ key, title }) => ({ key, title, stations: this.line(key) })).filter(({ stations }) => stations.length > 1);
    const lesion = Number(this.outlet.select.value) === this.outletOfLesion() ? this.lesion() : undefined;
    const bands: Band[] = lesion ? [{ from: lesion.start_mm, to: lesion.end_mm, style: "lesion" }] : [];
    const { stent } = this.model;
    if (stent && lesion) bands.push({ from: stent.start_mm, to: stent.end_mm, style: "stent" });
    this.content = { quantity, lines, bands, readAt: lesion?.read_mm };
    this.chart.show(this.content);
  }

  /** Moves the cursor to the station of a flow nearest to a place in space; says what is there. */
  point(flow: string, place: Vec | undefined): string {
    const station = place && (nearestTo(this.line(flow), place, 4) ?? this.change(flow, place));
    this.chart.point(station?.arc);
    return station && this.content ? valuesAt(this.content, station.arc) : "";
  }
  station(flow: string, place: Vec): { station: Station; line: Station[] } | undefined {
    const line = this.line(flow);
    const station = nearestTo(line, place, 4);
    return station && { station, line };
  }

  /** The place lies on no part of the line shown: shows the line that it lies on. */
  private change(flow: string, place: Vec): Station | undefined {
    const station = nearestTo(this.stations.get(flow) ?? [], place, 2);
    if (!station) return undefined;
    this.outlet.select.value = String(station.outlet);
    this.show();
    return station;
  }

  private line(flow: string): Station[] {
    const outlet = Number(this.outlet.select.value);
    return (this.stations.get(flow) ?? []).filter((s) => s.outlet === outlet);
  }

  private outletOfLesion(): number {
    const lesion = this.lesion();
    const first = [...this.stations.values()][0]!;
    if (!lesion) return first[0]?.outlet ?? 1;
    return outletThrough(first, lesion.throat_mm, lesion.flow_m3_per_s);
  }

  private hovered(arc: number | undefined): void {
    const line = this.line(this.content?.lines[0]?.key ?? "");
    const station = arc === undefined ? undefined : nearestArc(line, arc);
    this.onHover(station, line, station && this.content ? valuesAt(this.content, station.arc) : "");
  }
}

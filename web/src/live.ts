// SPDX-License-Identifier: Apache-2.0
// The live view: the vessel in space beside the curves along it, each pointing into the other.
import { Bar } from "./bar";
import { Curves } from "./curves";
import { chooser, fill, make, save, switcher } from "./dom";
import { format, styleOf } from "./fields";
import type { Model } from "./model";
import type { Station } from "./pullback";
import { directionAt } from "./pullback";
import { deployed, Vessel, type Seen } from "./vessel";
import { Viewer, type Hit } from "./viewer";
import { looksOf } from "./views";

const css = (name: string): string => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

export class LiveView {
  private readonly viewer = new Viewer((hit) => this.pointed(hit));
  private readonly bar: Bar;
  private readonly readout = make("p", { className: "readout" });
  private readonly field = chooser("Colour by", [], () => this.show());
  private readonly look;
  private readonly fit = make("input", { type: "checkbox" });
  private readonly cut = make("input", { type: "checkbox" });
  private readonly depth = make("input", { type: "range", min: "0", max: "1", step: "0.01", value: "0.5", ariaLabel: "where it is cut" });
  private readonly frame = make("input", { type: "range", min: "0", step: "1", value: "0" });
  private readonly frameTime = make("output");
  private readonly frameRow = make("label", { className: "frames" }, make("span", {}, "Deployment"), this.frame, this.frameTime);
  private readonly fitRow = make("label", { className: "check" }, this.fit, "fit scale");
  private readonly parts;
  private curves: Curves | undefined;
  private seen: Seen | undefined;
  private part: string;

  constructor(private readonly model: Model, private readonly vessel: Vessel) {
    this.bar = new Bar(vessel.colours);
    const parts = vessel.parts();
    this.part = parts[0]!.value;
    this.parts = switcher("Part of the run", parts, (part) => this.choose(part));
    this.parts.root.hidden = parts.length < 2;
    const looks = looksOf(model);
    const choices = looks.map(({ key, label }) => ({ value: key, label }));
    this.look = chooser("View", [...choices, { value: "lesion", label: "At the lesion" }], (key) => this.turn(key));
    for (const input of [this.fit, this.frame]) input.addEventListener("input", () => this.show());
    for (const input of [this.cut, this.depth]) input.addEventListener("input", () => this.viewer.clip(this.cut.checked, Number(this.depth.value)));
  }

  async open(host: HTMLElement): Promise<void> {
    this.curves = await Curves.read(this.model, (station, line, words) => this.mark(station, line, words));
    const shot = make("button", { type: "button" }, "Save picture");
    shot.addEventListener("click", () => void this.shoot());
    const tools = make("div", { className: "tools" }, this.parts.root, this.field.root, this.fitRow, this.look.root, make("label", { className: "check" }, this.cut, "cut open"), this.depth, shot);
    const canvas = make("div", { className: "canvas" }, this.viewer.root, this.bar.root, this.readout);
    const pair = make("div", { className: "pair" }, make("div", {}, canvas, this.frameRow), ...(this.curves ? [this.curves.root] : []));
    host.append(make("h2", {}, "The vessel"), tools, pair);
    host.hidden = false;
    this.choose(this.part);
    this.turn("front");
    this.curves?.show();
    this.viewer.clip(false, 0.5);
  }

  private choose(part: string): void {
    const isElsewhere = (part === deployed) !== (this.part === deployed); // a stent alone is small beside the vessel
    this.part = part;
    this.parts.set(part);
    const before = this.field.select.value;
    const fields = this.vessel.fields(part);
    fill(this.field.select, fields);
    this.field.select.value = fields.some(({ value }) => value === before) ? before : (fields.find(({ value }) => value === "wall:Pressure") ?? fields.at(-1))?.value ?? "";
    const frames = this.vessel.frameCount(part);
    this.frameRow.hidden = frames < 2;
    this.frame.max = String(Math.max(0, frames - 1));
    if (frames) this.frame.value = this.frame.max;
    this.show();
    if (isElsewhere) this.viewer.frame();
  }

  private show(): void {
    const field = this.field.select.value;
    const frame = Number(this.frame.value);
    this.seen = this.vessel.see(this.part, field, frame, this.fit.checked, this.viewer.clippingPlanes());
    this.fitRow.hidden = !styleOf(field.split(":")[1] ?? "").fixed;
    if (!this.frameRow.hidden) this.frameTime.textContent = `${(1e3 * this.vessel.timeOf(frame)).toPrecision(3)} ms`;
    this.bar.show(this.seen.style, this.seen.range);
    this.viewer.show(this.seen.objects, this.seen.targets);
    this.viewer.root.dataset["part"] = this.part;
    this.viewer.root.dataset["field"] = field;
  }

  private turn(key: string): void {
    const throat = this.curves?.throat();
    if (key === "lesion" && throat) return this.viewer.approach(throat.place, 5 * throat.radius + 3);
    const looks = looksOf(this.model);
    this.viewer.look(looks.find((look) => look.key === key) ?? looks[0]!);
  }

  /** The pointer is on the vessel: the curve follows. */
  private pointed(hit: Hit | undefined): void {
    const flow = this.part === deployed ? (this.model.flows[0]?.key ?? "") : this.part;
    const along = this.curves?.point(flow, hit?.place) ?? "";
    const there = hit && this.curves?.station(flow, hit.place);
    this.viewer.mark(there?.station.place, there && directionAt(there.line, there.station), there?.station.radius);
    const value = hit && this.seen?.values.get(hit.mesh)?.[hit.vertex];
    const { style, range } = this.seen ?? {};
    const here = value === undefined || !style || !range || Number.isNaN(value) ? "" : `${style.label} here: ${format(value * style.scale, range)} ${style.unit}`.trim();
    this.readout.textContent = [along, here].filter(Boolean).join(" · ");
  }

  /** The pointer is on the curve: the ring follows. */
  private mark(station: Station | undefined, line: Station[], words: string): void {
    this.viewer.mark(station?.place, station && directionAt(line, station), station?.radius);
    this.readout.textContent = words;
  }

  private async shoot(): Promise<void> {
    const picture = this.viewer.picture(css("panel") || "#fff");
    const context = picture.getContext("2d")!;
    const unit = Math.min(2, window.devicePixelRatio);
    this.bar.paint(context, css("ink") || "#111", unit);
    context.textAlign = "left";
    context.font = `${14 * unit}px system-ui, sans-serif`;
    const part = this.vessel.parts().find(({ value }) => value === this.part)?.label ?? "";
    context.fillText(`${this.model.name} · ${part} · research use only`, 14 * unit, 24 * unit);
    const file = await new Promise<Blob | null>((done) => picture.toBlob(done, "image/png"));
    if (file) save(`${this.model.name}_${this.part}.png`.replace(/[^\w.-]+/g, "_"), file);
  }
}

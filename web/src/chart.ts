// SPDX-License-Identifier: Apache-2.0
// Curves along the vessel: one quantity, every flow, the lesion shaded.
import uPlot from "uplot";
import { make } from "./dom";
import { digitsOf } from "./fields";
import { nearestArc, type Quantity, type Station } from "./pullback";

export interface Line {
  key: string; // of the flow: "before", "after", or "estimate"
  title: string;
  stations: Station[];
}

export interface Band {
  from: number;
  to: number;
  style: "lesion" | "stent";
}

export interface ChartContent {
  quantity: Quantity;
  lines: Line[];
  bands: Band[];
  readAt: number | undefined; // mm, where FFR is read
}

const height = (): number => (window.innerWidth < 640 ? 230 : 400);
const colour = (name: string): string => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

export class Chart {
  readonly root = make("div", { className: "chart" });
  private readonly legend = make("p", { className: "legend" });
  private readonly host = make("div", { className: "plot" });
  private plot: uPlot | undefined;
  private content: ChartContent | undefined;
  private isTold = false; // the cursor is being moved from outside

  constructor(private readonly onHover: (arc: number | undefined) => void) {
    this.root.append(this.legend, this.host);
    new ResizeObserver(() => this.plot?.setSize({ width: this.host.clientWidth, height: height() })).observe(this.host);
    this.host.addEventListener("mouseleave", () => this.onHover(undefined));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.content && this.show(this.content));
  }

  show(content: ChartContent): void {
    this.content = content;
    const { quantity } = content;
    const tables: uPlot.AlignedData[] = [];
    const series: uPlot.Series[] = [{}];
    this.legend.replaceChildren();
    const add = (line: Line, of: Quantity["of"]): void => {
      const values = line.stations.map((s) => of(s.values));
      if (values.every((v) => v === undefined)) return;
      tables.push([line.stations.map((s) => s.arc), values.map((v) => v ?? null)]);
      series.push({ label: line.title, stroke: colour(line.key), width: line.key === "estimate" ? 1.25 : 2, spanGaps: true, points: { show: false }, ...(line.key === "estimate" ? { dash: [5, 4] } : {}) });
      this.legend.append(make("span", { className: `key ${line.key}` }, line.title), " ");
    };
    for (const line of content.lines) add(line, quantity.of);
    if (quantity.estimate && content.lines[0]) add({ ...content.lines[0], key: "estimate", title: "1-D estimate" }, quantity.estimate);
    for (const band of content.bands) this.legend.append(make("span", { className: `key ${band.style}` }, band.style), " ");
    this.plot?.destroy();
    this.plot = tables.length ? new uPlot(this.options(series, content), uPlot.join(tables), this.host) : undefined;
  }

  /** Puts the cursor to an arc, or away; tells nobody. */
  point(arc: number | undefined): void {
    this.isTold = true;
    if (arc === undefined) this.plot?.setCursor({ left: -10, top: -10 });
    else this.plot?.setCursor({ left: this.plot.valToPos(arc, "x"), top: 10 });
    this.isTold = false;
    this.root.dataset["arc"] = arc === undefined ? "" : arc.toFixed(3);
  }

  private options(series: uPlot.Series[], content: ChartContent): uPlot.Options {
    const axis: uPlot.Axis = { stroke: colour("ink-soft"), grid: { stroke: colour("line"), width: 1 }, ticks: { stroke: colour("line"), width: 1 }, font: "12px system-ui, sans-serif", labelFont: "12px system-ui, sans-serif", labelSize: 18 };
    const { quantity } = content;
    return {
      width: this.host.clientWidth,
      height: height(),
      legend: { show: false },
      scales: { x: { time: false }, ...(content.quantity.least === undefined ? {} : { y: { range: (_, low) => [Math.min(content.quantity.least!, low - 0.02), 1.005] } }) },
      cursor: { y: false, drag: { x: true, y: false }, points: { size: 8 } },
      series,
      axes: [
        { ...axis, label: "Distance from the inlet, mm" },
        { ...axis, label: quantity.unit ? `${quantity.label}, ${quantity.unit}` : quantity.label, size: 62, values: (_, splits) => splits.map((value) => value.toFixed(digitsOf(splits))) },
      ],
      hooks: {
        drawClear: [(u) => this.shade(u, content)],
        setCursor: [(u) => this.hovered(u)],
      },
    };
  }

  private hovered(u: uPlot): void {
    if (this.isTold) return;
    const arc = u.cursor.idx == null ? undefined : u.data[0][u.cursor.idx];
    this.root.dataset["arc"] = arc === undefined ? "" : arc.toFixed(3);
    this.onHover(arc);
  }

  private shade(u: uPlot, { bands, readAt, quantity }: ChartContent): void {
    const { ctx } = u;
    const { left, top, width, height: high } = u.bbox;
    const x = (arc: number): number => Math.min(left + width, Math.max(left, u.valToPos(arc, "x", true)));
    ctx.save();
    for (const band of bands) {
      ctx.fillStyle = colour(`${band.style}-band`);
      ctx.fillRect(x(band.from), top, x(band.to) - x(band.from), high);
    }
    ctx.strokeStyle = colour("ink-soft");
    ctx.setLineDash([2, 4]);
    if (readAt !== undefined && quantity.key === "ffr") this.stroke(ctx, x(readAt), top, x(readAt), top + high);
    const level = u.valToPos(0.8, "y", true);
    if (quantity.key === "ffr" && level > top && level < top + high) this.stroke(ctx, left, level, left + width, level);
    ctx.restore();
  }

  private stroke(ctx: CanvasRenderingContext2D, x1: number, y1: number, x2: number, y2: number): void {
    ctx.beginPath();
    ctx.moveTo(x1, y1);
    ctx.lineTo(x2, y2);
    ctx.stroke();
  }
}

/** What the quantity is at an arc on every line, in words. */
export function valuesAt(content: ChartContent, arc: number): string {
  const parts = content.lines.map((line) => {
    const station = nearestArc(line.stations, arc);
    const value = station && content.quantity.of(station.values);
    return value === undefined ? "" : `${line.title} ${value.toPrecision(4)}`;
  });
  const unit = content.quantity.unit ? ` ${content.quantity.unit}` : "";
  return `${arc.toFixed(1)} mm · ${content.quantity.label}: ${parts.filter(Boolean).join(" · ")}${unit}`;
}

// SPDX-License-Identifier: Apache-2.0
// The scale of colours: always beside the vessel, always with its unit.
import { make } from "./dom";
import { digitsOf, ticksOf, type FieldStyle, type Range } from "./fields";
import type { Colours } from "./shapes";

const steps = 64;

export class Bar {
  readonly root = make("div", { className: "bar" });
  private shown: { style: FieldStyle; range: Range } | undefined;

  constructor(private readonly colours: Colours) {}

  show(style: FieldStyle | undefined, range: Range): void {
    this.shown = style && { style, range };
    this.root.replaceChildren();
    this.root.hidden = !style;
    if (!style) return;
    const strip = make("canvas", { className: "strip", width: 1, height: steps });
    const context = strip.getContext("2d")!;
    for (let k = 0; k < steps; k++) {
      context.fillStyle = this.colours.css(1 - (k + 0.5) / steps);
      context.fillRect(0, k, 1, 1);
    }
    const scale = make("div", { className: "scale" }, strip);
    for (const { value, text } of this.ticks(style, range)) {
      const tick = make("span", { className: "tick" }, text);
      tick.style.bottom = `${(100 * (value - range[0])) / (range[1] - range[0])}%`;
      scale.append(tick);
    }
    this.root.append(make("p", {}, style.label, make("br"), style.unit || "–"), scale);
  }

  /** The same on a picture: its upper right corner, `unit` pixels to one of the page. */
  paint(context: CanvasRenderingContext2D, ink: string, unit: number): void {
    if (!this.shown) return;
    const { style, range } = this.shown;
    const [left, top, width, height] = [context.canvas.width - 84 * unit, 56 * unit, 14 * unit, 180 * unit];
    for (let k = 0; k < steps; k++) {
      context.fillStyle = this.colours.css(1 - (k + 0.5) / steps);
      context.fillRect(left, top + (k * height) / steps, width, height / steps + 1);
    }
    context.fillStyle = ink;
    context.font = `${12 * unit}px system-ui, sans-serif`;
    context.textAlign = "right";
    context.fillText(style.unit ? `${style.label}, ${style.unit}` : style.label, context.canvas.width - 14 * unit, top - 16 * unit);
    context.textAlign = "left";
    for (const { value, text } of this.ticks(style, range)) context.fillText(text, left + 20 * unit, top + height * (1 - (value - range[0]) / (range[1] - range[0])) + 4 * unit);
  }

  private ticks(style: FieldStyle, range: Range): { value: number; text: string }[] {
    const values = ticksOf(range);
    const digits = digitsOf(values);
    if (style.mark !== undefined && style.mark > range[0] && style.mark < range[1] && !values.some((v) => Math.abs(v - style.mark!) < 1e-9)) values.push(style.mark);
    return values.map((value) => ({ value, text: value.toFixed(Math.abs(value - (style.mark ?? NaN)) < 1e-9 ? Math.max(2, digits) : digits) }));
  }
}

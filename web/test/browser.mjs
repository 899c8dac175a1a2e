// SPDX-License-Identifier: Apache-2.0
// A browser for the tests, and what they look at in it.
import { existsSync } from "node:fs";
import { chromium } from "playwright-core";

const program = "/usr/bin/chromium";
export const hasBrowser = () => existsSync(program);

export class Browser {
  constructor(...more) {
    this.arguments = ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
      "--use-angle=swiftshader", "--enable-unsafe-swiftshader", ...more]; // a software GPU: pictures do not depend on the machine
  }

  async start() {
    this.browser = await chromium.launch({ executablePath: program, args: this.arguments });
  }
  async stop() {
    await this.browser?.close();
  }

  /** A page that is ready; `requests` and `complaints` (console errors and warnings, uncaught errors) are noted on it. */
  async open(url, options = {}) {
    for (const context of this.browser.contexts()) await context.close(); // one page at a time is enough for a small machine
    const context = await this.browser.newContext({ viewport: { width: 1280, height: 900 }, acceptDownloads: true, ...options });
    const page = await context.newPage();
    page.requests = [];
    page.complaints = [];
    page.on("request", (request) => page.requests.push(request.url()));
    page.on("pageerror", (error) => page.complaints.push(error.message));
    // The software GPU is slow to read pixels back and says so; that is no fault of the page.
    page.on("console", (line) => {
      if (["error", "warning"].includes(line.type()) && !/GPU stall due to ReadPixels/.test(line.text())) page.complaints.push(line.text());
    });
    await page.goto(url);
    if (options.javaScriptEnabled !== false) await page.waitForFunction(() => document.title.startsWith("READY"), null, { timeout: 60_000 });
    return page;
  }

  /** Of an element's picture: how far its colours spread (standard deviation of saturation, 0 to 255), and how much of it is coloured. */
  async look(locator) {
    const picture = (await locator.screenshot()).toString("base64");
    const context = await this.browser.newContext();
    const page = await context.newPage();
    const result = await page.evaluate(async (text) => {
      const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${text}`)).blob());
      const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
      const painter = canvas.getContext("2d");
      painter.drawImage(bitmap, 0, 0);
      const { data } = painter.getImageData(0, 0, bitmap.width, bitmap.height);
      let [sum, squares, coloured] = [0, 0, 0];
      const count = data.length / 4;
      for (let k = 0; k < data.length; k += 4) {
        const vivid = Math.max(data[k], data[k + 1], data[k + 2]) - Math.min(data[k], data[k + 1], data[k + 2]);
        sum += vivid;
        squares += vivid * vivid;
        if (vivid > 40) coloured++;
      }
      return { spread: Math.sqrt(squares / count - (sum / count) ** 2), share: coloured / count };
    }, picture);
    await context.close();
    return result;
  }
}

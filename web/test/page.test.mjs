// SPDX-License-Identifier: Apache-2.0
// The page in a real browser: Debian's Chromium, driven by playwright-core, on pages that the program made of real flows.
// usage: node page.test.mjs BINARY CASES [FOLDER]; a FOLDER is kept, and a run that is there is used again. Exit code 77: there is no Chromium, nothing was tested
import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, describe, it } from "node:test";
import { pathToFileURL } from "node:url";
import { Fixture, read } from "./fixture.mjs";
import { Browser, hasBrowser } from "./browser.mjs";

if (!hasBrowser()) {
  console.log("page.test: there is no /usr/bin/chromium, so the page was not tested; ./run test installs it");
  process.exit(77);
}

const [binary, cases, kept] = process.argv.slice(2);
const folder = kept ?? mkdtempSync(join(tmpdir(), "patency-page-"));
const fixture = new Fixture(binary, cases, folder);
const browser = new Browser();
let run = "";
const urlOf = (out) => pathToFileURL(join(out, "report.html")).href;

before(async () => {
  run = existsSync(join(folder, "run", "report.html")) ? join(folder, "run") : fixture.run();
  await browser.start();
}, { timeout: 300_000 });
after(async () => {
  await browser.stop();
  if (!kept) rmSync(folder, { recursive: true });
});

/** The number at a JSON pointer. */
const at = (json, pointer) => pointer.split("/").slice(1).reduce((part, key) => part?.[key.replaceAll("~1", "/").replaceAll("~0", "~")], json);

/** What the page should show for an element's number. */
function expected({ path, over, scale, digits, source }, sources) {
  const number = at(sources[source], path) / (over ? at(sources[source], over) : 1);
  if (digits.startsWith("e")) return (scale * number).toExponential(Number(digits.slice(1))).replace(/e([+-])(\d)$/, "e$10$2");
  return (scale * number).toFixed(Number(digits)).replace(/^-(0(\.0*)?)$/, "$1");
}

/** All numbers on a page, with where they say they come from. */
const numbersOf = (page) => page.$$eval("data", (all) => all.map((element) => ({
  ...element.dataset, scale: Number(element.dataset.scale), value: Number(element.value), text: element.textContent,
  source: element.closest("[data-source]")?.dataset.source ?? "summary",
})));

describe("the page of a run of three parts", () => {
  it("is one small file that gets ready with one request and without an error", async () => {
    assert.ok(statSync(join(run, "report.html")).size < 5e6);
    const page = await browser.open(urlOf(run));
    assert.match(await page.title(), /^READY/);
    assert.deepEqual(page.requests.filter((url) => !/^(data|blob):/.test(url)), [urlOf(run)]);
    assert.deepEqual(page.complaints, []);
  });

  it("lets nothing out: its policy stops a request", async () => {
    const page = await browser.open(urlOf(run));
    const answer = await page.evaluate(() => fetch("http://127.0.0.1:9/").then(() => "sent", () => "stopped"));
    assert.equal(answer, "stopped");
    assert.ok(page.complaints.some((text) => text.includes("Content Security Policy")), String(page.complaints));
  });

  it("draws the vessel", async () => {
    const page = await browser.open(urlOf(run));
    const { spread, share } = await browser.look(page.locator(".canvas-host"));
    assert.ok(spread > 20, `colours spread by ${spread}`);
    assert.ok(share > 0.02, `${share} of the canvas is vessel`);
  });

  it("shows numbers of summary.json and timing.json only, as they are", async () => {
    const page = await browser.open(urlOf(run));
    const sources = { summary: read(join(run, "summary.json")), timing: read(join(run, "timing.json")) };
    const numbers = await numbersOf(page);
    assert.ok(numbers.length > 150, `${numbers.length} numbers`);
    for (const number of numbers) {
      const original = at(sources[number.source], number.path) / (number.over ? at(sources[number.source], number.over) : 1);
      assert.equal(number.value, original, number.path);
      assert.equal(number.text, expected(number, sources), number.path);
    }
    for (const part of ["/before/lesions/0/ffr", "/after/lesions/0/ffr", "/deploy/malapposed_percent", "/after/openings/outlet_small/flow_m3_per_s", "/materials/1/young_mpa", "/estimate/lesions/0/ffr_band/1", "/estimate_after/at_lesions/0/ffr_band/0"])
      assert.ok(numbers.some(({ path }) => path === part), part);
    const strays = await page.$$eval("td, .figure, .checks, .facts b", (cells) => cells.filter((cell) => {
      const copy = cell.cloneNode(true);
      for (const known of copy.querySelectorAll("data, code, .unit, .what, .verdict, .source")) known.remove();
      return /\d\.\d/.test(copy.textContent.replace(/3\.5 mPa s/, ""));
    }).map((cell) => cell.textContent));
    assert.deepEqual(strays, []);
  });

  it("says what everything is made of and who says so", async () => {
    const page = await browser.open(urlOf(run));
    const row = page.locator("#tables tr", { hasText: "coronary_wall" });
    assert.match(await row.innerText(), /Young's modulus 1\.00 MPa.*arXiv/s);
  });

  it("carries summary.json and the tables as they are", async () => {
    const page = await browser.open(urlOf(run));
    const embedded = await page.$eval("#summary", (element) => JSON.parse(element.textContent));
    assert.deepEqual(embedded, read(join(run, "summary.json")));
    for (const name of ["summary.json", "before/pullback.csv", "after/sections.csv"]) {
      const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("link", { name, exact: true }).click()]);
      assert.equal(readFileSync(await download.path(), "utf8"), readFileSync(join(run, name), "utf8"), name);
    }
  });

  it("marks on the vessel what is hovered on the curve", async () => {
    const page = await browser.open(urlOf(run));
    await page.locator(".u-over").hover({ position: { x: 120, y: 60 } });
    await page.waitForFunction(() => document.querySelector(".canvas-host").dataset.mark);
    const arc = Number(await page.locator(".chart").getAttribute("data-arc"));
    const mark = (await page.locator(".canvas-host").getAttribute("data-mark")).split(" ").map(Number);
    const [head, ...rows] = readFileSync(join(run, "before", "pullback.csv"), "utf8").trim().split("\n").map((row) => row.split(","));
    const outlet = await page.locator(".curves select").nth(1).inputValue();
    const row = rows.find((cells) => cells[head.indexOf("outlet")] === outlet && Math.abs(1e3 * cells[0] - arc) < 2e-3);
    assert.ok(row, `a station at ${arc} mm`);
    ["x_m", "y_m", "z_m"].forEach((name, k) => assert.ok(Math.abs(1e3 * row[head.indexOf(name)] - mark[k]) < 1e-3, `${name} ${mark}`));
    assert.match(await page.locator(".readout").textContent(), /mm · .*Before .* After /);
    await page.mouse.move(5, 5);
    await page.waitForFunction(() => !document.querySelector(".canvas-host").dataset.mark);
  });

  it("marks on the curve what is hovered on the vessel", async () => {
    const page = await browser.open(urlOf(run));
    await page.locator(".canvas-host canvas").scrollIntoViewIfNeeded();
    const box = await page.locator(".canvas-host canvas").boundingBox();
    for (let step = 0; step < 60; step++) { // somewhere down a column left of the middle there is vessel
      await page.mouse.move(box.x + 0.45 * box.width, box.y + (0.2 + 0.01 * step) * box.height);
      await page.waitForTimeout(50);
      if (await page.locator(".chart").getAttribute("data-arc")) break;
    }
    assert.ok(Number(await page.locator(".chart").getAttribute("data-arc")) > 1);
    assert.match(await page.locator(".readout").textContent(), /Pressure here: -?\d/);
  });

  it("switches between before, deployment and after, the scale with its unit beside each", async () => {
    const page = await browser.open(urlOf(run));
    const canvas = page.locator(".canvas-host");
    const pictures = [];
    for (const [label, part] of [["Before", "before"], ["Deployment", "deploy"], ["After", "after"]]) {
      await page.getByRole("button", { name: label, exact: true }).click();
      assert.equal(await canvas.getAttribute("data-part"), part);
      await page.waitForTimeout(300);
      pictures.push((await canvas.screenshot()).toString("base64"));
    }
    assert.equal(new Set(pictures).size, 3);
    for (const [field, unit] of [["wall:FFR", "–"], ["wall:Pressure", "mmHg"], ["wall:WSS", "Pa"], ["wall:TAWSS", "Pa"], ["wall:OSI", "–"], ["cut:Velocity", "m/s"], ["streamlines:Velocity", "m/s"]]) {
      await page.getByLabel("Colour by").selectOption(field);
      assert.equal(await canvas.getAttribute("data-field"), field);
      assert.ok(await page.locator(".bar").isVisible());
      assert.ok((await page.locator(".bar p").innerText()).endsWith(unit), field);
      assert.ok((await page.locator(".bar .tick").count()) >= 3, field);
    }
    assert.deepEqual(page.complaints, []);
  });

  it("comes near to what is implanted, and goes back to the whole vessel", async () => {
    const page = await browser.open(urlOf(run));
    const canvas = page.locator(".canvas-host canvas");
    const coloured = async (part) => {
      await page.getByRole("button", { name: part, exact: true }).click();
      await page.waitForTimeout(300);
      return (await browser.look(canvas)).share;
    };
    const [before, deployment, after] = [await coloured("Before"), await coloured("Deployment"), await coloured("After")];
    assert.ok(deployment > 0.1, `${deployment} of the canvas`);
    assert.ok(Math.abs(after / before - 1) < 0.1, `${before}, then ${after}`);
  });

  it("moves through the frames of the deployment", async () => {
    const page = await browser.open(urlOf(run));
    await page.getByRole("button", { name: "Deployment" }).click();
    const slider = page.locator(".frames input");
    assert.equal(await slider.getAttribute("max"), "3");
    const pictures = [];
    for (const frame of ["0", "3"]) {
      await slider.fill(frame);
      await page.waitForTimeout(300);
      pictures.push((await page.locator(".canvas-host").screenshot()).toString("base64"));
    }
    assert.notEqual(pictures[0], pictures[1]);
  });

  it("cuts the vessel open and saves a picture", async () => {
    const page = await browser.open(urlOf(run));
    const whole = await browser.look(page.locator(".canvas-host canvas"));
    await page.getByLabel("cut open", { exact: true }).check();
    await page.waitForTimeout(300);
    assert.ok((await browser.look(page.locator(".canvas-host canvas"))).share < 0.9 * whole.share);
    const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Save picture" }).click()]);
    assert.deepEqual([...readFileSync(await download.path()).subarray(1, 4)], [..."PNG"].map((letter) => letter.charCodeAt(0)));
  });

  it("prints on three or four pages", async () => {
    const page = await browser.open(urlOf(run));
    const paper = (await page.pdf({ preferCSSPageSize: true })).toString("latin1");
    const pages = paper.match(/\/Type \/Page\b(?!s)/g).length;
    assert.ok(pages === 3 || pages === 4, `${pages} pages`);
  });

  it("fits a screen of 360 pixels", async () => {
    const page = await browser.open(urlOf(run), { viewport: { width: 360, height: 740 } });
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 360);
    const cut = await page.$$eval(".card *, .lead, .checks *, .tools *", (all) => all.filter((element) => element.getBoundingClientRect().right > 360).map((element) => element.outerHTML.slice(0, 80)));
    assert.deepEqual(cut, []);
  });

  it("works without a script: pictures, curves, tables", async () => {
    const page = await browser.open(urlOf(run), { javaScriptEnabled: false });
    assert.ok(await page.locator("#still").isVisible());
    assert.ok(!(await page.locator("#live").isVisible()));
    assert.equal(await page.locator("#still svg.pullback").count(), 2);
    assert.ok((await browser.look(page.locator("#still img").first())).spread > 20);
    assert.ok(await page.locator("#tables td").count() > 50);
    assert.match(await page.locator("#glance").innerText(), /0\.99 → 0\.99/);
  });

  it("shows pictures and curves where there is no WebGL", async () => {
    const blind = new Browser("--disable-3d-apis");
    await blind.start();
    try {
      const page = await blind.open(urlOf(run));
      assert.match(await page.title(), /^READY/);
      assert.ok(await page.locator("#still img").first().isVisible());
      assert.match(await page.locator("#still").innerText(), /live view is not available/);
    } finally {
      await blind.stop();
    }
  });
});

describe("pages of other results", () => {
  const attack = `</script><img src=x onerror="window.wasHacked=1"><b class='attack'>&"'`;

  it("shows hostile text as text", async () => {
    const out = fixture.changed(run, "hostile", (summary, to) => {
      summary.name = attack;
      summary.before.lesions[0].branch = summary.before.branches[2].name = attack;
      summary.before.openings[attack] = summary.before.openings.outlet_small;
      summary.before.made_from.inputs = { [attack]: attack };
      delete summary.after;
      writeFileSync(join(to, "before", "case.resolved.yaml"), `case: {name: x}\nwall: {motion: ${JSON.stringify(attack)}}\n# </pre>${attack}\n`);
    });
    const page = await browser.open(urlOf(out));
    assert.match(await page.title(), /^READY/);
    assert.deepEqual(page.complaints, []);
    assert.equal(await page.evaluate(() => window.wasHacked), undefined);
    assert.equal(await page.locator("img[src=x], .attack").count(), 0);
    assert.equal(await page.locator("h1").textContent(), attack);
    assert.match(await page.locator("pre").first().textContent(), /<\/pre><\/script><img/);
    assert.equal(await page.$eval("#summary", (element) => JSON.parse(element.textContent).name), attack);
  });

  it("makes do with what is there", async () => {
    const out = fixture.changed(run, "sparse", (summary, to) => {
      delete summary.deploy;
      delete summary.after;
      delete summary.estimate;
      for (const key of ["lesions", "convergence", "mass_imbalance_percent", "made_from", "branches"]) delete summary.before[key];
      for (const name of ["outlet_medium", "outlet_small"]) delete summary.before.openings[name];
      for (const file of ["wall.vtp", "cut.vtp", "pullback.csv", "case.resolved.yaml"]) rmSync(join(to, "before", file));
    });
    const page = await browser.open(urlOf(out));
    assert.match(await page.title(), /^READY/);
    assert.deepEqual(page.complaints, []);
    assert.ok(await page.locator("#tables td").count() > 8);
  });

  it("shows branches before and after by their names, wherever they stand in the lists", async () => {
    const out = fixture.changed(run, "reordered", (summary) => {
      summary.after.branches.reverse();
      summary.after.branches[0].name = "new_one"; // and one is found in one of them only
    });
    const page = await browser.open(urlOf(out));
    const { before, after } = read(join(out, "summary.json"));
    const table = page.locator("table", { has: page.locator("caption", { hasText: /^Branches$/ }) });
    const rows = await table.locator("tbody tr").evaluateAll((all) => all.map((row) => ({
      name: row.querySelector("th").textContent, paths: [...row.querySelectorAll("data")].map((element) => element.dataset.path) })));
    assert.deepEqual(rows.map(({ name }) => name), [...before.branches.map(({ name }) => name), "new_one"]);
    for (const { name, paths } of rows)
      for (const path of paths) {
        const [, part, , k] = path.split("/");
        assert.equal({ before, after }[part].branches[k].name, name);
      }
    assert.ok(rows[1].paths.some((path) => path.startsWith("/before/")) && rows[1].paths.some((path) => path.startsWith("/after/")));
  });

  it("says when a treated vessel has no lesion any more", async () => {
    const out = fixture.changed(run, "healed", (summary) => {
      summary.after.lesions = [];
      summary.after.ffr = { lesion: null, reason: "no lesion was found" };
    });
    const page = await browser.open(urlOf(out));
    assert.deepEqual(page.complaints, []);
    assert.match(await page.locator("#glance").innerText(), /no longer narrows/);
  });

  it("reads the FFR of a treated vessel where the lesion was", async () => {
    const out = fixture.changed(run, "treated", (summary) => {
      const { branch, throat_arc_mm, read_arc_mm } = summary.before.lesions[0];
      summary.after.lesions = [];
      summary.after.at_lesions = [{ branch, throat_arc_mm, read_arc_mm, flow_m3_per_s: 1.2e-6, drop_pa: 20.1, ffr: 0.9412 }];
    });
    const page = await browser.open(urlOf(out));
    const glance = await page.locator("#glance").innerText();
    assert.match(glance, /0\.99 → 0\.94/);
    assert.match(glance, /at least 0\.90, the usual aim/);
    assert.match(glance, /39\.6 → 8\.1 %/); // what the deployment left
    assert.doesNotMatch(glance, /no longer narrows/);
  });

  it("gives no FFR without an aortic pressure, and says why", async () => {
    const out = fixture.flow("flow", "gauge", "numerics.spacing=0.5 mm", "geometry.lesion.diameter_stenosis_percent=30");
    assert.ok(existsSync(join(out, "report.html")));
    const page = await browser.open(urlOf(out));
    assert.deepEqual(page.complaints, []);
    const glance = await page.locator("#glance").innerText();
    assert.match(glance, /No FFR: the deck gives no aortic pressure/);
    assert.equal(await page.locator(".ffr-scale").count(), 0);
    assert.equal(await page.getByRole("button", { name: "After" }).count(), 0);
  });
});

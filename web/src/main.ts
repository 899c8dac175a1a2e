// SPDX-License-Identifier: Apache-2.0
// Makes the page live. Without this script, or where it fails, the page stays as the program wrote it: tables, pictures, curves.
import threeLicence from "../node_modules/three/LICENSE";
import uplotLicence from "../node_modules/uplot/LICENSE";
import { make } from "./dom";
import { LiveView } from "./live";
import { readBytes, readModel, type Model } from "./model";
import { Vessel } from "./vessel";

/** The run's tables as files: unpacked only when they are asked for. */
function offerFiles(model: Model): void {
  for (const link of document.querySelectorAll<HTMLAnchorElement>("a[data-file]")) {
    const file = model.files.find(({ name }) => name === link.dataset["file"]);
    if (!file) continue;
    link.href = "#";
    link.classList.remove("needs-script");
    link.addEventListener("click", (event) => {
      if (link.href.startsWith("blob:")) return; // the second of the two clicks
      event.preventDefault();
      void readBytes(file.data).then((bytes) => {
        link.href = URL.createObjectURL(new Blob([bytes], { type: "text/csv" }));
        link.click();
      });
    });
  }
}

function showLicences(): void {
  const host = document.getElementById("licences");
  for (const [name, text] of [["three.js", threeLicence], ["uPlot", uplotLicence]])
    host?.append(make("details", {}, make("summary", {}, `Licence of ${name}, which this page uses`), make("pre", {}, text!)));
}

async function openLive(model: Model): Promise<void> {
  const vessel = await Vessel.read(model);
  const host = document.getElementById("live");
  if (!host || vessel.parts().length === 0) return;
  const live = new LiveView(model, vessel); // throws where there is no WebGL
  document.documentElement.classList.add("is-live");
  await live.open(host);
}

async function start(): Promise<void> {
  const model = readModel();
  offerFiles(model);
  showLicences();
  try {
    await openLive(model);
  } catch (reason) {
    document.documentElement.classList.remove("is-live");
    const message = `The live view is not available here (${String(reason)}); pictures and curves stand in its place.`;
    document.getElementById("still")?.prepend(make("p", { className: "note" }, message));
  }
  requestAnimationFrame(() => requestAnimationFrame(() => {
    document.title = `READY · ${model.name} – patency`;
  }));
}

void start();

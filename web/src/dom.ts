// SPDX-License-Identifier: Apache-2.0
// Elements in a line. Text is always text, never markup.

type Child = Node | string;

export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  properties: Partial<HTMLElementTagNameMap[K]> = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

/** The text of a script element that holds data. */
export function dataText(id: string): string {
  return document.getElementById(id)?.textContent ?? "";
}

export interface Choice {
  value: string;
  label: string;
  group?: string;
}

/** A list to choose from, with a label. */
export function chooser(label: string, choices: Choice[], onChange: (value: string) => void): { root: HTMLLabelElement; select: HTMLSelectElement } {
  const select = make("select");
  fill(select, choices);
  select.addEventListener("change", () => onChange(select.value));
  return { root: make("label", { className: "chooser" }, make("span", {}, label), select), select };
}

export function fill(select: HTMLSelectElement, choices: Choice[]): void {
  select.replaceChildren();
  const groups = new Map<string, HTMLOptGroupElement>();
  for (const { value, label, group } of choices) {
    const option = make("option", { value }, label);
    if (group === undefined) {
      select.append(option);
      continue;
    }
    const known = groups.get(group) ?? make("optgroup", { label: group });
    if (!groups.has(group)) select.append(known);
    groups.set(group, known);
    known.append(option);
  }
}

/** Buttons of which one is pressed. */
export function switcher(name: string, choices: Choice[], onChange: (value: string) => void): { root: HTMLElement; set: (value: string) => void } {
  const buttons = choices.map(({ value, label }) => {
    const button = make("button", { type: "button", value }, label);
    button.addEventListener("click", () => {
      set(value);
      onChange(value);
    });
    return button;
  });
  function set(value: string): void {
    for (const button of buttons) button.setAttribute("aria-pressed", String(button.value === value));
  }
  const root = make("div", { className: "switcher" }, ...buttons);
  root.setAttribute("role", "group");
  root.setAttribute("aria-label", name);
  return { root, set };
}

/** Offers bytes as a file. */
export function save(name: string, content: Blob): void {
  const link = make("a", { href: URL.createObjectURL(content), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** Elements of the page, made in one expression. */

type Child = Node | string | null | undefined | false;

type Properties = Record<string, unknown>;

/** An element with attributes (strings, numbers, true), listeners (functions, by the name of the event after `on`) and children. */
export function h<Tag extends keyof HTMLElementTagNameMap>(tag: Tag, properties: Properties = {}, ...children: Child[]): HTMLElementTagNameMap[Tag] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (typeof value === "function") {
      element.addEventListener(name.slice(2).toLowerCase(), value as EventListener);
    } else if (name === "value" || name === "checked" || name === "disabled" || name === "hidden") {
      (element as unknown as Properties)[name] = value;
    } else if (value === true) {
      element.setAttribute(name, "");
    } else if (value !== false && value !== null && value !== undefined) {
      element.setAttribute(name, String(value));
    }
  }
  element.append(...children.filter((child): child is Node | string => child !== null && child !== undefined && child !== false));
  return element;
}

/** A button with a text; `keys` is the shortcut that it tells. */
export function button(text: string, action: () => void, properties: Properties & { keys?: string } = {}): HTMLButtonElement {
  const { keys, ...rest } = properties;
  const title = [rest.title ?? text, keys && `(${keys})`].filter(Boolean).join(" ");
  return h("button", { type: "button", ...rest, title, "aria-keyshortcuts": keys, onclick: action }, text);
}

let labels = 0;

/** An input with its label before it. */
export function field(text: string, input: HTMLInputElement | HTMLSelectElement | HTMLOutputElement, unit = ""): HTMLDivElement {
  input.id ||= `field-${labels++}`;
  return h("div", { class: "field" }, h("label", { for: input.id }, text), input, unit ? h("span", { class: "unit" }, unit) : null);
}

/** A number that can be typed; `change` is called with each one that is valid. */
export function numberInput(value: number, change: (value: number) => void, properties: Properties = {}): HTMLInputElement {
  const input = h("input", { type: "number", step: "any", value: String(value), ...properties });
  input.addEventListener("change", () => {
    if (input.value !== "" && Number.isFinite(input.valueAsNumber) && input.validity.valid) {
      change(input.valueAsNumber);
    }
  });
  return input;
}

/** A slider. */
export function slider(min: number, max: number, value: number, change: (value: number) => void, properties: Properties = {}): HTMLInputElement {
  const input = h("input", { type: "range", min, max, step: "any", value: String(value), ...properties });
  input.addEventListener("input", () => change(input.valueAsNumber));
  return input;
}

/** A box that is ticked or not. */
export function toggle(text: string, value: boolean, change: (value: boolean) => void, properties: Properties = {}): HTMLLabelElement {
  const input = h("input", { type: "checkbox", checked: value, ...properties });
  input.addEventListener("change", () => change(input.checked));
  return h("label", { class: "toggle" }, input, text);
}

/** A choice among names. */
export function choice(names: readonly string[], value: string, change: (value: string) => void, properties: Properties = {}): HTMLSelectElement {
  const select = h("select", properties, ...names.map((name) => h("option", { value: name }, name)));
  select.value = value;
  select.addEventListener("change", () => change(select.value));
  return select;
}

/** A number as people read it. */
export function shown(value: number, digits = 6): string {
  if (!Number.isFinite(value)) {
    return "–";
  }
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e9 || size < 1e-4)) {
    return value.toExponential(digits - 2);
  }
  return Number(value.toPrecision(digits)).toLocaleString("en", { maximumFractionDigits: 8 });
}

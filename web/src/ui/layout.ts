/** Menus, dialogs and panels with tabs, which work with a keyboard. */

import { button, h } from "./element";

/** A button that opens a list of actions. */
export class Menu {
  readonly element: HTMLElement;

  constructor(name: string, items: [string, () => void][]) {
    const list = h("div", { class: "menu-list", role: "menu", hidden: true });
    const opener = button(name, () => (list.hidden ? open() : close()), { "aria-haspopup": "menu", "aria-expanded": "false", class: "menu-button" });
    const entries = items.map(([text, action]) =>
      button(
        text,
        () => {
          close();
          action();
        },
        { role: "menuitem", tabindex: "-1" },
      ),
    );
    list.append(...entries);
    this.element = h("div", { class: "menu" }, opener, list);
    const open = () => {
      list.hidden = false;
      opener.setAttribute("aria-expanded", "true");
      entries[0]?.focus();
    };
    const close = () => {
      const hadFocus = list.contains(document.activeElement);
      list.hidden = true;
      opener.setAttribute("aria-expanded", "false");
      if (hadFocus) {
        opener.focus();
      }
    };
    this.element.addEventListener("keydown", (event) => {
      const at = entries.indexOf(document.activeElement as HTMLButtonElement);
      const to: Record<string, number> = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: entries.length - 1 };
      const next = to[event.key];
      if (event.key === "Escape" && !list.hidden) {
        close();
        event.stopPropagation();
      } else if (next !== undefined && (at >= 0 || event.key === "ArrowDown")) {
        event.preventDefault();
        event.stopPropagation();
        if (list.hidden) {
          open();
        } else {
          entries[(next + entries.length) % entries.length]?.focus();
        }
      }
    });
    this.element.addEventListener("focusout", (event) => {
      if (!this.element.contains(event.relatedTarget as Node | null)) {
        close();
      }
    });
  }
}

/** A window over the page. */
export class Dialog {
  readonly element: HTMLDialogElement;

  constructor(title: string, ...content: HTMLElement[]) {
    this.element = h("dialog", { "aria-label": title }, h("div", { class: "dialog-head" }, h("h2", {}, title), button("✕", () => this.close(), { title: "Close", "aria-label": "Close" })), ...content);
    this.element.addEventListener("click", (event) => {
      if (event.target === this.element) {
        this.close();
      }
    });
  }

  show() {
    this.element.showModal();
  }

  close() {
    this.element.close();
  }
}

/** Panels of which one is seen. */
export class Tabs {
  readonly element: HTMLElement;
  private readonly tabs: HTMLButtonElement[];
  private readonly panels: HTMLElement[];

  constructor(
    label: string,
    private readonly entries: [string, HTMLElement][],
  ) {
    this.tabs = entries.map(([name], k) => h("button", { type: "button", role: "tab", id: `tab-${name}`, "aria-controls": `panel-${name}`, onclick: () => this.select(k) }, name));
    this.panels = entries.map(([name, content]) => h("div", { role: "tabpanel", id: `panel-${name}`, "aria-labelledby": `tab-${name}`, class: "panel" }, content));
    const list = h("div", { role: "tablist", "aria-label": label, class: "tabs" }, ...this.tabs);
    list.addEventListener("keydown", (event) => {
      const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
      if (step !== 0) {
        event.preventDefault();
        event.stopPropagation();
        const at = this.tabs.indexOf(document.activeElement as HTMLButtonElement);
        const next = (at + step + this.tabs.length) % this.tabs.length;
        this.select(next);
        this.tabs[next]?.focus();
      }
    });
    this.element = h("aside", { "aria-label": label }, list, ...this.panels);
    this.select(0);
  }

  /** Shows the panel of a name. */
  show(name: string) {
    this.select(this.entries.findIndex(([other]) => other === name));
  }

  private select(at: number) {
    this.tabs.forEach((tab, k) => {
      tab.setAttribute("aria-selected", String(k === at));
      tab.tabIndex = k === at ? 0 : -1;
      this.panels[k]!.hidden = k !== at;
    });
  }
}

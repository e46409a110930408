/** Light or dark: as the system says, until the user chooses. */

const KEY = "planecut-theme";

/** The theme of the page. */
export class Theme {
  private readonly system = matchMedia("(prefers-color-scheme: dark)");

  constructor(private readonly apply: (isDark: boolean) => void) {
    this.system.addEventListener("change", () => this.set());
    this.set();
  }

  get isDark(): boolean {
    const chosen = stored();
    return chosen ? chosen === "dark" : this.system.matches;
  }

  toggle() {
    try {
      localStorage.setItem(KEY, this.isDark ? "light" : "dark");
    } catch {
      // a page without storage keeps to the system
    }
    this.set();
  }

  private set() {
    document.documentElement.dataset.theme = this.isDark ? "dark" : "light";
    this.apply(this.isDark);
  }
}

function stored(): string | null {
  try {
    return localStorage.getItem(KEY);
  } catch {
    return null;
  }
}

/** The page: puts the parts together, and says what keys and buttons do. */

import { Vector3 } from "three";

import { exampleAddress, gallery } from "./ui/gallery";
import { Document } from "./app/document";
import { READABLE, WRITABLE, download, sourceOfAddress, sourceOfFile, stem } from "./app/files";
import { Gizmo, type GizmoMode } from "./app/gizmo";
import { SHAPES, shapePlanes, type Shape } from "./app/shapes";
import { Tools, type ToolName } from "./app/tools";
import { button, field, h, numberInput, toggle } from "./ui/element";
import { LookPanel } from "./ui/look";
import { MeasurePanel } from "./ui/measures";
import { Menu, Dialog, Tabs } from "./ui/layout";
import { Messages } from "./ui/messages";
import { PageState } from "./ui/page_state";
import { ParameterPanel } from "./ui/parameters";
import { Properties } from "./ui/properties";
import { shortcuts, type Shortcut } from "./ui/shortcuts";
import { SourcePane } from "./ui/source";
import { Theme } from "./ui/theme";
import { TreeList } from "./ui/tree";
import { Viewer } from "./view/viewer";
import "./style.css";

const TOOLS: [ToolName, string, string, string][] = [
  ["select", "Drag faces", "1", "Click to choose; drag a face along its normal; drag elsewhere to turn the view"],
  ["turn", "Turn planes", "2", "Drag a face to turn its plane; Shift for steps of 15°"],
  ["cut", "Cut", "3", "Drag a line across a brush: what lies right of it goes; Shift for planes along axes"],
  ["measure", "Measure", "4", "Click two places"],
];

const HANDLES: [GizmoMode, string, string][] = [
  ["translate", "Move brush", "M"],
  ["rotate", "Turn brush", "R"],
  ["scale", "Scale brush", "S"],
];

const VIEWS: [string, string, [number, number, number]][] = [
  ["Front", "Shift+1", [0, -1, 0]],
  ["Right", "Shift+2", [1, 0, 0]],
  ["Top", "Shift+3", [0, -0.0001, 1]],
  ["Corner", "Shift+4", [1, -1.3, 0.8]],
];

const document_ = new Document();
const canvas = h("canvas", { tabindex: "0", role: "application", "aria-label": "The solid. Arrow keys turn the view, plus and minus move nearer and away." });
const hint = h("div", { class: "hint", hidden: true });
const stage = h("div", { class: "stage" }, canvas, hint);
const viewer = new Viewer(canvas);
const measures = new MeasurePanel(document_);
const tools = new Tools(document_, viewer, {
  hint(text, event) {
    hint.hidden = !text;
    hint.textContent = text;
    if (event) {
      const { left, top, width, height } = stage.getBoundingClientRect();
      const x = Math.max(0, Math.min(event.clientX - left + 14, width - hint.offsetWidth - 4));
      const y = Math.max(0, Math.min(event.clientY - top + 18, height - hint.offsetHeight - 4));
      hint.style.transform = `translate(${x}px, ${y}px)`;
    }
  },
  measured: (text) => measures.tell(text),
});
const gizmo = new Gizmo(document_, viewer, tools);
const properties = new Properties(document_, viewer);
const look = new LookPanel(document_, viewer);
const tree = new TreeList(document_);
const parameters = new ParameterPanel(document_);
const messages = new Messages(document_);
const source = new SourcePane(document_);
const theme = new Theme((isDark) => {
  viewer.setTheme(isDark);
  source.setTheme(isDark);
});

const state = new PageState(document_, viewer, look);

async function openExample(file: string) {
  gallerySheet.close();
  const from = exampleAddress(file);
  if (from) {
    await state.open(() => sourceOfAddress(from, file));
  }
}

const chooser = h("input", { type: "file", accept: READABLE.join(","), hidden: true, "aria-label": "A file to open" });
chooser.addEventListener("change", () => {
  const [file] = chooser.files ?? [];
  if (file) {
    void state.open(() => sourceOfFile(file));
  }
  chooser.value = "";
});

const gallerySheet = new Dialog("Examples", gallery((file) => void openExample(file)));

const address = h("input", { type: "text", placeholder: "models/part.json", "aria-label": "Address of a file on this server" });
const addressSheet = new Dialog(
  "Open an address",
  h("p", { class: "note" }, "A file on the same server as this page: nothing is loaded from elsewhere."),
  field("Address", address),
  h("div", { class: "row" }, button("Open", () => void openAddress())),
);

async function openAddress() {
  addressSheet.close();
  await state.open(() => sourceOfAddress(address.value));
}

async function save(format: string) {
  const name = stem(document_.source?.name ?? "model");
  await document_.attempt(async () => {
    const bytes = await document_.kernel.call("encode", format);
    download(bytes as BlobPart, `${name}.${format}`);
  });
}

function savePicture() {
  viewer.frame();
  canvas.toBlob((blob) => blob && download(blob, `${stem(document_.source?.name ?? "model")}.png`, "image/png"), "image/png");
}

async function share() {
  const fits = await state.rememberNow();
  await navigator.clipboard?.writeText(location.href).catch(() => {});
  document_.say(fits ? "The address of this page holds the model, the edits and the view. It is in the clipboard." : "The model, or the edits, are too long for an address: it holds the view, and what else has room. Save the model as a file to keep it.");
}

function add(shape: Shape, role: "add" | "subtract") {
  const box = document_.faces.box();
  const radius = box.isEmpty() ? 4 : box.getSize(new Vector3()).length() / 2;
  const size = Number((radius / 3).toPrecision(1)) || 1;
  const { target } = viewer.controls;
  const { grid } = tools.settings;
  const at = target.toArray().map((value, k) => {
    const place = value + document_.center[k]!;
    return grid > 0 ? Math.round(place / grid) * grid : Number(place.toFixed(6));
  }) as [number, number, number];
  void document_.attempt(async () => {
    const planes = shapePlanes(shape, at, size);
    const { brush } = await document_.edit({ op: "add_brush", planes, role, name: shape, material: role === "add" ? "new" : "cut" });
    document_.select(brush === undefined ? null : { brush, plane: null, face: null });
    if (!gizmo.mode) {
      useHandles("translate");
    }
  });
}

async function newModel() {
  const text = '{\n  "planecut": 1,\n  "model": {"box": {"min": [0, 0, 0], "max": [4, 3, 2]}}\n}\n';
  await state.open(() => ({ name: "model.json", bytes: new TextEncoder().encode(text), parameters: {}, origin: {} }));
}

function undo() {
  void document_.attempt(() => document_.edit({ op: "undo" }));
}

function redo() {
  void document_.attempt(() => document_.edit({ op: "redo" }));
}

function fit() {
  viewer.fit(document_.faces.box());
  state.remember();
}

const toolButtons = new Map(TOOLS.map(([name, text, keys, title]) => [name, button(text, () => tools.use(name), { keys, title, class: "tool", "data-tool": name })]));
const handleButtons = new Map(HANDLES.map(([mode, text, keys]) => [mode, button(text, () => useHandles(gizmo.mode === mode ? null : mode), { keys, class: "tool" })]));

function useHandles(mode: GizmoMode | null) {
  gizmo.use(mode);
  handleButtons.forEach((element, name) => element.setAttribute("aria-pressed", String(name === mode)));
}

tools.onTool = (name) => toolButtons.forEach((element, other) => element.setAttribute("aria-pressed", String(other === name)));
tools.use("select");
useHandles(null);

const undoButton = button("Undo", undo, { keys: "Control+Z" });
const redoButton = button("Redo", redo, { keys: "Control+Shift+Z" });

function showHistory() {
  undoButton.disabled = document_.history.undo === 0;
  redoButton.disabled = document_.history.redo === 0;
}

const snapPart = h(
  "div",
  { class: "snap" },
  field("Grid", numberInput(0, (grid) => (tools.settings.grid = grid), { min: 0, "aria-label": "Distance of the grid, 0 for none" })),
  toggle("Snap to planes and corners", true, (snaps) => (tools.settings.snapsToPlanes = snaps)),
);

const helpSheet = new Dialog("Keys and mouse", h("div", { id: "help" }));

const header = h(
  "header",
  {},
  h("h1", {}, h("img", { src: "icon.svg", alt: "", width: 22, height: 22 }), "planecut"),
  new Menu("File", [
    ["New", () => void newModel()],
    ["Open…", () => chooser.click()],
    ["Open an address…", () => addressSheet.show()],
    ["Examples…", () => gallerySheet.show()],
    ...WRITABLE.map(([format, name]): [string, () => void] => [`Save as ${name}`, () => void save(format)]),
    ["Save picture (PNG)", savePicture],
    ["Copy address of this state", () => void share()],
  ]).element,
  new Menu("Add", [...SHAPES.map((shape): [string, () => void] => [`Add ${shape}`, () => add(shape, "add")]), ...SHAPES.map((shape): [string, () => void] => [`Cut out ${shape}`, () => add(shape, "subtract")])]).element,
  new Menu("View", [["Fit", fit], ...VIEWS.map(([name, , direction]): [string, () => void] => [name, () => viewer.lookFrom(new Vector3(...direction))]), ["Light or dark", () => theme.toggle()]]).element,
  h("div", { class: "group", role: "group", "aria-label": "History" }, undoButton, redoButton),
  h("div", { class: "group", role: "toolbar", "aria-label": "Tools" }, ...toolButtons.values()),
  h("div", { class: "group", role: "toolbar", "aria-label": "Handles" }, ...handleButtons.values()),
  snapPart,
  button("Keys", () => helpSheet.show(), { keys: "?" }),
);

const left = new Tabs("Model", [
  ["Tree", tree.element],
  ["Text", source.element],
  ["Parameters", parameters.element],
]);
const right = new Tabs("Details", [
  ["Edit", properties.element],
  ["Look", look.element],
  ["Measure", measures.element],
]);

document.getElementById("app")!.append(header, h("main", {}, left.element, stage, right.element), messages.element, chooser, gallerySheet.element, addressSheet.element, helpSheet.element);

const keys: Shortcut[] = [
  { keys: "Control+O", text: "Open a file", action: () => chooser.click() },
  { keys: "Control+S", text: "Save as GLB", action: () => void save("glb") },
  { keys: "Control+Z", text: "Undo", action: undo },
  { keys: "Control+Shift+Z", text: "Redo", action: redo },
  { keys: "Control+Y", text: "Redo", action: redo },
  ...TOOLS.map(([name, text, key]) => ({ keys: key, text, action: () => tools.use(name) })),
  ...HANDLES.map(([mode, text, key]) => ({ keys: key, text, action: () => useHandles(gizmo.mode === mode ? null : mode) })),
  ...VIEWS.map(([name, key, direction]) => ({ keys: key, text: `Look from: ${name.toLowerCase()}`, action: () => viewer.lookFrom(new Vector3(...direction)) })),
  { keys: "A", text: "Fit all into view", action: fit },
  { keys: "E", text: "Edges", action: () => look.toggleEdges() },
  { keys: "Y", text: "X-ray", action: () => look.toggleXray() },
  { keys: "C", text: "Section", action: () => look.toggleSection() },
  { keys: "B", text: "Cells moved apart", action: () => void look.toggleCells() },
  { keys: "H", text: "Colliders", action: () => void look.toggleColliders() },
  { keys: "X", text: "Remove the chosen plane", action: () => onPlane((brush, plane) => properties.removePlane(brush, plane)) },
  { keys: "F", text: "Keep the other side of the chosen plane", action: () => onPlane((brush, plane) => properties.flip(brush, plane)) },
  { keys: "[", text: "Move the chosen plane in", action: () => onPlane((brush, plane) => nudge(brush, plane, -1)) },
  { keys: "]", text: "Move the chosen plane out", action: () => onPlane((brush, plane) => nudge(brush, plane, 1)) },
  { keys: "N", text: "Choose the next plane of the brush", action: () => void nextPlane() },
  { keys: "Shift+D", text: "Copy the chosen brush", action: () => onBrush((brush) => properties.copy(brush)) },
  { keys: "Delete", text: "Delete the chosen brush", action: () => onBrush((brush) => properties.remove(brush)) },
  { keys: "G", text: "Examples", action: () => gallerySheet.show() },
  { keys: "?", text: "Keys and mouse", action: () => helpSheet.show() },
  {
    keys: "Escape",
    text: "End what is under way, or choose nothing",
    action: () => (tools.isBusy ? tools.cancel() : document_.select(null)),
  },
];

function onBrush(work: (brush: number) => void) {
  if (document_.selection) {
    work(document_.selection.brush);
  }
}

function onPlane(work: (brush: number, plane: number) => void) {
  const { selection } = document_;
  if (selection?.plane != null) {
    work(selection.brush, selection.plane);
  }
}

/** Moves a plane by a step of the grid, or by a hundredth of the model. */
function nudge(brush: number, plane: number, direction: number) {
  const { grid } = tools.settings;
  const size = document_.faces.box().getSize(new Vector3()).length();
  const step = direction * (grid > 0 ? grid : Number((size / 100).toPrecision(1)));
  void document_.attempt(async () => {
    const half = await document_.halfSpace(brush, plane);
    if (half) {
      await document_.edit({ op: "move_plane", brush, plane, offset: half[3] + step * Math.hypot(half[0], half[1], half[2]) });
    }
  });
}

async function nextPlane() {
  const { selection } = document_;
  if (selection) {
    await document_.attempt(async () => {
      const { planes } = await document_.brush(selection.brush);
      const at = planes.findIndex(({ plane }) => plane === selection.plane);
      const next = planes[(at + 1) % planes.length];
      document_.select({ ...selection, plane: next?.plane ?? null, face: null });
    });
  }
}

document.getElementById("help")!.replaceChildren(shortcuts(keys, canvas, viewer));

for (const name of ["dragover", "drop"] as const) {
  addEventListener(name, (event) => {
    event.preventDefault();
    const [file] = name === "drop" ? (event.dataTransfer?.files ?? []) : [];
    if (file) {
      void state.open(() => sourceOfFile(file));
    }
  });
}

let isFirst = true;
let lastName: string | null = null;

document_.on("opened", ({ time }) => {
  viewer.show(document_.faces);
  const isOther = lastName !== document_.source?.name;
  lastName = document_.source?.name ?? null;
  if (isOther) {
    viewer.fit(document_.faces.box());
  } else {
    viewer.setReach(document_.faces.box().getSize(new Vector3()).length() / 2 || 1);
  }
  document.title = `${document_.source?.name ?? ""} · planecut`;
  const lost = document_.warnings.reduce((sum, { leftOut }) => sum + leftOut, 0);
  document_.warnings.slice(0, 3).forEach(({ message, line }) => document_.say(message, lost > 0 ? "error" : "note", line || null));
  if (!isFirst && isOther) {
    document_.say(`${document_.source?.name}: read and built in ${time.toFixed(0)} ms`);
  }
  isFirst = false;
  showHistory();
  state.remember();
});
document_.on("changed", ({ step }) => {
  showHistory();
  viewer.draw();
  if (!step) {
    state.remember();
  }
});
document_.on("selected", (selection) => selection && right.show("Edit"));
viewer.onCamera = () => state.remember();
look.onChange = () => state.remember();

// for tests in a browser, and for whoever looks on
Object.assign(globalThis, { planecut: { document: document_, viewer, tools, look, gizmo } });

await state.restore();
document.body.dataset.ready = "true";

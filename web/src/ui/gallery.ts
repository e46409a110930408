/** Examples that can be opened without a file of one's own. */

import { h } from "./element";

interface Example {
  title: string;
  file: string;
  picture: string;
  about: string;
}

const EXAMPLES: Example[] = [
  { title: "Castle", file: "castle.json", picture: "castle.png", about: "walls and towers by arrays and rings" },
  { title: "Bracket", file: "bracket.json", picture: "bracket.png", about: "seven parameters, countersunk holes" },
  { title: "Gear", file: "gear.json", picture: "gear.png", about: "one tooth, repeated; two materials" },
  { title: "Flange", file: "flange.json", picture: "flange.png", about: "a profile that is turned, and bolts" },
  { title: "Rook", file: "rook.json", picture: "rook.png", about: "a chess piece by revolution and cuts" },
  { title: "Vase", file: "vase.json", picture: "vase.png", about: "a twisted extrusion, hollow" },
  { title: "Truss", file: "truss.json", picture: "truss.png", about: "hulls of balls as bars" },
  { title: "Enclosure", file: "enclosure.json", picture: "enclosure.png", about: "a box with a lid, by Minkowski sums" },
  { title: "Menger sponge", file: "menger.json", picture: "menger.png", about: "three levels of square holes" },
  { title: "Keep", file: "keep.map", picture: "../keep.png", about: "a Quake map" },
];

const files = import.meta.glob<string>(["../../../examples/*.json", "../../../examples/*.map"], { query: "?url", import: "default", eager: true });
const pictures = import.meta.glob<string>(
  ["../../../docs/gallery/{castle,bracket,gear,flange,rook,vase,truss,enclosure,menger}.png", "../../../docs/keep.png"],
  { query: "?url", import: "default", eager: true },
);

/** The address of an example by the name of its file; nothing where there is none. */
export function exampleAddress(file: string): string | null {
  return files[`../../../examples/${file}`] ?? null;
}

/** Cards with pictures; `open` is called with the file of the one that is chosen. */
export function gallery(open: (file: string) => void): HTMLElement {
  const card = ({ title, file, picture, about }: Example) =>
    h(
      "button",
      { type: "button", class: "card", onclick: () => open(file) },
      h("img", { src: pictures[picture.startsWith("../") ? `../../../docs/${picture.slice(3)}` : `../../../docs/gallery/${picture}`] ?? "", alt: "", loading: "lazy", width: 320, height: 240 }),
      h("b", {}, title),
      h("span", {}, about),
    );
  return h("div", { class: "gallery" }, ...EXAMPLES.map(card));
}

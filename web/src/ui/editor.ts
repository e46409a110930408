/** How the text pane behaves and looks. */

import { closeBrackets, closeBracketsKeymap, completionKeymap } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { bracketMatching, defaultHighlightStyle, HighlightStyle, indentOnInput, syntaxHighlighting } from "@codemirror/language";
import { lintGutter, lintKeymap } from "@codemirror/lint";
import { highlightSelectionMatches, searchKeymap } from "@codemirror/search";
import type { Extension } from "@codemirror/state";
import { drawSelection, EditorView, highlightActiveLine, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";

/** Line numbers, history, search, brackets. The tab key leaves the pane after Escape. */
export function basicSetupOf(): Extension {
  return [
    lineNumbers(),
    history(),
    drawSelection(),
    indentOnInput(),
    bracketMatching(),
    closeBrackets(),
    highlightActiveLine(),
    highlightSelectionMatches(),
    lintGutter(),
    syntaxHighlighting(defaultHighlightStyle, { fallback: true }),
    keymap.of([...closeBracketsKeymap, ...defaultKeymap, ...searchKeymap, ...historyKeymap, ...completionKeymap, ...lintKeymap, indentWithTab]),
    EditorView.theme({ "&": { height: "100%", fontSize: "13px" }, ".cm-scroller": { fontFamily: "ui-monospace, monospace" } }),
  ];
}

const darkHighlight = HighlightStyle.define([
  { tag: tags.propertyName, color: "#8ec7ff" },
  { tag: tags.string, color: "#a6e3a1" },
  { tag: tags.number, color: "#f9c97c" },
  { tag: [tags.bool, tags.null], color: "#f38ba8" },
  { tag: [tags.separator, tags.brace, tags.squareBracket], color: "#a9b1c0" },
]);

export const darkTheme: Extension = [
  EditorView.theme(
    {
      "&": { backgroundColor: "#16181d", color: "#e4e7ec" },
      ".cm-gutters": { backgroundColor: "#16181d", color: "#8a93a3", border: "none" },
      ".cm-activeLine": { backgroundColor: "#ffffff0a" },
      ".cm-cursor": { borderLeftColor: "#e4e7ec" },
      "&.cm-focused .cm-selectionBackground, .cm-selectionBackground": { backgroundColor: "#2c4a70" },
    },
    { dark: true },
  ),
  syntaxHighlighting(darkHighlight),
];

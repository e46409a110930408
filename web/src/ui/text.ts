/** The text of the model, with completion by the schema of model files, and errors at their lines. */

import { autocompletion, type Completion, type CompletionContext, type CompletionResult } from "@codemirror/autocomplete";
import { basicSetupOf, darkTheme } from "./editor";
import { json } from "@codemirror/lang-json";
import { syntaxTree } from "@codemirror/language";
import { setDiagnostics, type Diagnostic } from "@codemirror/lint";
import { Compartment, EditorState } from "@codemirror/state";
import { EditorView } from "@codemirror/view";

import schema from "../../../docs/model.schema.json";

type Schema = {
  $ref?: string;
  description?: string;
  properties?: Record<string, Schema>;
  additionalProperties?: Schema | boolean;
  items?: Schema;
  anyOf?: Schema[];
  oneOf?: Schema[];
  enum?: unknown[];
  const?: unknown;
  type?: string;
};

/** A text that is edited. */
export class TextPane {
  readonly view: EditorView;
  private readonly language = new Compartment();
  private readonly theme = new Compartment();
  private isQuiet = false;

  /** `changed` is called with the text when the user has changed it. */
  constructor(parent: HTMLElement, changed: (text: string) => void) {
    const listener = EditorView.updateListener.of((update) => {
      if (update.docChanged && !this.isQuiet) {
        changed(update.state.doc.toString());
      }
    });
    this.view = new EditorView({
      parent,
      state: EditorState.create({ extensions: [basicSetupOf(), this.language.of([]), this.theme.of([]), listener, EditorView.contentAttributes.of({ "aria-label": "Text of the model" })] }),
    });
  }

  /** Shows another text; a model file is coloured and completed. */
  show(text: string, isModel: boolean) {
    this.isQuiet = true;
    const extensions = isModel ? [json(), autocompletion({ override: [complete] })] : [];
    this.view.dispatch({
      changes: { from: 0, to: this.view.state.doc.length, insert: text },
      effects: this.language.reconfigure(extensions),
    });
    this.isQuiet = false;
    this.mark(null);
  }

  /** Marks the line of an error; none with `null`. */
  mark(error: { message: string; line: number } | null) {
    const diagnostics: Diagnostic[] = [];
    if (error) {
      const { doc } = this.view.state;
      const line = doc.line(Math.min(doc.lines, Math.max(1, error.line)));
      diagnostics.push({ from: line.from, to: line.to, severity: "error", message: error.message });
    }
    this.view.dispatch(setDiagnostics(this.view.state, diagnostics));
  }

  setTheme(isDark: boolean) {
    this.view.dispatch({ effects: this.theme.reconfigure(isDark ? darkTheme : []) });
  }
}

/** What the schema allows where the cursor is. */
function complete(context: CompletionContext): CompletionResult | null {
  const node = syntaxTree(context.state).resolveInner(context.pos, -1);
  const isKey = node.name === "PropertyName" || ((node.name === "{" || node.name === "Object" || node.name === ",") && context.explicit);
  const isText = node.name === "String";
  if (!isKey && !isText) {
    return null;
  }
  const path: string[] = [];
  let at: typeof node | null = isKey && node.name === "PropertyName" ? node.parent!.parent : node.name === "Object" ? node : node.parent;
  if (isText) {
    const property = node.parent;
    if (property?.name === "Property") {
      path.push(nameOf(property, context.state));
      at = property.parent;
    } else {
      path.push("[]");
      at = node.parent?.parent ?? null;
    }
  }
  for (; at; at = at.parent) {
    if (at.name === "Property") {
      path.unshift(nameOf(at, context.state));
    } else if (at.name === "Array") {
      path.unshift("[]");
    }
  }
  const schemas = path.reduce((found, step) => found.flatMap((one) => stepInto(one, step)), resolve(schema as Schema));
  const options: Completion[] = [];
  for (const found of schemas) {
    if (isKey) {
      for (const [name, property] of Object.entries(found.properties ?? {})) {
        const info = resolve(property).find(({ description }) => description)?.description;
        options.push({ label: name, type: "property", apply: node.name === "PropertyName" ? `"${name}"` : `"${name}": `, ...(info ? { info } : {}) });
      }
    } else {
      (found.enum ?? []).forEach((value) => typeof value === "string" && options.push({ label: value, type: "enum", apply: `"${value}"` }));
    }
  }
  const unique = [...new Map(options.map((option) => [option.label, option])).values()];
  if (unique.length === 0) {
    return null;
  }
  const isToken = node.name === "PropertyName" || isText;
  return { from: isToken ? node.from : context.pos, options: unique, ...(isToken ? { filter: false, options: matching(unique, context.state.sliceDoc(node.from, context.pos)) } : {}) };
}

/** Options whose names contain what was typed, between quotes. */
function matching(options: Completion[], typed: string): Completion[] {
  const text = typed.replace(/"/g, "").toLowerCase();
  return options.filter(({ label }) => label.toLowerCase().includes(text));
}

function nameOf(property: { firstChild: { from: number; to: number } | null }, state: EditorState): string {
  const name = property.firstChild;
  return name ? state.sliceDoc(name.from, name.to).replace(/^"|"$/g, "") : "";
}

/** A schema without references and alternatives: all that it may be. */
function resolve(one: Schema, depth = 0): Schema[] {
  if (depth > 8) {
    return [];
  }
  const named = one.$ref ? (schema as unknown as { $defs: Record<string, Schema> }).$defs[one.$ref.replace("#/$defs/", "")] : undefined;
  const alternatives = [...(named ? [named] : []), ...(one.anyOf ?? [])].flatMap((other) => resolve(other, depth + 1));
  return [one, ...alternatives];
}

function stepInto(one: Schema, step: string): Schema[] {
  if (step === "[]") {
    return one.items ? resolve(one.items) : [];
  }
  const property = one.properties?.[step] ?? (typeof one.additionalProperties === "object" ? one.additionalProperties : undefined);
  return property ? resolve(property) : [];
}

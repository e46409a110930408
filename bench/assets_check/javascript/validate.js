// Validates glTF files: paths on standard input, one a line; for each a line of JSON with the path and what was found.

import { readFileSync } from "node:fs";
import { createInterface } from "node:readline";
import validator from "gltf-validator";

const SEVERITIES = ["error", "warning", "info", "hint"];

for await (const path of createInterface({ input: process.stdin })) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(path)), { maxIssues: 0 });
  const messages = report.issues.messages.map(({ code, message, severity, pointer, offset }) => ({
    severity: SEVERITIES[severity],
    code,
    message,
    place: pointer ?? `byte ${offset}`,
  }));
  console.log(JSON.stringify({ path, messages }));
}

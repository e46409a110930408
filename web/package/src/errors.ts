/** What goes wrong. */

/** Input that cannot be used, told in one line: what was found, and what was expected. */
export class PlanecutError extends Error {
  /** The line of the file, counted from 1, where there is one. */
  readonly line: number | null;
  /** The place in a model file, as `$.model.box`, where there is one. */
  readonly jsonPath: string | null;

  /**
   * @param message - What was found, and what was expected.
   * @param place - Where in a file that is.
   */
  constructor(message: string, place: { line?: number | null; jsonPath?: string | null } = {}) {
    super(message);
    this.name = "PlanecutError";
    this.line = place.line ?? null;
    this.jsonPath = place.jsonPath ?? null;
  }
}

/** A bug in planecut; please report it. Where its message says so, nothing of the instance can be used any more: begin another worker or process. */
export class InternalError extends Error {
  /**
   * @param message - What was found.
   * @param options - The cause.
   */
  constructor(message: string, options?: ErrorOptions) {
    super(message, options);
    this.name = "InternalError";
  }
}

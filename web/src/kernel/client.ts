/** The kernel as the page calls it: requests to a worker, which is started again where it ends. */

import type { CallName, Calls, Fault, Response } from "./protocol";

/** Something that the kernel refused, or a bug. */
export class KernelError extends Error {
  /** The line of the input, counted from 1. */
  readonly line: number | null;
  /** The place in a model file. */
  readonly jsonPath: string | null;
  /** Whether the worker has ended. */
  readonly isFatal: boolean;

  constructor({ message, line, jsonPath, isFatal }: Fault) {
    super(message);
    this.line = line;
    this.jsonPath = jsonPath;
    this.isFatal = isFatal;
  }
}

interface Pending {
  resolve(result: unknown): void;
  reject(error: KernelError): void;
}

/** A worker with the kernel. */
export class Kernel {
  private worker: Worker | null = null;
  private ready: Promise<void> = Promise.resolve();
  private pending = new Map<number, Pending>();
  private next = 0;

  /** Is called with what went wrong when the worker has ended and another one has started, which has no model. */
  onRestart: (reason: string) => void = () => {};
  /** Is called when there is work, and when there is no more. */
  onBusy: (busy: boolean) => void = () => {};

  constructor() {
    this.start();
  }

  /** Whether an answer is awaited. */
  get isBusy(): boolean {
    return this.pending.size > 0;
  }

  /** Asks the worker; calls are answered in their order. */
  async call<Name extends CallName>(name: Name, ...args: Parameters<Calls[Name]>): Promise<ReturnType<Calls[Name]>> {
    await this.ready;
    const id = this.next++;
    const worker = this.worker;
    if (!worker) {
      throw new KernelError({ message: "found no worker, expected one", line: null, jsonPath: null, isFatal: true });
    }
    return new Promise((resolve, reject) => {
      this.pending.set(id, { resolve: resolve as (result: unknown) => void, reject });
      if (this.pending.size === 1) {
        this.onBusy(true);
      }
      worker.postMessage({ id, call: name, args });
    });
  }

  /** Ends the worker, whatever it does, and starts another. */
  restart(reason: string) {
    this.worker?.terminate();
    const lost = [...this.pending.values()];
    this.pending.clear();
    this.start();
    lost.forEach(({ reject }) => reject(new KernelError({ message: reason, line: null, jsonPath: null, isFatal: true })));
    this.onBusy(false);
    this.onRestart(reason);
  }

  private start() {
    const worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module", name: "planecut kernel" });
    this.worker = worker;
    this.ready = new Promise((resolve, reject) => {
      worker.addEventListener("message", ({ data }: MessageEvent<Response>) => {
        if (worker !== this.worker) {
          return;
        }
        if ("ready" in data) {
          resolve();
        } else if (!("id" in data)) {
          reject(new KernelError(data.fault));
        } else {
          this.answer(data);
        }
      });
      worker.addEventListener("error", (event) => {
        event.preventDefault();
        const message = event.message || "the kernel could not be loaded";
        reject(new KernelError({ message, line: null, jsonPath: null, isFatal: true }));
        if (worker === this.worker && this.pending.size > 0) {
          this.restart(message);
        }
      });
    });
    // whoever calls is told
    this.ready.catch(() => {});
  }

  private answer(response: Response & { id: number }) {
    const pending = this.pending.get(response.id);
    this.pending.delete(response.id);
    if (this.pending.size === 0) {
      this.onBusy(false);
    }
    if ("result" in response) {
      pending?.resolve(response.result);
      return;
    }
    const error = new KernelError((response as { fault: Fault }).fault);
    pending?.reject(error);
    if (error.isFatal) {
      this.restart(error.message);
    }
  }
}

/** Ranges within a buffer that grows: taken first fit, joined where they are given back. */

export interface Slot {
  start: number;
  count: number;
}

/** Gives out ranges of a buffer of some capacity. */
export class Slots {
  /** Free ranges, ascending, none of which ends where another starts. */
  private free: Slot[] = [];
  /** What lies behind the last range that was ever given out. */
  private end = 0;

  constructor(private capacity: number) {}

  /** Where the last range ends. */
  get used(): number {
    return this.end;
  }

  /** A range; nothing where the buffer has to grow first. */
  take(count: number): Slot | null {
    if (count === 0) {
      return { start: 0, count: 0 };
    }
    const k = this.free.findIndex((slot) => slot.count >= count);
    if (k >= 0) {
      const slot = this.free[k]!;
      const start = slot.start;
      slot.start += count;
      slot.count -= count;
      if (slot.count === 0) {
        this.free.splice(k, 1);
      }
      return { start, count };
    }
    if (this.end + count > this.capacity) {
      return null;
    }
    const start = this.end;
    this.end += count;
    return { start, count };
  }

  /** The capacity is larger now. */
  grow(capacity: number) {
    this.capacity = capacity;
  }

  give({ start, count }: Slot) {
    if (count === 0) {
      return;
    }
    let low = 0;
    let high = this.free.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.free[middle]!.start < start) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    const slot = { start, count };
    const [before, after] = [this.free[low - 1], this.free[low]];
    if (after && start + count === after.start) {
      slot.count += after.count;
      this.free.splice(low, 1);
    }
    if (before && before.start + before.count === start) {
      before.count += slot.count;
    } else {
      this.free.splice(low, 0, slot);
    }
    const last = this.free.at(-1);
    if (last && last.start + last.count === this.end) {
      this.end = last.start;
      this.free.pop();
    }
  }
}

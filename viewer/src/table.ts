// CSV tables of numbers written by plica: no quotes, empty fields are missing values.

export class Table {
  readonly columns: string[];
  readonly rows: (number | null)[][];

  constructor(csv: string) {
    const lines = csv.split("\n").filter((line) => line !== "");
    this.columns = lines.length > 0 ? lines[0].split(",") : [];
    this.rows = lines.slice(1).map((line) => line.split(",").map((field) => (field === "" ? null : Number(field))));
  }

  has(column: string): boolean {
    return this.columns.includes(column);
  }

  column(name: string): (number | null)[] {
    const place = this.columns.indexOf(name);
    return place < 0 ? [] : this.rows.map((row) => row[place]);
  }

  /** Number of the row nearest in time; -1 in an empty table. */
  rowNear(time: number): number {
    let best = -1;
    this.rows.forEach((row, i) => {
      if (best < 0 || Math.abs(row[0]! - time) < Math.abs(this.rows[best][0]! - time)) best = i;
    });
    return best;
  }
}

/** Parse rows of texts, quoted where necessary. */
export function csvRows(csv: string): string[][] {
  const rows: string[][] = [];
  for (const [, before, quoted, plain] of `\n${csv.replace(/\n$/, "")}`.matchAll(/([,\n])(?:"((?:[^"]|"")*)"|([^,\n]*))/g)) {
    if (before === "\n") rows.push([]);
    rows.at(-1)!.push(quoted?.replaceAll('""', '"') ?? plain);
  }
  return rows;
}

/** Quote a text for CSV. */
export function csvText(text: string): string {
  return /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

// Locks as a table that the graphics card reads: points with rotation-minimising frames, and what lies beyond the ends.
// The same as in src/ringlet/groom/hairs.cpp and geometry/frames.cpp, which say why.

export interface LockTable {
  rows: number;
  point: Float32Array; // four numbers a row
  a: Float32Array;
  b: Float32Array;
  places: Float32Array; // of each lock: its first row, the number of its last point, 0, 0
}

/** Rows: of each lock one before its root, its points, and two beyond its tip. */
export function lockTable(points: Float32Array, offsets: Int32Array, axis: Float32Array): LockTable {
  const locks = offsets.length - 1;
  const rows = points.length / 3 + 3 * locks;
  const table = {
    rows,
    point: new Float32Array(4 * rows),
    a: new Float32Array(4 * rows),
    b: new Float32Array(4 * rows),
    places: new Float32Array(4 * locks),
  };
  for (let lock = 0; lock < locks; lock++) fill(table, points, offsets[lock], offsets[lock + 1], lock, axis);
  return table;
}

function fill(table: LockTable, points: Float32Array, from: number, to: number, lock: number, axis: Float32Array) {
  const n = to - from;
  const first = from + 3 * lock;
  table.places.set([first + 1, n - 1, 0, 0], 4 * lock);
  const { point, a, b } = table;

  // Tangents: the mean of the two directions that meet.
  const tangent = new Float64Array(3 * n);
  const before = [0, 0, 0];
  for (let i = 0; i < n; i++) {
    const at = 3 * (from + i);
    const after = [0, 0, 0];
    if (i + 1 < n) {
      for (let c = 0; c < 3; c++) after[c] = points[at + 3 + c] - points[at + c];
      normalise(after);
    }
    const sum = [before[0] + after[0], before[1] + after[1], before[2] + after[2]];
    if (dot(sum, sum) > 1e-20) normalise(sum);
    else if (i > 0) for (let c = 0; c < 3; c++) sum[c] = tangent[3 * (i - 1) + c];
    else sum[1] = 1;
    tangent.set(sum, 3 * i);
    if (dot(after, after) > 0.5) for (let c = 0; c < 3; c++) before[c] = after[c];
  }

  // The frame: mirrored along each edge and back (double reflection).
  let moved = orthogonal([axis[3 * lock], axis[3 * lock + 1], axis[3 * lock + 2]], row(tangent, 0));
  for (let i = 0; i < n; i++) {
    const t = row(tangent, i);
    const side = [
      t[1] * moved[2] - t[2] * moved[1],
      t[2] * moved[0] - t[0] * moved[2],
      t[0] * moved[1] - t[1] * moved[0],
    ];
    const at = 4 * (first + 1 + i);
    for (let c = 0; c < 3; c++) {
      point[at + c] = points[3 * (from + i) + c];
      a[at + c] = moved[c];
      b[at + c] = side[c];
    }
    if (i + 1 === n) break;
    const edge = [0, 1, 2].map((c) => points[3 * (from + i + 1) + c] - points[3 * (from + i) + c]);
    const next = row(tangent, i + 1);
    const turned = mirror(t, edge);
    moved = orthogonal(
      mirror(mirror(moved, edge), [next[0] - turned[0], next[1] - turned[1], next[2] - turned[2]]),
      next,
    );
  }

  // The curve goes on as a parabola beyond its ends.
  const at = (i: number, c: number) => points[3 * (from + i) + c];
  const [root, tip] = [4 * (first + 1), 4 * (first + n)];
  for (let c = 0; c < 3; c++) {
    const bent = n > 2;
    point[root - 4 + c] = bent ? 3 * at(0, c) - 3 * at(1, c) + at(2, c) : 2 * at(0, c) - at(1, c);
    const beyond = bent ? 3 * at(n - 1, c) - 3 * at(n - 2, c) + at(n - 3, c) : 2 * at(n - 1, c) - at(n - 2, c);
    a[root - 4 + c] = a[root + c];
    b[root - 4 + c] = b[root + c];
    for (const next of [tip + 4, tip + 8]) {
      point[next + c] = beyond;
      a[next + c] = a[tip + c];
      b[next + c] = b[tip + c];
    }
  }
}

const row = (values: Float64Array, i: number) => [values[3 * i], values[3 * i + 1], values[3 * i + 2]];
const dot = (u: number[], v: number[]) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];

function normalise(v: number[]): number[] {
  const length = Math.sqrt(dot(v, v));
  if (length > 0) for (let c = 0; c < 3; c++) v[c] /= length;
  return v;
}

function mirror(v: number[], across: number[]): number[] {
  const square = dot(across, across);
  if (square < 1e-30) return v;
  const k = (2 * dot(v, across)) / square;
  return [v[0] - k * across[0], v[1] - k * across[1], v[2] - k * across[2]];
}

function orthogonal(v: number[], t: number[]): number[] {
  const k = dot(v, t);
  const left = [v[0] - k * t[0], v[1] - k * t[1], v[2] - k * t[2]];
  if (dot(left, left) > 1e-12) return normalise(left);
  const other = Math.abs(t[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
  const m = dot(other, t);
  return normalise([other[0] - m * t[0], other[1] - m * t[1], other[2] - m * t[2]]);
}

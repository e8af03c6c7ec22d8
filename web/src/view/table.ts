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
  const tangents = new Float64Array(points.length);
  for (let lock = 0; lock < locks; lock++) fill(table, points, offsets[lock], offsets[lock + 1], lock, axis, tangents);
  return table;
}

type Vector = Float64Array;

// Vectors that are used again and again: this runs for every point while a hand moves, and new ones would be garbage.
const [before, after, sum, t, next, moved, edge, turned] = Array.from({ length: 8 }, () => new Float64Array(3));

function fill(
  table: LockTable,
  points: Float32Array,
  from: number,
  to: number,
  lock: number,
  axis: Float32Array,
  tangents: Float64Array,
) {
  const n = to - from;
  const first = from + 3 * lock;
  table.places[4 * lock] = first + 1;
  table.places[4 * lock + 1] = n - 1;
  const { point, a, b } = table;

  // Tangents: the mean of the two directions that meet.
  before.fill(0);
  for (let i = 0; i < n; i++) {
    after.fill(0);
    if (i + 1 < n) {
      between(after, points, from + i);
      normalise(after);
    }
    for (let c = 0; c < 3; c++) sum[c] = before[c] + after[c];
    if (dot(sum, sum) > 1e-20) normalise(sum);
    else if (i > 0) read(sum, tangents, i - 1);
    else sum[1] = 1;
    for (let c = 0; c < 3; c++) tangents[3 * i + c] = sum[c];
    if (dot(after, after) > 0.5) before.set(after);
  }

  // The frame: mirrored along each edge and back (double reflection).
  read(moved, axis, lock);
  read(t, tangents, 0);
  orthogonal(moved, t);
  for (let i = 0; i < n; i++) {
    read(t, tangents, i);
    const at = 4 * (first + 1 + i);
    for (let c = 0; c < 3; c++) {
      const d = (c + 1) % 3;
      const e = (c + 2) % 3;
      point[at + c] = points[3 * (from + i) + c];
      a[at + c] = moved[c];
      b[at + c] = t[d] * moved[e] - t[e] * moved[d];
    }
    if (i + 1 === n) break;
    between(edge, points, from + i);
    read(next, tangents, i + 1);
    turned.set(t);
    mirror(turned, edge);
    for (let c = 0; c < 3; c++) turned[c] = next[c] - turned[c];
    mirror(moved, edge);
    mirror(moved, turned);
    orthogonal(moved, next);
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

/** The vector of a row. */
function read(v: Vector, values: Float32Array | Float64Array, row: number): void {
  for (let c = 0; c < 3; c++) v[c] = values[3 * row + c];
}

/** From a point to the next. */
function between(v: Vector, points: Float32Array, i: number): void {
  for (let c = 0; c < 3; c++) v[c] = points[3 * (i + 1) + c] - points[3 * i + c];
}

function dot(u: Vector, v: Vector): number {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

function normalise(v: Vector): void {
  const length = Math.sqrt(dot(v, v));
  if (length > 0) for (let c = 0; c < 3; c++) v[c] /= length;
}

function mirror(v: Vector, across: Vector): void {
  const square = dot(across, across);
  if (square < 1e-30) return;
  const k = (2 * dot(v, across)) / square;
  for (let c = 0; c < 3; c++) v[c] -= k * across[c];
}

/** Takes the part along the unit vector away; of a vector along it nothing is left, and another takes its place. */
function orthogonal(v: Vector, along: Vector): void {
  const k = dot(v, along);
  for (let c = 0; c < 3; c++) v[c] -= k * along[c];
  if (dot(v, v) > 1e-12) {
    normalise(v);
    return;
  }
  v.fill(0);
  v[Math.abs(along[0]) < 0.9 ? 0 : 1] = 1;
  const m = dot(v, along);
  for (let c = 0; c < 3; c++) v[c] -= m * along[c];
  normalise(v);
}

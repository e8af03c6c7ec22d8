// Locks as a table that the graphics card reads: points with rotation-minimising frames, and what lies beyond the ends.
// The same as in src/ringlet/groom/hairs.cpp and geometry/frames.cpp, which say why.

export interface LockTable {
  rows: number;
  point: Float32Array; // four numbers a row
  a: Float32Array;
  b: Float32Array;
  places: Float32Array; // of each lock: its first row, the number of its last point, how it is marked, the first vertex of its rod
  /** Whether there are frames of centre lines. */
  curled: boolean;
  u: Float32Array; // frame of the centre line of each lock's coil; the fourth number is the lock's place in it
  v: Float32Array;
}

/** Rows: of each lock one before its root, its points, and two beyond its tip. `window`: points of a turn of each lock's coil;
 * empty without a curl of hairs. */
export function lockTable(points: Float32Array, offsets: Int32Array, axis: Float32Array, window: Int32Array): LockTable {
  const locks = offsets.length - 1;
  const curled = window.length === locks;
  const rows = points.length / 3 + 3 * locks;
  const table = {
    rows,
    curled,
    point: new Float32Array(4 * rows),
    a: new Float32Array(4 * rows),
    b: new Float32Array(4 * rows),
    places: new Float32Array(4 * locks),
    u: new Float32Array(curled ? 4 * rows : 4),
    v: new Float32Array(curled ? 4 * rows : 4),
  };
  const tangents = new Float64Array(points.length);
  const centre = new Float64Array(curled ? points.length : 0);
  for (let lock = 0; lock < locks; lock++) {
    const [from, to] = [offsets[lock], offsets[lock + 1]];
    fill(table, points, from, to, lock, axis, tangents);
    if (!curled) continue;
    centreLine(points, from, to, window[lock], centre);
    fillCentre(table, points, centre, from, to, lock, axis, tangents);
  }
  return table;
}

/** Mean square radius of each lock's coil [m²]; none without the frames of centre lines. */
export function squaredRadii({ places, u, v, curled }: LockTable): Float64Array {
  return Float64Array.from({ length: curled ? places.length / 4 : 0 }, (_, lock) => {
    const [first, last] = [places[4 * lock], places[4 * lock] + places[4 * lock + 1]];
    let sum = 0;
    for (let row = first; row <= last; row++) sum += u[4 * row + 3] ** 2 + v[4 * row + 3] ** 2;
    return sum / (last - first + 1);
  });
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

  frames(points, from, n, lock, axis, tangents, a, b, first + 1);
  for (let i = 0; i < n; i++) for (let c = 0; c < 3; c++) point[4 * (first + 1 + i) + c] = points[3 * (from + i) + c];

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

/** Rotation-minimising frames of a polyline into the rows of a table from `row` on. */
export function frames(
  points: Float32Array | Float64Array,
  from: number,
  n: number,
  lock: number,
  axis: Float32Array,
  tangents: Float64Array,
  a: Float32Array,
  b: Float32Array,
  row: number,
) {
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
    const at = 4 * (row + i);
    for (let c = 0; c < 3; c++) {
      const d = (c + 1) % 3;
      const e = (c + 2) % 3;
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
}

/** The frame of the centre line of a lock's coil, and the lock's place in it. */
function fillCentre(
  { u, v }: LockTable,
  points: Float32Array,
  centre: Float64Array,
  from: number,
  to: number,
  lock: number,
  axis: Float32Array,
  tangents: Float64Array,
) {
  const n = to - from;
  const row = from + 3 * lock + 1;
  frames(centre, from, n, lock, axis, tangents, u, v, row);
  for (let i = 0; i < n; i++) {
    const at = 4 * (row + i);
    for (let c = 0; c < 3; c++) {
      const across = points[3 * (from + i) + c] - centre[3 * (from + i) + c];
      u[at + 3] += across * u[at + c];
      v[at + 3] += across * v[at + c];
    }
  }
  for (const values of [u, v])
    for (const [to, at] of [[row - 1, row], [row + n, row + n - 1], [row + n + 1, row + n - 1]])
      for (let c = 0; c < 4; c++) values[4 * to + c] = values[4 * at + c];
}

/** Mean of a lock over a turn, twice: src/ringlet/geometry/centre_line.cpp. */
function centreLine(points: Float32Array, from: number, to: number, window: number, result: Float64Array) {
  const n = to - from;
  const half = Math.min(Math.floor((window + 1) / 2), Math.floor(n / 3));
  const lock = Float64Array.from(points.subarray(3 * from, 3 * to));
  const means = (values: Float64Array): Float64Array => (window < 2 || half < 1 ? values : smoothed(values, n, half));
  result.set(means(means(lock)), 3 * from);
}

function smoothed(points: Float64Array, n: number, half: number): Float64Array {
  const result = new Float64Array(3 * n);
  const sum = new Float64Array(n + 1);
  const [first, last] = [half, n - 1 - half];
  const over = Math.min(half, last - first);
  for (let c = 0; c < 3; c++) {
    const at = (i: number) => result[3 * i + c];
    for (let i = 0; i < n; i++) sum[i + 1] = sum[i] + points[3 * i + c] - points[c];
    for (let i = first; i <= last; i++) {
      const total = sum[i + half] - sum[i - half] + sum[i + half + 1] - sum[i - half + 1];
      result[3 * i + c] = points[c] + total / (4 * half);
    }
    const start = (at(first + over) - at(first)) / over;
    const end = (at(last) - at(last - over)) / over;
    for (let i = 0; i < first; i++) result[3 * i + c] = at(first) - (first - i) * start;
    for (let i = last + 1; i < n; i++) result[3 * i + c] = at(last) + (i - last) * end;
  }
  return result;
}

/** The vector of a row. */
function read(v: Vector, values: Float32Array | Float64Array, row: number): void {
  for (let c = 0; c < 3; c++) v[c] = values[3 * row + c];
}

/** From a point to the next. */
function between(v: Vector, points: Float32Array | Float64Array, i: number): void {
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

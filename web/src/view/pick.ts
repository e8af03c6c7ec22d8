// Which lock is under the pointer, and where points of locks are on the screen.

import { type PerspectiveCamera, Vector3 } from "three";

export interface Picked {
  lock: number; // its place in the list
  point: number; // from its root
}

/** The curve nearest to a place on the screen [pixels], of those within reach that count the one in front. */
export function pick(
  points: Float32Array,
  offsets: Int32Array,
  camera: PerspectiveCamera,
  size: { width: number; height: number },
  at: { x: number; y: number },
  reach = 9,
  counts: (x: number, y: number, z: number) => boolean = () => true,
): Picked | null {
  const m = camera.projectionMatrix.clone().multiply(camera.matrixWorldInverse).elements;
  let best: Picked | null = null;
  let nearest = Number.POSITIVE_INFINITY;
  for (let lock = 0; lock + 1 < offsets.length; lock++) {
    for (let i = offsets[lock]; i < offsets[lock + 1]; i++) {
      const [x, y, z] = [points[3 * i], points[3 * i + 1], points[3 * i + 2]];
      const w = m[3] * x + m[7] * y + m[11] * z + m[15];
      if (w <= 0) continue;
      const dx = (0.5 + (0.5 * (m[0] * x + m[4] * y + m[8] * z + m[12])) / w) * size.width - at.x;
      const dy = (0.5 - (0.5 * (m[1] * x + m[5] * y + m[9] * z + m[13])) / w) * size.height - at.y;
      const distance = Math.hypot(dx, dy);
      if (distance > reach || !counts(x, y, z)) continue;
      const cost = w + 0.004 * distance; // metres in front count as much as a few pixels beside
      if (cost < nearest) {
        nearest = cost;
        best = { lock, point: i - offsets[lock] };
      }
    }
  }
  return best;
}

export function onScreen(point: Vector3, camera: PerspectiveCamera, size: { width: number; height: number }) {
  const seen = point.clone().project(camera);
  return { x: (0.5 + 0.5 * seen.x) * size.width, y: (0.5 - 0.5 * seen.y) * size.height };
}

/** How many pixels a metre has at a place. */
export function pixelsPerMetre(place: Vector3, camera: PerspectiveCamera, height: number): number {
  const away = place.clone().sub(camera.position).dot(camera.getWorldDirection(new Vector3()));
  return height / (2 * Math.tan((0.5 * camera.fov * Math.PI) / 180) * Math.max(away, 1e-6));
}

/** Where a place on the screen is in the plane through `through` that faces the camera. */
export function inPlane(
  at: { x: number; y: number },
  through: Vector3,
  camera: PerspectiveCamera,
  size: { width: number; height: number },
): Vector3 {
  const eye = camera.position;
  const way = new Vector3((2 * at.x) / size.width - 1, 1 - (2 * at.y) / size.height, 0.5).unproject(camera).sub(eye);
  const forward = camera.getWorldDirection(new Vector3());
  const depth = through.clone().sub(eye).dot(forward);
  return eye.clone().addScaledVector(way, depth / way.dot(forward));
}

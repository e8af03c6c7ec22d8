// Framing as in python/ringlet/picture/camera.py: the nearest camera of a direction that sees every point of the subject.

import { Vector3 } from "three";

export const FOCAL_LENGTH = 85; // of a portrait lens, before a sensor whose height is 36 mm [mm]
export const SENSOR = 36;
const LENS = (0.5 * SENSOR) / FOCAL_LENGTH;
const MARGIN = 0.06; // fraction of the width and height that stays free at each edge
const HEADROOM = 0.4; // fraction of the free height above the subject

/** Vertical field of view of a lens [degrees]. focalLength: before the same sensor [mm] */
export function fieldOfView(focalLength: number): number {
  return (2 * Math.atan((0.5 * SENSOR) / focalLength) * 180) / Math.PI;
}

/** What a camera of a direction looks at, and from how far [m]. */
export interface Portrait {
  target: Vector3;
  distance: number;
}

/** backward: unit vector from the subject to the camera; points: of the subject, three numbers each; aspect: at most 1. */
export function portrait(points: Iterable<Float32Array>, backward: Vector3, aspect = 1): Portrait {
  const right = new Vector3(backward.z, 0, -backward.x).normalize();
  const up = backward.clone().cross(right);
  const slopeX = LENS * Math.min(aspect, 1) * (1 - 2 * MARGIN);
  const slopeY = LENS * (1 - 2 * MARGIN);
  let [reachRight, reachUp, reachLeft, reachDown] = [-Infinity, -Infinity, -Infinity, -Infinity];
  let [nearest, deepest] = [-Infinity, -Infinity];
  for (const some of points)
    for (let i = 0; i < some.length; i += 3) {
      const x = right.x * some[i] + right.z * some[i + 2];
      const y = up.x * some[i] + up.y * some[i + 1] + up.z * some[i + 2];
      const z = backward.x * some[i] + backward.y * some[i + 1] + backward.z * some[i + 2];
      reachRight = Math.max(reachRight, x + slopeX * z);
      reachLeft = Math.max(reachLeft, -x + slopeX * z);
      reachUp = Math.max(reachUp, y + slopeY * z);
      reachDown = Math.max(reachDown, -y + slopeY * z);
      nearest = Math.max(nearest, z);
      deepest = Math.max(deepest, -z);
    }
  if (nearest === -Infinity) return { target: new Vector3(), distance: 1 };
  const away = Math.max((reachRight + reachLeft) / (2 * slopeX), (reachUp + reachDown) / (2 * slopeY));
  const [lowest, highest] = [reachUp - slopeY * away, slopeY * away - reachDown];
  const [x, y] = [0.5 * (reachRight - reachLeft), lowest + HEADROOM * (highest - lowest)];
  const distance = away - 0.5 * (nearest - deepest);
  const target = right
    .clone()
    .multiplyScalar(x)
    .addScaledVector(up, y)
    .addScaledVector(backward, away - distance);
  return { target, distance };
}

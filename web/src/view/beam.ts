// The light of a lamp that hair and bodies let pass. The lamp is a disk nearby: its light comes from three points of it,
// each of which throws its own shadow.

import { Vector3 } from "three";
import type { Matter } from "./grid";

const LAMP_POINTS = 3; // of a lamp's disk, from which shadows are cast
const DARKEST = 1e-6; // least part of a lamp's light: keeps optical depths finite

/** A lamp: a disk at a place, direction from the subject towards it, its radius, and the irradiance at its reach [m]. */
export interface Beam {
  from: Vector3;
  place: Vector3;
  reach: number;
  radius: number;
  strength: Vector3;
}

/** Points of a lamp's disk that stand for it, at the root mean square of its radii. */
function pointsOf({ from, place, radius }: Beam): Vector3[] {
  const right = new Vector3(-from.z, 0, from.x).normalize();
  const up = new Vector3().crossVectors(right, from);
  return Array.from({ length: LAMP_POINTS }, (_, k) => {
    const angle = (2 * Math.PI * k) / LAMP_POINTS;
    const [x, y] = [Math.cos(angle), Math.sin(angle)].map((value) => value * Math.SQRT1_2 * radius);
    return place.clone().addScaledVector(right, x).addScaledVector(up, y);
  });
}

/** Optical depth of hair and passage of skin towards a lamp, by the mean of what passes from its points. */
export function* cast(matter: Matter, beam: Beam, depth: Float32Array, passed: Float32Array): Generator<void, void> {
  depth.fill(0);
  passed.fill(0);
  if (beam.strength.lengthSq() === 0) return;
  for (const point of pointsOf(beam)) {
    sweep(matter, point, depth, passed);
    yield;
  }
  for (let i = 0; i < depth.length; i++) {
    depth[i] = depth[i] >= LAMP_POINTS ? 0 : -Math.log(Math.max(depth[i] / LAMP_POINTS, DARKEST));
    passed[i] /= LAMP_POINTS;
  }
}

/** Adds what hair and what skin let pass from a point of light, slice by slice away from it, interpolated in each. */
function sweep({ grid, hair, skin }: Matter, light: Vector3, throughHair: Float32Array, throughSkin: Float32Array): void {
  const { counts, size, origin } = grid;
  const at = light.clone().sub(origin).divideScalar(size).subScalar(0.5).toArray(); // in voxels, from the middle of the first
  const away = at.map((place, axis) => Math.abs(place - 0.5 * (counts[axis] - 1)));
  const main = away.indexOf(Math.max(...away));
  const [u, v] = [(main + 1) % 3, (main + 2) % 3];
  const strides = [1, counts[0], counts[0] * counts[1]];
  const [nu, nv, nm] = [counts[u], counts[v], counts[main]];
  const above = at[main] > 0.5 * (nm - 1);
  // What leaves the slice before, with a border of what comes from outside of the grid.
  const wide = nu + 2;
  let [depths, passages] = [new Float32Array(wide * (nv + 2)), new Float32Array(wide * (nv + 2)).fill(1)];
  let [nextDepths, nextPassages] = [depths.slice(), passages.slice()];
  for (let m = 0; m < nm; m++) {
    const slice = above ? nm - 1 - m : m;
    const nearer = 1 / Math.max(Math.abs(at[main] - slice), 1); // part of the way to the light from slice to slice
    for (let b = 0; b < nv; b++) {
      const dv = (at[v] - b) * nearer;
      const y = Math.min(Math.max(b + dv, -1), nv - 1e-3);
      const iv = Math.floor(y);
      const fv = y - iv;
      const row = 1 + (iv + 1) * wide;
      let here = slice * strides[main] + b * strides[v];
      let to = 1 + (b + 1) * wide;
      for (let a = 0; a < nu; a++, here += strides[u], to++) {
        const du = (at[u] - a) * nearer;
        const x = Math.min(Math.max(a + du, -1), nu - 1e-3);
        const iu = Math.floor(x);
        const fu = x - iu;
        const there = row + iu;
        const d0 = depths[there] + fu * (depths[there + 1] - depths[there]);
        const d1 = depths[there + wide] + fu * (depths[there + wide + 1] - depths[there + wide]);
        const p0 = passages[there] + fu * (passages[there + 1] - passages[there]);
        const p1 = passages[there + wide] + fu * (passages[there + wide + 1] - passages[there + wide]);
        let d = d0 + fv * (d1 - d0);
        let p = p0 + fv * (p1 - p0);
        if (hair[here] > 0 || skin[here] > 0) {
          const half = 0.5 * Math.sqrt(1 + du * du + dv * dv);
          const within = half * size * hair[here];
          const shell = skin[here] > 0 ? Math.exp(-half * skin[here]) : 1;
          p *= shell;
          d += within;
          nextDepths[to] = d + within;
          nextPassages[to] = p * shell;
        } else {
          nextDepths[to] = d;
          nextPassages[to] = p;
        }
        throughHair[here] += d > 0 ? Math.exp(-d) : 1;
        throughSkin[here] += p;
      }
    }
    [depths, nextDepths] = [nextDepths, depths];
    [passages, nextPassages] = [nextPassages, passages];
  }
}

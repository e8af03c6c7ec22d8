import { expect, test } from "vitest";
import { Box3, Vector3 } from "three";
import { around, type Surface } from "../src/view/grid";

const HAIR = new Box3(new Vector3(-0.1, 0.2, -0.1), new Vector3(0.1, 0.4, 0.05));

function surface(...points: number[]): Surface {
  const none = new Float32Array();
  return { points: new Float32Array(points), normals: none, colors: none, triangles: new Uint32Array() };
}

test("the grid of light covers a nose before the hair, but no wide shoulder", () => {
  const box = around(HAIR, [surface(0, 0.25, 0.1, 0.3, 0.18, 0)]);
  expect(box.max.z).toBeCloseTo(0.1);
  expect(box.max.x).toBeCloseTo(0.1);
  expect(box.min.y).toBeCloseTo(0.13);
  expect(around(HAIR, []).max.z).toBeCloseTo(0.05);
});

// Which place on a body is under the pointer. A tree of boxes makes that fast on any mesh.

import { Mesh, MeshBasicMaterial, type BufferGeometry, type PerspectiveCamera, Raycaster, Vector2, type Vector3 } from "three";
import { MeshBVH, acceleratedRaycast } from "three-mesh-bvh";

const trees = new WeakMap<object, Mesh>(); // by the array of positions: a body that has moved gets another

/** The mesh of a geometry with its tree. */
function withTree(geometry: BufferGeometry): Mesh {
  const positions = geometry.getAttribute("position").array;
  let mesh = trees.get(positions);
  if (!mesh) {
    const copy = geometry.clone(); // the tree sorts the triangles
    copy.boundsTree = new MeshBVH(copy);
    mesh = new Mesh(copy, new MeshBasicMaterial({ side: 2 }));
    mesh.raycast = acceleratedRaycast;
    trees.set(positions, mesh);
  }
  return mesh;
}

/** The nearest place on some geometries under a pointer; null for none. */
export function onSurface(
  geometries: BufferGeometry[],
  camera: PerspectiveCamera,
  size: { width: number; height: number },
  at: { x: number; y: number },
): Vector3 | null {
  const ray = new Raycaster();
  ray.firstHitOnly = true;
  camera.updateMatrixWorld();
  ray.setFromCamera(new Vector2((2 * at.x) / size.width - 1, 1 - (2 * at.y) / size.height), camera);
  const hits = geometries.flatMap((geometry) => ray.intersectObject(withTree(geometry)));
  return hits.sort((a, b) => a.distance - b.distance)[0]?.point ?? null;
}

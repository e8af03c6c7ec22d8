// What the key light sees: the nearest body, the nearest hair, and how much hair lies in four layers behind it.

import {
  type Box3,
  DepthTexture,
  FloatType,
  HalfFloatType,
  LinearFilter,
  Matrix4,
  NearestFilter,
  OrthographicCamera,
  RGBAFormat,
  type Scene,
  Vector3,
  Vector4,
  type WebGLRenderer,
  WebGLRenderTarget,
} from "three";

// Ends of the layers behind the first hair, as parts of the depth of all hair.
const LAYERS = [0.012, 0.035, 0.09, 0.25] as const;

/** What casts shadows; each fills one of the maps. */
export interface Casters {
  bodies: Scene;
  hairDepth: Scene;
  hairLayers: Scene;
}

export class Shadow {
  readonly camera = new OrthographicCamera();
  readonly uniforms;
  /** Size of a texel in the scene [m]. */
  texel = 0.001;
  private readonly body;
  private readonly near;
  private readonly deep;

  constructor(private readonly size: number) {
    this.body = depthTarget(size);
    this.near = depthTarget(size);
    this.deep = new WebGLRenderTarget(size, size, {
      type: HalfFloatType,
      format: RGBAFormat,
      minFilter: LinearFilter,
      magFilter: LinearFilter,
      depthBuffer: false,
    });
    this.uniforms = {
      hairNearest: { value: this.near.depthTexture },
      hairLayers: { value: this.deep.texture },
      bodyNearest: { value: this.body.depthTexture },
      toLight: { value: new Matrix4() },
      layers: { value: new Vector4(...LAYERS) },
      shadowOn: { value: 1 },
    };
  }

  /** Draws the maps, seen from the direction `from`, over all of `box`. */
  update(renderer: WebGLRenderer, from: Vector3, box: Box3, casters: Casters): void {
    const centre = box.getCenter(new Vector3());
    const radius = 0.5 * box.getSize(new Vector3()).length();
    this.camera.position.copy(centre).addScaledVector(from, 2 * radius);
    this.camera.up.set(0, Math.abs(from.y) > 0.98 ? 0 : 1, Math.abs(from.y) > 0.98 ? 1 : 0);
    this.camera.lookAt(centre);
    Object.assign(this.camera, {
      left: -radius,
      right: radius,
      top: radius,
      bottom: -radius,
      near: radius,
      far: 3 * radius,
    });
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    this.texel = (2 * radius) / this.size;
    this.uniforms.toLight.value.multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse);
    const before = renderer.getRenderTarget();
    for (const [target, scene] of [
      [this.body, casters.bodies],
      [this.near, casters.hairDepth],
      [this.deep, casters.hairLayers],
    ] as const) {
      renderer.setRenderTarget(target);
      renderer.setClearColor(0x000000, 0);
      renderer.clear();
      renderer.render(scene, this.camera);
    }
    renderer.setRenderTarget(before);
  }

  dispose(): void {
    for (const target of [this.body, this.near, this.deep]) target.dispose();
  }
}

function depthTarget(size: number) {
  const depthTexture = new DepthTexture(size, size, FloatType);
  depthTexture.minFilter = depthTexture.magFilter = NearestFilter;
  return new WebGLRenderTarget(size, size, { depthTexture, depthBuffer: true }) as WebGLRenderTarget & {
    depthTexture: DepthTexture;
  };
}

// The difference of two pictures: orange where the first is brighter, blue where the second is, over a dim first.

import { GLSL3, LinearFilter, Mesh, PlaneGeometry, RawShaderMaterial, Scene, type WebGLRenderer, WebGLRenderTarget } from "three";

const VERTEX = /* glsl */ `
in vec3 position;
out vec2 at;
void main() { at = 0.5 + 0.5 * position.xy; gl_Position = vec4(position.xy, 0.0, 1.0); }
`;
const FRAGMENT = /* glsl */ `
precision highp float;
uniform sampler2D first, second;
in vec2 at;
out vec4 color;
void main() {
  vec3 a = texture(first, at).rgb, b = texture(second, at).rgb;
  const vec3 weights = vec3(0.2126, 0.7152, 0.0722);
  float brighter = dot(a - b, weights);
  vec3 apart = abs(a - b);
  float size = smoothstep(0.02, 0.25, max(apart.r, max(apart.g, apart.b)));
  vec3 tint = brighter > 0.0 ? vec3(0.98, 0.62, 0.24) : vec3(0.36, 0.66, 0.98);
  color = vec4(mix(vec3(0.3 * dot(a, weights) + 0.04), tint, size), 1.0);
}
`;

export class Difference {
  private readonly targets: WebGLRenderTarget[];
  private readonly scene = new Scene();
  private readonly material = new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    depthTest: false,
    depthWrite: false,
    uniforms: { first: { value: null }, second: { value: null } },
  });

  constructor(samples: number) {
    const options = { samples, minFilter: LinearFilter, magFilter: LinearFilter };
    this.targets = [0, 1].map(() => new WebGLRenderTarget(1, 1, options));
    const quad = new Mesh(new PlaneGeometry(2, 2), this.material);
    quad.frustumCulled = false;
    this.scene.add(quad);
  }

  /** Where the first or the second picture is drawn, of the size of the canvas. */
  target(k: number, renderer: WebGLRenderer): WebGLRenderTarget {
    const { width, height } = renderer.domElement;
    if (this.targets[k].width !== width || this.targets[k].height !== height) this.targets[k].setSize(width, height);
    return this.targets[k];
  }

  draw(renderer: WebGLRenderer, camera: Parameters<WebGLRenderer["render"]>[1]): void {
    this.material.uniforms["first"].value = this.targets[0].texture;
    this.material.uniforms["second"].value = this.targets[1].texture;
    renderer.render(this.scene, camera);
  }

  dispose(): void {
    for (const target of this.targets) target.dispose();
    this.material.dispose();
  }
}

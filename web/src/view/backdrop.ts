// A seamless wall with a pool of light behind the subject.

import { Color, GLSL3, Mesh, PlaneGeometry, RawShaderMaterial, Scene } from "three";

const VERTEX = /* glsl */ `
in vec3 position;
out vec2 at;
void main() { at = position.xy; gl_Position = vec4(position.xy, 0.9999, 1.0); }
`;
const FRAGMENT = /* glsl */ `
precision highp float;
uniform vec3 near, far;
uniform float aspect;
in vec2 at;
out vec4 color;
void main() {
  vec2 away = vec2(at.x * aspect, at.y * 0.9 + 0.05);
  float pool = exp(-0.75 * dot(away, away));
  float grain = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453) - 0.5;
  color = vec4(mix(far, near, pool) + grain / 255.0, 1.0);
}
`;

const WALLS = { dark: ["#5a6164", "#1c1f21"], light: ["#cdc8c0", "#a7a198"] } as const;

export class Backdrop {
  readonly scene = new Scene();
  private readonly material = new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    depthWrite: false,
    depthTest: false,
    uniforms: { near: { value: new Color() }, far: { value: new Color() }, aspect: { value: 1 } },
  });

  constructor() {
    const wall = new Mesh(new PlaneGeometry(2, 2), this.material);
    wall.frustumCulled = false;
    this.scene.add(wall);
    this.setTheme("dark");
  }

  setTheme(theme: "dark" | "light"): void {
    const [near, far] = WALLS[theme];
    this.setWall(near, far);
  }

  /** Colors of the wall in its pool of light, and away from it. */
  setWall(near: string, far: string): void {
    // Written as they are seen: no conversion to linear light.
    (this.material.uniforms["near"].value as Color).copy(new Color(near).convertLinearToSRGB());
    (this.material.uniforms["far"].value as Color).copy(new Color(far).convertLinearToSRGB());
  }

  update(aspect: number): void {
    this.material.uniforms["aspect"].value = aspect;
  }

  dispose(): void {
    this.material.dispose();
  }
}

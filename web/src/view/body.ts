// A mesh: skin, eyes, cloth. Lit by the same lights as the hair, and in its shadow.

import {
  BufferAttribute,
  BufferGeometry,
  GLSL3,
  Mesh,
  MeshBasicMaterial,
  RawShaderMaterial,
  type Scene,
  Vector3,
} from "three";
import type { Body as BodyMessage } from "../protocol";
import type { Lights } from "./lights";
import type { Side } from "./looks";
import { DEVELOP, LIGHTS, SHADOW } from "./shaders";
import type { Shadow } from "./shadow";

const VERTEX = /* glsl */ `
precision highp float;
uniform mat4 viewMatrix, projectionMatrix;
in vec3 position, normal, tint;
out vec3 place, upward, albedo;
void main() {
  place = position;
  upward = normal;
  albedo = tint;
  gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
}
`;

const FRAGMENT = /* glsl */ `
precision highp float;
precision highp int;
${LIGHTS}
${SHADOW}
${DEVELOP}
uniform vec3 eye;
uniform float roughness, specular, wrap, sheen;
in vec3 place, upward, albedo;
out vec4 color;

void main() {
  vec3 N = normalize(upward), V = normalize(eye - place);
  if (dot(N, V) < 0.0) N = -N;
  vec3 light = albedo * ambient * (0.62 + 0.38 * N.y) * 0.55;
  for (int k = 0; k < LIGHTS; k++) {
    vec3 L = lightFrom[k], H = normalize(L + V);
    float facing = dot(N, L);
    float seen = k == 0 ? seenThrough(place + 0.002 * N) * seenPast(place + 0.003 * N, 0.0015) : 1.0;
    // Light wanders under skin: red goes farthest round the edge of a shadow.
    vec3 round = clamp((vec3(facing) + wrap * vec3(1.0, 0.45, 0.3)) / (1.0 + wrap * vec3(1.0, 0.45, 0.3)), 0.0, 1.0);
    float a = roughness * roughness, n = clamp(dot(N, H), 0.0, 1.0), d = n * n * (a * a - 1.0) + 1.0;
    float fresnel = 0.04 + 0.96 * pow(1.0 - clamp(dot(V, H), 0.0, 1.0), 5.0);
    float shine = specular * a * a / (3.1416 * d * d) * fresnel * clamp(facing, 0.0, 1.0);
    float edge = sheen * pow(1.0 - clamp(dot(N, V), 0.0, 1.0), 3.0) * clamp(0.5 + 0.5 * facing, 0.0, 1.0);
    light += lightStrength[k] * seen * (albedo * round * 0.318 + shine + edge * albedo);
  }
  color = vec4(develop(light), 1.0);
}
`;

const LOOKS: Record<string, { roughness: number; specular: number; wrap: number; sheen: number }> = {
  skin: { roughness: 0.5, specular: 0.55, wrap: 0.32, sheen: 0.06 },
  eye: { roughness: 0.14, specular: 0.5, wrap: 0.1, sheen: 0 },
  cloth: { roughness: 0.9, specular: 0.2, wrap: 0.1, sheen: 0.25 },
  matte: { roughness: 0.8, specular: 0.2, wrap: 0.05, sheen: 0 },
};

export class Body {
  readonly mesh: Mesh;
  readonly caster: Mesh;
  private readonly material: RawShaderMaterial;
  /** Bodies may be elsewhere in each of the looks that are compared. */
  private readonly geometry = new Map<Side, BufferGeometry>();
  private readonly index: BufferAttribute;
  private readonly tints: BufferAttribute;
  private readonly rest: Float32Array;

  constructor(
    message: BodyMessage,
    lights: Lights,
    shadow: Shadow,
    private readonly scenes: [Scene, Scene],
  ) {
    this.rest = message.points;
    this.index = new BufferAttribute(message.triangles, 1);
    const count = message.points.length / 3;
    const tint = new Float32Array(3 * count);
    for (let i = 0; i < count; i++)
      tint.set(message.colors.length ? message.colors.subarray(3 * i, 3 * i + 3) : message.color, 3 * i);
    this.tints = new BufferAttribute(tint, 3);
    const look = LOOKS[message.made_of] ?? LOOKS["matte"];
    this.material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: 2,
      uniforms: {
        ...lights.uniforms,
        ...shadow.uniforms,
        eye: { value: new Vector3() },
        ...Object.fromEntries(Object.entries(look).map(([name, value]) => [name, { value }])),
      },
    });
    this.mesh = new Mesh(this.at("a"), this.material);
    this.caster = new Mesh(this.at("a"), new MeshBasicMaterial({ side: 2, colorWrite: false }));
    this.mesh.frustumCulled = this.caster.frustumCulled = false;
    scenes[0].add(this.mesh);
    scenes[1].add(this.caster);
  }

  get points(): number {
    return this.rest.length / 3;
  }

  /** Moves it on one side; nothing: to where it rests. */
  place(side: Side, points: Float32Array = this.rest): void {
    const geometry = this.at(side);
    if (geometry.getAttribute("position")?.array === points) return;
    geometry.setAttribute("position", new BufferAttribute(points, 3));
    geometry.computeVertexNormals();
  }

  /** Lets it be seen as it is on one side. */
  turnTo(side: Side): void {
    this.mesh.geometry = this.caster.geometry = this.at(side);
  }

  /** Its geometry on one side, at first where it rests. */
  private at(side: Side): BufferGeometry {
    let geometry = this.geometry.get(side);
    if (!geometry) {
      geometry = new BufferGeometry().setIndex(this.index).setAttribute("tint", this.tints);
      this.geometry.set(side, geometry);
      this.place(side);
    }
    return geometry;
  }

  seenFrom(eye: Vector3): void {
    (this.material.uniforms["eye"].value as Vector3).copy(eye);
  }

  dispose(): void {
    this.scenes[0].remove(this.mesh);
    this.scenes[1].remove(this.caster);
    for (const geometry of this.geometry.values()) geometry.dispose();
    this.material.dispose();
  }
}

// A mesh: skin, eyes, cloth. Lit by the same lights as the hair, and in its shadow.

import {
  BufferAttribute,
  BufferGeometry,
  GLSL3,
  type Matrix4,
  Mesh,
  MeshBasicMaterial,
  RawShaderMaterial,
  type Scene,
  Vector3,
} from "three";
import type { Body as BodyMessage } from "../protocol";
import type { Lights } from "./lights";
import type { Side } from "./looks";
import { LIGHTS } from "./shaders";
import type { Surface } from "./grid";
import { type LightVolume, VOLUME } from "./volume";

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

// The principled material of the path tracer (Burley, "Physically-based shading at Disney", 2012).
const FRAGMENT = /* glsl */ `
precision highp float;
precision highp int;
precision highp sampler3D;
${LIGHTS}
${VOLUME}
uniform vec3 eye;
uniform float roughness, specular, flatness, sheen, sheenTint;
in vec3 place, upward, albedo;
out vec4 color;

float fifth(float x) { float y = clamp(1.0 - x, 0.0, 1.0); return y * y * y * y * y; }

// Cosine to a disk of a radius over distance: at the horizon a part of it is seen.
float facing(float cosine, float radius) {
  if (abs(cosine) >= radius) return max(cosine, 0.0);
  return (cosine + radius) * (cosine + radius) / (4.0 * radius);
}

void main() {
  vec3 N = normalize(upward), V = normalize(eye - place);
  if (dot(N, V) < 0.0) N = -N;
  float voxel = voxelSize(), NV = max(dot(N, V), 1e-3);
  vec4 depth = opticalDepth(place + 0.5 * voxel * N), past = pastBodies(place + voxel * N); // above the shell of folds
  float disorder;
  vec3 light = albedo * scattered(place + 1.5 * voxel * N, N, vec3(-2.0), disorder); // irradiance over π
  vec3 tint = mix(vec3(1.0), albedo / max(dot(albedo, vec3(0.2126, 0.7152, 0.0722)), 1e-4), sheenTint);
  for (int k = 0; k < LAMPS; k++) {
    vec3 L, E = irradiance(k, place, L);
    vec3 H = normalize(L + V);
    float NL = facing(dot(N, L), lampSpread[k]), HL = clamp(dot(H, L), 0.0, 1.0), NH = clamp(dot(N, H), 0.0, 1.0);
    if (NL <= 0.0) continue;
    float grazing = 2.0 * roughness * HL * HL, ss = roughness * HL * HL;
    float diffuse = mix(1.0, 0.5 + grazing, fifth(NL)) * mix(1.0, 0.5 + grazing, fifth(NV));
    float under = mix(1.0, ss, fifth(NL)) * mix(1.0, ss, fifth(NV));
    float flatter = 1.25 * (under * (1.0 / (NL + NV) - 0.5) + 0.5);
    // The highlight of a disk: wider, and as much light (Karis, "Real shading in Unreal Engine 4", 2013).
    float a = roughness * roughness, wide = min(1.0, a + 0.5 * lampSpread[k]);
    float d = NH * NH * (wide * wide - 1.0) + 1.0;
    float D = wide * wide / (3.1415927 * d * d);
    float G = 1.0 / (NL * sqrt(a * a + (1.0 - a * a) * NV * NV) + NV * sqrt(a * a + (1.0 - a * a) * NL * NL) + 1e-4);
    float F = mix(0.08 * specular, 1.0, fifth(HL));
    vec3 f = albedo * 0.3183099 * mix(diffuse, flatter, flatness) + sheen * tint * fifth(HL) + vec3(0.5 * D * G * F);
    light += E * NL * past[k] * exp(-depth[k]) * f;
  }
  color = vec4(light, 1.0);
}
`;

const LOOKS: Record<string, Record<"roughness" | "specular" | "flatness" | "sheen" | "sheenTint", number>> = {
  skin: { roughness: 0.48, specular: 0.4, flatness: 0.5, sheen: 0.1, sheenTint: 0.8 },
  eye: { roughness: 0.06, specular: 0.35, flatness: 0, sheen: 0, sheenTint: 0 },
  cloth: { roughness: 0.9, specular: 0.15, flatness: 0, sheen: 0.5, sheenTint: 0.5 },
  matte: { roughness: 0.8, specular: 0.2, flatness: 0, sheen: 0, sheenTint: 0 },
};

const NECK = { height: 0.045, radius: 0.045, shoulder: 12 }; // it bends over a height, less high beyond its radius [m]

/** How head and trunk have moved: the motion of the one, the shift of the other, and where the neck joins them [m]. */
export interface Pose {
  head: Matrix4;
  trunk: Vector3;
  pivot: Vector3;
}

/** How far skin goes with the head, from its place about the joint of the neck [m]. */
function shareOfHead(x: number, y: number, z: number): number {
  if (y >= 0) return 1;
  const beyond = Math.max(0, Math.hypot(x, z) / NECK.radius - 1);
  const t = Math.max(0, 1 + (y / NECK.height) * (1 + NECK.shoulder * beyond));
  return t * t * (3 - 2 * t);
}

export class Body {
  readonly mesh: Mesh;
  readonly caster: Mesh;
  private readonly material: RawShaderMaterial;
  /** Bodies may be elsewhere in each of the looks that are compared. */
  private readonly geometries = new Map<Side, BufferGeometry>();
  private readonly index: BufferAttribute;
  private readonly tints: BufferAttribute;
  private readonly rest: Float32Array;
  /** Positions and normals that a pose gives it, by side. */
  private readonly posed = new Map<Side, [BufferAttribute, BufferAttribute]>();
  private readonly cloth: boolean;
  private restNormals: Float32Array | null = null;

  constructor(
    message: BodyMessage,
    lights: Lights,
    private readonly volumes: Record<Side, LightVolume>,
    private readonly scenes: [Scene, Scene],
  ) {
    this.rest = message.points;
    this.cloth = message.made_of === "cloth";
    this.solid = message.made_of === "skin" || message.made_of === "cloth";
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
        ...Object.fromEntries(Object.keys(this.volumes.a.uniforms).map((name) => [name, { value: null }])),
        eye: { value: new Vector3() },
        ...Object.fromEntries(Object.entries(look).map(([name, value]) => [name, { value }])),
      },
    });
    this.mesh = new Mesh(this.geometry("a"), this.material);
    this.caster = new Mesh(this.geometry("a"), new MeshBasicMaterial({ side: 2, colorWrite: false }));
    this.mesh.frustumCulled = this.caster.frustumCulled = false;
    scenes[0].add(this.mesh);
    scenes[1].add(this.caster);
  }

  /** Whether it throws shadows into the hair and on other bodies: eyes and lashes are too small to. */
  readonly solid: boolean;

  /** Its triangles as they are on one side: positions and normals [m], three numbers a point; colors; indices. */
  surface(side: Side): Surface {
    const geometry = this.geometry(side);
    const values = (name: string) => geometry.getAttribute(name).array as Float32Array;
    const triangles = geometry.index!.array as Uint32Array;
    return { points: values("position"), normals: values("normal"), colors: values("tint"), triangles };
  }

  get points(): number {
    return this.rest.length / 3;
  }

  /** Moves it on one side; nothing: to where it rests. */
  place(side: Side, points: Float32Array = this.rest): void {
    const geometry = this.geometry(side);
    if (geometry.getAttribute("position")?.array === points) return;
    geometry.setAttribute("position", new BufferAttribute(points, 3));
    geometry.computeVertexNormals();
  }

  /** Moves it on one side from where it rests, by a pose of the head: its neck bends, and cloth goes with the trunk. */
  pose(side: Side, { head, trunk, pivot }: Pose): void {
    const geometry = this.geometry(side);
    const { rest, normals, cloth } = this;
    const [position, normal] = this.posed.get(side) ?? [new BufferAttribute(rest.slice(), 3), new BufferAttribute(normals.slice(), 3)];
    this.posed.set(side, [position, normal]);
    const { elements: m } = head;
    const shift = trunk.toArray();
    for (let i = 0; i < rest.length; i += 3) {
      const share = cloth ? 0 : shareOfHead(rest[i] - pivot.x, rest[i + 1] - pivot.y, rest[i + 2] - pivot.z);
      for (let c = 0; c < 3; c++) {
        const turned = m[c] * rest[i] + m[4 + c] * rest[i + 1] + m[8 + c] * rest[i + 2] + m[12 + c];
        const direction = m[c] * normals[i] + m[4 + c] * normals[i + 1] + m[8 + c] * normals[i + 2];
        position.array[i + c] = rest[i + c] + shift[c] + share * (turned - rest[i + c] - shift[c]);
        normal.array[i + c] = normals[i + c] + share * (direction - normals[i + c]);
      }
    }
    position.needsUpdate = normal.needsUpdate = true;
    geometry.setAttribute("position", position).setAttribute("normal", normal);
  }

  /** Normals at rest, three numbers a point. */
  private get normals(): Float32Array {
    if (!this.restNormals) {
      const geometry = new BufferGeometry().setIndex(this.index).setAttribute("position", new BufferAttribute(this.rest, 3));
      geometry.computeVertexNormals();
      this.restNormals = geometry.getAttribute("normal").array as Float32Array;
    }
    return this.restNormals;
  }

  get triangles(): number {
    return this.index.count / 3;
  }

  /** Draws some of its triangles; nothing: all. */
  restrict(first = 0, count = this.triangles): void {
    this.mesh.geometry.setDrawRange(3 * first, 3 * count);
  }

  /** Lets it be seen as it is on one side. */
  turnTo(side: Side): void {
    this.mesh.geometry = this.caster.geometry = this.geometry(side);
    for (const [name, { value }] of Object.entries(this.volumes[side].uniforms)) this.material.uniforms[name].value = value;
  }

  /** Its geometry on one side, at first where it rests. */
  geometry(side: Side): BufferGeometry {
    let geometry = this.geometries.get(side);
    if (!geometry) {
      geometry = new BufferGeometry().setIndex(this.index).setAttribute("tint", this.tints);
      this.geometries.set(side, geometry);
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
    for (const geometry of this.geometries.values()) geometry.dispose();
    this.material.dispose();
  }
}

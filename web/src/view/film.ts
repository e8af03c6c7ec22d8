// The film: light and coverage of several drawings, averaged, then developed over the backdrop as in
// python/ringlet/picture (tone.py, studio.py).

import {
  AddEquation,
  CustomBlending,
  DepthTexture,
  GLSL3,
  HalfFloatType,
  Mesh,
  NearestFilter,
  OneFactor,
  OrthographicCamera,
  PlaneGeometry,
  RawShaderMaterial,
  RedIntegerFormat,
  RGBAFormat,
  Scene,
  UnsignedByteType,
  UnsignedIntType,
  type WebGLRenderer,
  WebGLRenderTarget,
} from "three";
import type { Box } from "./box";
import type { Slices, Work } from "./slices";
import { DEVELOP } from "./shaders";

const VERTEX = /* glsl */ `
in vec3 position;
void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }
`;

const ADD = /* glsl */ `
precision highp float;
uniform sampler2D drawing;
out vec4 color;
void main() { color = texelFetch(drawing, ivec2(gl_FragCoord.xy), 0); }
`;

const PRESENT = /* glsl */ `
precision highp float;
${DEVELOP}
uniform sampler2D sum;
uniform float drawings;
uniform vec2 size;
uniform vec4 seen; // what the camera aims at: its top left, width and height
uniform bool transparent;
out vec4 color;

// A pool of light behind the subject.
vec3 backdrop(vec2 at) {
  vec2 away = vec2(at.x - 0.5, 0.85 * (at.y - 0.55) * seen.w / seen.z) / 0.78;
  return mix(vec3(0.05, 0.062, 0.072), vec3(0.33, 0.38, 0.40), exp(-2.2 * dot(away, away)));
}

void main() {
  vec4 light = texelFetch(sum, ivec2(gl_FragCoord.xy), 0) / drawings;
  float grain = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453) - 0.5;
  if (transparent) {
    color = vec4(develop(light.rgb / max(light.a, 1e-6)), light.a);
    return;
  }
  vec2 at = (vec2(gl_FragCoord.x, size.y - gl_FragCoord.y) - seen.xy) / seen.zw;
  color = vec4(develop(light.rgb + (1.0 - light.a) * backdrop(at)) + grain / 255.0, 1.0);
}
`;

export class Film {
  /** Number of drawings on the film. */
  drawings = 0;
  drawing: WebGLRenderTarget;
  /** The hairs that are seen, where they are shaded after that: see `Hair`. */
  seen: WebGLRenderTarget | null = null;
  private sum: WebGLRenderTarget;
  private readonly scene = new Scene();
  private readonly camera = new OrthographicCamera();
  private readonly plane = new PlaneGeometry(2, 2);
  private readonly mesh = new Mesh(this.plane);
  private readonly add = material(ADD, { drawing: { value: null } });
  private readonly present = material(PRESENT, {
    sum: { value: null },
    drawings: { value: 1 },
    size: { value: [1, 1] },
    seen: { value: [0, 0, 1, 1] },
    transparent: { value: false },
  });

  /** samples: of each drawing */
  constructor(
    private readonly samples: number,
    private readonly deferred: boolean,
  ) {
    this.drawing = target(1, 1, samples, true);
    this.sum = target(1, 1, 0, false);
    if (deferred) this.seen = seenIn(this.drawing);
    Object.assign(this.add, {
      blending: CustomBlending,
      blendEquation: AddEquation,
      blendSrc: OneFactor,
      blendDst: OneFactor,
      transparent: true,
    });
    this.mesh.frustumCulled = false;
    this.scene.add(this.mesh);
  }

  get width(): number {
    return this.sum.width;
  }

  get height(): number {
    return this.sum.height;
  }

  /** Begins with an empty film of a size [pixels]. */
  clear(width: number, height: number): void {
    this.drawings = 0;
    if (this.sum.width === width && this.sum.height === height) return;
    this.drawing.dispose();
    this.sum.dispose();
    this.drawing = target(width, height, this.samples, true);
    this.sum = target(width, height, 0, false);
    this.seen?.dispose();
    if (this.deferred) this.seen = seenIn(this.drawing);
  }

  /** Begins a drawing: what is rendered on it until `expose` is added. */
  open(renderer: WebGLRenderer): void {
    renderer.setClearColor(0x000000, 0);
    for (const one of this.seen ? [this.drawing, this.seen] : [this.drawing]) {
      one.scissorTest = false;
      renderer.setRenderTarget(one);
      renderer.clear();
    }
    renderer.setRenderTarget(null);
  }

  /** Adds the drawing. */
  *expose(renderer: WebGLRenderer, slices: Slices): Work {
    const { sum } = this;
    yield* slices.draw("expose", sum.height, (first, count) => {
      this.add.uniforms["drawing"].value = this.drawing.texture;
      sum.scissorTest = true;
      sum.scissor.set(0, first, sum.width, count);
      renderer.setRenderTarget(sum);
      renderer.setClearColor(0x000000, 0);
      if (!this.drawings) renderer.clear();
      this.fill(renderer, this.add);
      renderer.setRenderTarget(null);
    });
    this.drawings++;
  }

  /** Develops the film to the canvas, or to another target. seen: what the camera aims at, around which the backdrop is lit [pixels of the film] */
  show(renderer: WebGLRenderer, { x, y, width, height }: Box, into: WebGLRenderTarget | null = null): void {
    this.set(false);
    this.present.uniforms["seen"].value = [x, y, width, height];
    renderer.setRenderTarget(into);
    this.fill(renderer, this.present);
  }

  /** Pixels of the picture without backdrop, from the top: red, green, blue and alpha. */
  transparent(renderer: WebGLRenderer): ImageData {
    const { width, height } = this.sum;
    const into = new WebGLRenderTarget(width, height, { type: UnsignedByteType, format: RGBAFormat, depthBuffer: false });
    this.set(true);
    renderer.setRenderTarget(into);
    this.fill(renderer, this.present);
    const rows = new Uint8Array(4 * width * height);
    renderer.readRenderTargetPixels(into, 0, 0, width, height, rows);
    renderer.setRenderTarget(null);
    into.dispose();
    const image = new ImageData(width, height);
    for (let y = 0; y < height; y++)
      image.data.set(rows.subarray(4 * width * y, 4 * width * (y + 1)), 4 * width * (height - 1 - y));
    return image;
  }

  private set(transparent: boolean): void {
    const { uniforms } = this.present;
    uniforms["sum"].value = this.sum.texture;
    uniforms["drawings"].value = Math.max(this.drawings, 1);
    uniforms["size"].value = [this.sum.width, this.sum.height];
    uniforms["transparent"].value = transparent;
  }

  private fill(renderer: WebGLRenderer, one: RawShaderMaterial): void {
    this.mesh.material = one;
    renderer.render(this.scene, this.camera);
  }
}

function material(fragmentShader: string, uniforms: Record<string, { value: unknown }>): RawShaderMaterial {
  return new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: VERTEX,
    fragmentShader,
    uniforms,
    depthTest: false,
    depthWrite: false,
  });
}

/** For the hairs that are seen in a drawing, which are hidden by the bodies on it. */
function seenIn(drawing: WebGLRenderTarget): WebGLRenderTarget {
  const { width, height } = drawing;
  const depthTexture = new DepthTexture(width, height);
  drawing.depthTexture = depthTexture;
  return new WebGLRenderTarget(width, height, {
    type: UnsignedIntType,
    format: RedIntegerFormat,
    internalFormat: "R32UI",
    minFilter: NearestFilter,
    magFilter: NearestFilter,
    depthTexture,
  });
}

function target(width: number, height: number, samples: number, depthBuffer: boolean): WebGLRenderTarget {
  return new WebGLRenderTarget(width, height, {
    type: HalfFloatType,
    format: RGBAFormat,
    minFilter: NearestFilter,
    magFilter: NearestFilter,
    depthBuffer,
    samples,
  });
}

// What stylists speak of, in their words, and the settings that they mean by it.

import type { File, Model, Place } from "../model";
import { Schemas, type Setting } from "./schema";

/** Something about a groom that has a name among stylists. */
interface Aspect {
  label: string;
  file: File;
  /** Settings that change it, as `table.setting`, `operator.setting`, or a part of one; those come first that change it most. */
  settings: string[];
  /** Words that ask for less of the first setting, for more of it, and that only name it. */
  less: string[];
  more: string[];
  named: string[];
  /** Whether it is among the few that most meetings need. */
  few?: boolean;
}

/** A setting of a stage; `inner` is one in its table. */
interface Found {
  file: File;
  stage: Place;
  setting: Setting;
  inner: Setting | null;
}

/** A setting that was meant, and what is to be done with it. */
interface Meant extends Found {
  aspect: Aspect;
  advice: string;
}

const ASPECTS: Aspect[] = [
  {
    label: "length",
    file: "recipe",
    settings: ["guides.length", "length.factor", "cut.at"],
    less: ["shorter", "short", "trim", "cut", "cropped", "crop", "bob"],
    more: ["longer", "long", "grow"],
    named: ["length"],
    few: true,
  },
  {
    label: "size of curls",
    file: "recipe",
    settings: ["curl.width", "coil.width"],
    less: ["tighter", "tight", "curlier", "curly", "smaller", "narrower", "coily", "kinkier", "kinky", "springy"],
    more: ["looser", "loose", "wavier", "wavy", "bigger", "wider", "relaxed"],
    named: ["curl", "curls", "coils", "waves", "ringlets", "size"],
    few: true,
  },
  {
    label: "tightness of turns",
    file: "recipe",
    settings: ["curl.pitch", "curl.curls", "curl.curls_per_cm"],
    less: ["tighter", "tight", "curlier", "curly", "springy", "shrinkage"],
    more: ["looser", "loose", "stretched", "elongated", "straighter", "straight"],
    named: ["curl", "curls", "turns", "pitch", "tightness"],
    few: true,
  },
  {
    label: "parting",
    file: "recipe",
    settings: ["guides.part_line.offset", "part.part_line.offset", "locks.sections"],
    less: ["right"],
    more: ["left"], // of the character, at +X
    named: ["parting", "part", "parted", "middle", "centre", "center", "side", "sections", "boxes"],
    few: true,
  },
  {
    label: "volume",
    file: "recipe",
    settings: ["volume.amount", "guides.lift", "lift.angle", "guides.gravity_bend"],
    less: ["flatter", "flat", "sleek", "sleeker"],
    more: ["fuller", "puffier", "puffy", "fluffier", "fluffy", "lift", "height", "higher", "rounder", "big", "body"],
    named: ["volume", "silhouette", "shape"],
    few: true,
  },
  {
    label: "hairs",
    file: "recipe",
    settings: ["hairs.per_lock", "hairs.density", "locks.count", "locks.density"],
    less: ["thinner", "thin", "sparser", "sparse", "finer", "fine"],
    more: ["dense", "denser", "thicker", "thick", "full", "fuller"],
    named: ["density", "amount", "hairs", "strands"],
    few: true,
  },
  {
    label: "frizz",
    file: "recipe",
    settings: ["hairs.frizz", "hairs.stray", "frizz.magnitude", "scraggle.magnitude", "flyaways.share", "noise.magnitude"],
    less: ["neat", "neater", "tidy", "tidier", "clean", "cleaner", "smooth", "smoother", "polished", "combed", "defined"],
    more: ["frizzy", "frizzier", "messy", "messier", "scruffy", "tousled", "undone", "wild", "wilder", "rough", "natural"],
    named: ["frizz", "flyaways", "texture", "halo"],
    few: true,
  },
  {
    label: "darkness",
    file: "recipe",
    settings: ["color.melanin", "color.preset"],
    less: ["lighter", "light", "blond", "blonde", "blonder", "fair", "fairer", "bleached"],
    more: ["darker", "dark", "black", "brown", "brunette", "browner"],
    named: ["color", "colour", "colouring", "coloring", "tint", "shade"],
    few: true,
  },
  {
    label: "redness",
    file: "recipe",
    settings: ["color.redness", "color.dye"],
    less: ["cooler", "ashy", "ash"],
    more: ["redder", "red", "ginger", "auburn", "copper", "warmer", "warm"],
    named: ["color", "colour"],
    few: true,
  },
  {
    label: "dye",
    file: "recipe",
    settings: ["color.dye", "color.dyes"],
    less: [],
    more: [],
    named: ["dye", "dyed", "highlights", "streaks", "ombre", "balayage", "roots", "pink", "blue", "green", "purple", "color", "colour"],
  },
  {
    label: "grey",
    file: "recipe",
    settings: ["color.gray"],
    less: [],
    more: ["grey", "gray", "greyer", "grayer", "older", "white", "silver"],
    named: [],
  },
  {
    label: "fringe and layers",
    file: "recipe",
    settings: ["guides.zone", "cut.at"],
    less: [],
    more: [],
    named: ["fringe", "bangs", "layers", "layered", "undercut", "fade", "taper", "front", "neck", "nape", "sides"],
  },
  {
    label: "hairline",
    file: "recipe",
    settings: ["locks.hairline", "edges.length"],
    less: [],
    more: [],
    named: ["hairline", "edges", "baby", "temples", "forehead"],
  },
  {
    label: "clumps",
    file: "recipe",
    settings: ["clump.tightness", "clump.size", "curl.phase_coherence"],
    less: ["separate", "separated", "piecey"],
    more: ["clumpier", "clumped", "clumps", "wet", "stringy", "together"],
    named: ["clumping"],
  },
  {
    label: "bounce",
    file: "shot",
    settings: ["motion.bounce", "strands.bend_scale", "strands.youngs_modulus"],
    less: ["slower", "heavier", "softer", "lazier", "floppy"],
    more: ["springier", "stiffer", "stiff", "quicker"],
    named: ["bounce", "bouncy", "bouncier", "springy", "lively", "motion", "movement", "swing"],
    few: true,
  },
  {
    label: "settling",
    file: "shot",
    settings: ["motion.settle", "strands.damping", "strands.drag"],
    less: ["calmer", "dampened"],
    more: [],
    named: ["settle", "damping", "swinging", "wobble", "jiggle"],
  },
];

const FILLERS = new Set("a an the and or with of on in at to it its more less much very bit little hair hairs my her his make be".split(" "));
const SHORTEST = 3; // letters of a word that is begun

/** Settings of a table, or of operators of a name, in the open files. */
function findSettings(model: Model, file: File, name: string): Found[] {
  const document = model.documents[file];
  if (!document || !model.welcome) return [];
  const [table, wanted, part] = name.split(".") as [string, string, string?];
  const schemas = new Schemas(model.welcome.schemas[file] as ConstructorParameters<typeof Schemas>[0]);
  const places: Place[] =
    file === "shot"
      ? document.values[table] ? [[table]] : []
      : document.stages.filter(({ op, place }) => (op || place[0]) === table).map(({ place }) => place);
  const found: Found[] = [];
  for (const stage of places)
    for (const setting of schemas.settings(stage, model.value(file, stage) ?? null)) {
      if (setting.name !== wanted) continue;
      const inner = setting.inner.find((one) => one.name === part) ?? null;
      if (!part || inner) found.push({ file, stage, setting, inner });
    }
  return found;
}

/** The few settings that most meetings need, with their places, by what stylists call them. */
export function fewSettings(model: Model): { file: File; place: Place; setting: Setting }[] {
  return ASPECTS.filter(({ few }) => few).flatMap(({ label, file, settings }) => {
    const found = settings.flatMap((name) => findSettings(model, file, name))[0];
    if (!found) return [];
    const { stage, setting, inner } = found;
    return [{ file, place: [...stage, setting.name, ...(inner ? [inner.name] : [])], setting: { ...(inner ?? setting), label, inner: [] } }]; // how it varies is on its stage
  });
}

/** Settings that words ask for, those first that change most; and aspects of files that are not open. */
export function meantBy(model: Model, text: string): { meant: Meant[]; missing: Aspect[] } {
  const typed = text.toLowerCase().split(/[^a-z]+/);
  const words = typed.filter((word) => word && !FILLERS.has(word));
  const [meant, missing]: [Meant[], Aspect[]] = [[], []];
  for (const aspect of ASPECTS) {
    const known = [aspect.less, aspect.more, aspect.named];
    const exact = known.flat().some((one) => words.includes(one));
    const fits = (one: string) => words.some((word) => one === word || (!exact && word.length >= SHORTEST && one.startsWith(word)));
    const [asksLess, asksMore, named] = known.map((all) => all.some(fits));
    if (!asksLess && !asksMore && !named) continue;
    const [less, more] = [asksLess || (named && typed.includes("less")), asksMore || (named && typed.includes("more"))];
    if (!model.documents[aspect.file]) missing.push(aspect);
    const advice = less === more ? "" : less ? "less: drag to the left" : "more: drag to the right";
    const found = aspect.settings.flatMap((name) => findSettings(model, aspect.file, name));
    found.forEach((one, k) => meant.push({ ...one, aspect, advice: k ? "" : advice }));
  }
  const exact = (one: Meant) => Number([...one.aspect.less, ...one.aspect.more].some((known) => words.includes(known)));
  return { meant: meant.sort((a, b) => exact(b) - exact(a)), missing };
}

// From the JSON schema of a recipe or a shot to what kind of control each setting gets.

import type { Json, Names } from "../protocol";

type Schema = Record<string, Json>;
export type Named = Exclude<keyof Names, "kind">;

/** What settings of these names hold the name of. */
const NAMED: Record<string, Named> = {
  region: "regions",
  map: "maps",
  density: "maps",
  direction: "vectors",
  curve: "curves",
  tie: "curves",
  line: "curves",
  path: "curves",
  part_lines: "curves",
};

/** Labels of settings whose name in the file does not read as one. */
const LABELS: Record<string, string> = { youngs_modulus: "Young's modulus" };

export interface Setting {
  name: string;
  label: string;
  description: string;
  kind:
    | "number"
    | "integer"
    | "toggle"
    | "choice"
    | "text"
    | "color"
    | "name"
    | "drawn"
    | "regions"
    | "ramp"
    | "vector"
    | "table"
    | "list"
    | "other";
  unit: string;
  /** Whether plain numbers in the file are in SI, and not in the recipe's unit. */
  si: boolean;
  least: number;
  most: number;
  fallback: Json;
  optional: boolean;
  choices: string[];
  /** Settings of a value that varies (`vary`, `noise`, `ramp` …), of a table, or of each entry of a list. */
  inner: Setting[];
  /** Whether it is a value that may also be a table of `inner`. */
  varied: boolean;
  /** Whether a single lock may have a value of its own. */
  perLock: boolean;
  named: Named;
}

export class Schemas {
  constructor(private readonly root: Schema) {}

  /** The settings of the table at a place of the file; `op` is its operator, `values` what holds there. */
  settings(place: (string | number)[], values: Json): Setting[] {
    const properties = this.root["properties"] as Record<string, Schema>;
    if (!place.length) return this.own(properties);
    let schema = this.resolve(properties[String(place[0])], values);
    if (place.length > 1) schema = this.resolve(schema["items"] as Schema, values);
    return this.of(schema);
  }

  /** Settings of an operator that have no default. */
  required(op: string): Setting[] {
    const shape = this.resolve(this.root["properties"] as Schema, null)["shape"] as Schema;
    const schema = this.resolve(shape["items"] as Schema, { op });
    const names = ((schema["required"] ?? []) as string[]).filter((name) => name !== "op");
    return this.of(schema).filter((setting) => names.includes(setting.name));
  }

  /** Settings of the file itself that are no tables. */
  private own(properties: Record<string, Schema>): Setting[] {
    return Object.entries(properties)
      .filter(([name]) => name !== "ringlet")
      .map(([name, property]) => this.setting(name, property))
      .filter((setting) => !["table", "list", "other"].includes(setting.kind));
  }

  private of(schema: Schema): Setting[] {
    const properties = (schema["properties"] ?? {}) as Record<string, Schema>;
    return Object.entries(properties)
      .filter(([name]) => name !== "op")
      .map(([name, property]) => this.setting(name, property));
  }

  private resolve(schema: Schema, values: Json): Schema {
    if (typeof schema["$ref"] === "string") {
      const defs = this.root["$defs"] as Record<string, Schema>;
      return this.resolve({ ...defs[schema["$ref"].split("/").pop()!], ...without(schema, "$ref") }, values);
    }
    const choices = (schema["oneOf"] ?? schema["anyOf"]) as Schema[] | undefined;
    if (!choices) return schema;
    const mapping = (schema["discriminator"] as Schema | undefined)?.["mapping"] as Record<string, string> | undefined;
    const op = (values as Record<string, Json> | null)?.["op"];
    if (mapping && typeof op === "string") return this.resolve({ $ref: mapping[op] }, values);
    const tables = choices.map((choice) => this.resolve(choice, values)).filter((choice) => choice["properties"]);
    const keys = Object.keys((values as Record<string, Json> | null) ?? {});
    const fits = (table: Schema) => keys.filter((key) => key in (table["properties"] as Schema)).length;
    return tables.sort((a, b) => fits(b) - fits(a))[0] ?? schema;
  }

  private setting(name: string, given: Schema): Setting {
    const parts = (given["anyOf"] as Schema[] | undefined) ?? [given];
    const optional = parts.some((part) => part["type"] === "null");
    const real = parts.filter((part) => part["type"] !== "null");
    const setting: Setting = {
      name,
      label: LABELS[name] ?? name.replaceAll("_", " "),
      description: String(given["description"] ?? ""),
      kind: "other",
      unit: String(given["unit"] ?? unitIn(String(given["description"] ?? ""))),
      si: given["unit"] === undefined,
      least: Number.NEGATIVE_INFINITY,
      most: Number.POSITIVE_INFINITY,
      fallback: given["default"] ?? null,
      optional,
      choices: [],
      inner: [],
      varied: false,
      perLock: false,
      named: NAMED[name] ?? "maps",
    };
    const number = real.find((part) => part["type"] === "number" || part["type"] === "integer");
    const table = real.find((part) => part["$ref"] || part["properties"]);
    if (number) {
      setting.kind = number["type"] === "integer" ? "integer" : "number";
      setting.least = bound(number, ["minimum", "exclusiveMinimum"], setting.least);
      setting.most = bound(number, ["maximum", "exclusiveMaximum"], setting.most);
      if (table) {
        setting.varied = true;
        setting.inner = this.of(this.resolve(table, null)).filter(
          (inner) => inner.name !== "value" && inner.kind !== "other",
        );
        const { unit, si, least, most } = setting;
        for (const inner of setting.inner) if (inner.kind === "regions") Object.assign(inner, { unit, si, least, most });
        setting.perLock = "lock" in (this.resolve(table, null)["properties"] as Schema);
      }
      return setting;
    }
    const only = this.resolve(real[0] ?? {}, null);
    const items = only["items"] as Schema | undefined;
    if (only["type"] === "boolean") setting.kind = "toggle";
    else if (only["enum"]) Object.assign(setting, { kind: "choice", choices: only["enum"] });
    else if (only["format"] === "color") setting.kind = "color";
    else if (only["type"] === "string") setting.kind = name in NAMED ? "name" : "text";
    else if (only["type"] === "object" && name === "region") setting.kind = "regions";
    else if (only["type"] === "array" && name === "drawn") setting.kind = "drawn";
    else if (only["type"] === "array" && items && isPair(items)) setting.kind = "ramp";
    else if (only["type"] === "array" && isVector(only)) setting.kind = "vector";
    else if (only["type"] === "array" && items && this.resolve(items, null)["properties"])
      Object.assign(setting, { kind: "list", inner: this.of(this.resolve(items, null)) });
    else if (only["properties"]) Object.assign(setting, { kind: "table", inner: this.of(only) });
    return setting;
  }
}

/** The unit that a description gives in brackets: `E [Pa]`. */
function unitIn(description: string): string {
  return /\[([^\]\d,]+[²³]?[^\]\d,]*)\]/.exec(description)?.[1] ?? "";
}

function without(schema: Schema, name: string): Schema {
  return Object.fromEntries(Object.entries(schema).filter(([key]) => key !== name));
}

function bound(schema: Schema, names: string[], otherwise: number): number {
  const given = names.map((name) => schema[name]).find((value) => typeof value === "number");
  return typeof given === "number" ? given : otherwise;
}

function isPair(items: Schema): boolean {
  return items["type"] === "array" && (items["prefixItems"] as Json[] | undefined)?.length === 2;
}

function isVector(schema: Schema): boolean {
  return (schema["prefixItems"] as Json[] | undefined)?.length === 3 && schema["maxItems"] === 3;
}

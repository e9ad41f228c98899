import type { GratingRow, Layer, Metal } from './layer.js';

export type { GratingRow, Layer, Metal } from './layer.js';

/** All shader modules in one file. */
export const hairlineWgsl: string;

export const metals: Metal[];
/** Reflectance at normal incidence, linear Rec.709; after loadTables(). */
export function metalColor(metal: Metal): [number, number, number];

/** Texels of an rgba32float texture. */
export interface TableTexels { data: Float32Array; width: number; height: number }
/** The tables of the base. */
export class Tables {
  constructor();
  readonly shapes: TableTexels;
  readonly albedo: TableTexels;
  readonly curves: TableTexels;
}
/**
 * Loads Hairline's own code, engine_bg.wasm, from beside the scripts unless an address is given, and makes the tables. Laying scratches, their trees, spectra
 * and colours of metals need it first.
 */
export function loadTables(url?: string | URL): Promise<Tables>;
/** `curve` of FresnelRgb; null: Schlick's, of a metal by its colour. */
export function curveOf(metal: Metal | null): number;
/** `curve` of FresnelRgb of a dielectric of a refractive index. */
export function dielectricCurve(ior: number): number;

/** Cross section of grooves: a name, or 2 to 64 depths over the deepest one, from the middle to the rim. */
export type GrooveProfile = 'rectangle' | 'v' | 'round' | 'shoulders' | number[];
/** Grooves of one table: a cross section, and a class of widths over the coherence length, 0 for narrow ones. */
export interface GrooveShape { profile: GrooveProfile; widthClass: number }

/** What tables need to know of scratches: what scratchTree() returns has it. */
export interface TableOf { shapes: readonly GrooveShape[]; tableRows: number }
/** Texels of T(u, d), four numbers each, rgba32uint, a layer for each shape of each metal; null: a metal given by its colour. */
export function scratchTables(metal: Metal | null | (Metal | null)[], scratches: TableOf): { texels: Uint32Array; columns: number; rows: number; layers: number };
/** The same as a texture. */
export function makeScratchTables(device: GPUDevice, metal: Metal | null | (Metal | null)[], scratches: TableOf): GPUTexture;

/** Straight pieces of scratches, in an object's own frame. */
export interface ScratchArrays {
  /** Three numbers for each piece. */
  starts: ArrayLike<number>;
  ends: ArrayLike<number>;
  widthsUm: ArrayLike<number>;
  depthsNm: ArrayLike<number>;
  /** The number of the scratch; its pieces follow one another. */
  scratch: ArrayLike<number>;
  /** The surface's, three numbers for each piece; null: not known, so that scratches show on both sides of a sheet. */
  normals?: ArrayLike<number> | null;
  /** The cross section of each piece; null: rectangles. */
  profiles?: GrooveProfile[] | null;
}
export class Scratches implements ScratchArrays {
  constructor(arrays: ScratchArrays);
  readonly starts: ArrayLike<number>;
  readonly ends: ArrayLike<number>;
  readonly widthsUm: ArrayLike<number>;
  readonly depthsNm: ArrayLike<number>;
  readonly scratch: ArrayLike<number>;
  readonly normals: ArrayLike<number> | null;
  readonly profiles: GrooveProfile[] | null;
  readonly count: number;
  /** By a matrix of 16 numbers, column by column. */
  transformed(matrix: ArrayLike<number>): Scratches;
  /** These and `other`, which lie on the same mesh: both with normals, or neither. */
  joined(other: Scratches): Scratches;
}
/** Reads a list (CSV). `name` is what errors call it; `profile` the cross section of all of them. */
export function readScratches(text: string, name?: string, options?: { profile?: GrooveProfile }): Scratches;
/** The texture that shaders find scratches by, rgba32uint, and the shapes of their grooves, of which the first is that of narrow rectangles. */
export function scratchTree(scratches: Scratches, options?: { coherenceUm?: number; metresPerUnit?: number }): TableOf & { texels: Uint32Array; width: number; height: number };

/** Triangles in the object's own frame. */
export interface MeshArrays {
  /** Three numbers a vertex. */
  positions: ArrayLike<number>;
  /** Three numbers a triangle; without it three vertices are one. */
  index?: ArrayLike<number> | null;
  /** Three numbers a vertex; without them triangles are flat. */
  normals?: ArrayLike<number> | null;
  /** Two numbers a vertex, for pictures. */
  uvs?: ArrayLike<number> | null;
}
/** What layers name: pictures, drawings as bytes of SVG files, and lists of straight scratches with six numbers for the two ends of each, in metres; pieces side by side with one number in `scratches` are one. */
export type LayerFile = { width: number; rgba: Uint8Array | Uint8ClampedArray } | { svg: Uint8Array } | { endsM: ArrayLike<number>; widthsUm: ArrayLike<number>; depthsNm: ArrayLike<number>; scratches?: ArrayLike<number> };
export interface LayingOptions {
  /** How long a unit of the mesh's own frame is in the world. */
  metresPerUnit?: number;
  /** By the names that the layers have. */
  files?: Record<string, LayerFile>;
}
/** Lays scratches on triangles, as Hairline does: a seed means the same scratches. */
export function layScratches(mesh: MeshArrays, layers: Layer | Layer[], options?: LayingOptions): Scratches;

/** A Texture of three.js, whose values are numbers: it has no colour space. */
export interface GroovePicture { readonly isTexture: true; channel: number; flipY: boolean }
/** Grooves along a direction, about an axis, or along texture coordinates. */
export type GratingKind = 'along' | 'circular' | 'radial' | 'spun' | 'along-u' | 'along-v';
export interface GratingOptions {
  /** Texels of the table, rgba32uint, 512 wide; 2 to 256 high, or 512 of a fine grating. */
  texels: Uint32Array;
  kind?: GratingKind;
  /** In the mesh's own frame; not of 'along-u' and 'along-v'. */
  axis?: number[];
  center?: number[];
  /** From the axis, or from the centre of grooves without one: metres in the world. */
  radiiM?: [number, number];
  /** Of 'spun'. */
  curvaturePerM?: number;
  coverage?: number;
  angleStdRad?: number;
  coherenceUm?: number;
  /** A picture by texture coordinates in three.js: its red, from 0 to 1, is a factor on the coverage. */
  mask?: GroovePicture | null;
  /** In three.js, of 'along-u' and 'along-v': a picture that turns the grooves. Red is the part along the coordinate, green that up across it, from -1 (0) to 1 (1). */
  directions?: GroovePicture | null;
}
/** Rows of grooves whose light interferes. */
export class Grating implements Required<GratingOptions> {
  constructor(options: GratingOptions);
  readonly texels: Uint32Array;
  readonly kind: GratingKind;
  readonly axis: number[];
  readonly center: number[];
  readonly radiiM: [number, number];
  readonly curvaturePerM: number;
  readonly coverage: number;
  readonly angleStdRad: number;
  readonly coherenceUm: number;
  readonly mask: GroovePicture | null;
  readonly directions: GroovePicture | null;
  readonly rows: number;
  /** `Grooves` of grated_surface.wgsl. */
  readonly numbers: number[];
}
export interface GratingLaying {
  /** Null: one given by its colour. */
  metal?: Metal | null;
  /** The material's. */
  coherenceUm?: number;
  /** By the names that `mask` and `directions` of the rows have. */
  pictures?: Record<string, GroovePicture>;
}
/** Makes the tables of rows of grooves, as Hairline does with `theory = "scalar"`; of hidden rows none. */
export function layGratings(rows: GratingRow | GratingRow[], options?: GratingLaying): Grating[];
/** Fetches the table of a grating: `cd` of hairline-shaders/cd, `dvd` of hairline-shaders/dvd, or one of your own. */
export function loadGrating(url: string | URL, options?: Omit<GratingOptions, 'texels'>): Promise<Grating>;

/** All shader modules in one file. */
export const hairlineWgsl: string;
/** The pass that makes tables. */
export const makeScratchTableWgsl: string;

/** A metal whose refractive index was measured. */
export type Metal = 'iron' | 'steel' | 'aluminium' | 'copper' | 'gold' | 'silver' | 'brass' | 'chromium' | 'titanium' | 'nickel';
export const metals: Metal[];
/** Reflectance at normal incidence, linear Rec.709. */
export function metalColor(metal: Metal): [number, number, number];

/** Texels of an rgba32float texture. */
export interface TableTexels { data: Float32Array; width: number; height: number }
/** The tables of the base. */
export class Tables {
  constructor(bytes: ArrayBuffer);
  readonly shapes: TableTexels;
  readonly albedo: TableTexels;
  readonly curves: TableTexels;
}
/** Fetches tables.bin, from beside the scripts unless an address is given. */
export function loadTables(url?: string | URL): Promise<Tables>;
/** `curve` of FresnelRgb; null: Schlick's. */
export function curveOf(metal: Metal | null): number;

/** Cross section of grooves: a name, or 2 to 64 depths over the deepest one, from the middle to the rim. */
export type GrooveProfile = 'rectangle' | 'v' | 'round' | 'shoulders' | number[];
/** Grooves of one table: a cross section, and a class of widths over the coherence length, 0 for narrow ones. */
export interface GrooveShape { profile: GrooveProfile; widthClass: number }

export const tableSize: { columns: number; rows: number };
/** Texels of T(u, d), four numbers each, rgba32uint; null: a metal given by its colour. Without a shape: narrow rectangles. */
export function scratchTable(metal: Metal | null, shape?: GrooveShape): Uint32Array;
/** The same by a pass: a texture of a layer for each shape of each metal. */
export function makeScratchTable(device: GPUDevice, metal: Metal | null | (Metal | null)[], shapes?: GrooveShape[]): GPUTexture;

/** Straight pieces of scratches, in an object's own frame. */
export interface ScratchArrays {
  /** Three numbers for each piece. */
  starts: Float64Array;
  ends: Float64Array;
  widthsUm: Float64Array;
  depthsNm: Float64Array;
  /** The number of the scratch; its pieces follow one another. */
  scratch: Uint32Array;
  /** The surface's, three numbers for each piece; null: not known, so that scratches show on both sides of a sheet. */
  normals?: Float64Array | null;
  /** The cross section of each piece; null: rectangles. */
  profiles?: GrooveProfile[] | null;
}
export class Scratches implements ScratchArrays {
  constructor(arrays: ScratchArrays);
  readonly starts: Float64Array;
  readonly ends: Float64Array;
  readonly widthsUm: Float64Array;
  readonly depthsNm: Float64Array;
  readonly scratch: Uint32Array;
  readonly normals: Float64Array | null;
  readonly profiles: GrooveProfile[] | null;
  readonly count: number;
  /** By a matrix of 16 numbers, column by column. */
  transformed(matrix: ArrayLike<number>): Scratches;
  /** These and `other`, which lie on the same mesh: both with normals, or neither. */
  joined(other: Scratches): Scratches;
}
/** Reads a list (CSV). `name` is what errors call it; `profile` the cross section of all of them. */
export function readScratches(text: string, name?: string, options?: { profile?: GrooveProfile }): Scratches;
/** By how much free ends move inwards, and what smooths them. */
export function scratchEnds(lengthUm: number, coherenceUm: number): { shrinkUm: number; blurUm: number };
/** How alike depths are: pairs of a depth in nm and a weight. */
export function depthCoherence(depths: [number, number][]): number;

/** A piece with its free ends moved inwards. */
export interface PreparedPiece {
  start: number[];
  end: number[];
  normal: number[] | null;
  widthUm: number;
  depthNm: number;
  blurUm: number;
  /** Index in the shapes. */
  shape?: number;
  /** Class of the width of the groove that it is a part of; 0 for a narrow one. */
  widthClass?: number;
}
export interface Prepared {
  pieces: PreparedPiece[];
  /** Shapes of the grooves; the first one is of narrow rectangles. */
  shapes: GrooveShape[];
  coherenceUm: number;
  depthCoherence: number;
}
export function preparedPieces(scratches: Scratches, options?: { coherenceUm?: number; metresPerUnit?: number }): Prepared;
/** Texels of an rgba32uint texture. */
export function scratchTree(prepared: Omit<Prepared, 'shapes'>, options?: { metresPerUnit?: number }): { texels: Uint32Array; width: number; height: number };

/** Alike for all, or drawn: log-normal, of curvatures normal. */
export type Size = number | { mean: number; spread?: number };
export interface PatternOptions {
  pattern?: 'random' | 'parallel' | 'circular' | 'radial';
  count: number;
  seed?: number;
  lengthM?: Size;
  widthUm?: Size;
  depthNm?: Size;
  profile?: GrooveProfile;
  /** Of 'random'. */
  curvaturePerM?: Size;
  jitterDeg?: number;
  axis?: number[];
  centerM?: number[];
  /** Of 'parallel'. */
  direction?: number[];
  metresPerUnit?: number;
}
/** Lays scratches on triangles. */
export function layScratches(mesh: { positions: ArrayLike<number>; index: ArrayLike<number> | null }, options: PatternOptions): Scratches;

export interface GratingOptions {
  /** Texels of the table, rgba32uint, 512 wide; 256 high, or 512 of a fine grating. */
  texels: Uint32Array;
  /** Along a direction, or about an axis. */
  kind?: 'along' | 'circular' | 'radial' | 'spun';
  /** In the mesh's own frame. */
  axis?: number[];
  center?: number[];
  /** From the axis, or from the centre of grooves along a direction: metres in the world. */
  radiiM?: [number, number];
  /** Of 'spun'. */
  curvaturePerM?: number;
  coverage?: number;
  angleStdRad?: number;
  coherenceUm?: number;
}
/** Rows of grooves whose light interferes. */
export class Grating implements Required<GratingOptions> {
  constructor(options: GratingOptions);
  readonly texels: Uint32Array;
  readonly kind: 'along' | 'circular' | 'radial' | 'spun';
  readonly axis: number[];
  readonly center: number[];
  readonly radiiM: [number, number];
  readonly curvaturePerM: number;
  readonly coverage: number;
  readonly angleStdRad: number;
  readonly coherenceUm: number;
  readonly rows: number;
  /** `Grooves` of grated_surface.wgsl. */
  readonly numbers: number[];
}
/** Fetches the table of a grating that the package has, in aluminium. */
export function loadGrating(name: 'cd' | 'dvd', options?: Omit<GratingOptions, 'texels'>, url?: string | URL): Promise<Grating>;

// What the server sends; the shapes are those of `drawing.py`, `shown.py`, `analyses.py` and `controls.py`. Nothing of it is sent to a browser.


/** A part of the drawing: which entries it has depends on its kind. */
type Part = { kind: string, name: string, series?: number, at: string, link?: string | null, angle: number, from: string, to: string,
  ends: number[][] & number[], span: number[], bar: number[], offset: number, radius: number, radii: number[], crossed: boolean,
  outlines: number[][][], place: number[], along: number, rod?: number[] | null, corners: string[], heavy: boolean, slides: boolean,
  side: string, role: string, x: number, half: number, top: number, barrel: number[], range: number[], wide: number[] };

type Scene = { angles: Float64Array, times: Float64Array, speeds: Float64Array, points: Record<string, Float64Array>,
  headings: Record<string, Float64Array>, rods?: Record<string, Float64Array>, parts: Part[], box: number[], swings: boolean, true_speed: boolean,
  velocities: Record<string, Float64Array>, accelerations: Record<string, Float64Array>,
  forces: { name: string, point: string, force: Float64Array }[], handles: { point: string, entries: string[] }[],
  centres: Record<string, { at: string, angle: Float64Array, fixed: Float64Array, moving: Float64Array }> };

type Words = { name: string, word: string, symbol: string, unit: string };
type Curve = Words & { values: Float64Array, own?: boolean };
type Plot = { key: string, title: string, unit: string, x: Curve, curves: Curve[], isHodograph?: boolean, isCard?: boolean };
type Shown = { name: string, scalars: (Words & { value: number })[], plots: Plot[] };
type Table = { name: string, title: string, heads: string[], rows: string[][] };
type Figure = { name: string, title: string, caption: string, svg: string };
/** What one lane has found. */
type Answers = { results: Shown[], findings: string[], warnings: string[], figures: Figure[], views?: any[], tables?: Table[], headline?: string[][] };
type Chip = { name: string, word: string, lane: string, obstacle?: string, mend?: string, entries?: Record<string, any> };

type Entry = { address: string, key: string, about: string, written: any, holds: string, unit?: string, bounds?: Record<string, number>,
  si?: number | null, tolerance?: string, choices?: string[], expected?: string };
type Missing = { address: string, key: string, about: string, expected: string, usual: any, kinds: string[], choices?: string[],
  unit?: string };
type Group = { address: string, key: string, about: string, entries: Entry[], groups: Group[], missing: Missing[] };
type Problem = { key: string, found: string, expected: string, remedy: string, line: number | null };
type Listed = { place: string, name: string, title: string };

type Slopes = { response: string, word: string, symbol: string, unit: string, value: number, slopes: Record<string, number>, tie: string };
type Pin = { name: string, text: string, scalars: Record<string, number>, plots: Record<string, { x: Float64Array, curves: Record<string, Float64Array> }> };

/** A list to choose from: values with their words, and whether these are the user's own. */
type Options = [value: string | number, words: any, isOwn?: boolean][];
type Ctx = CanvasRenderingContext2D;
type Sheet = { title: string, heads: string[], rows: ArrayLike<number>[], isToScale?: boolean, isPairs?: boolean };
/** An end of a link that is drawn [m], at a point of the drawing with its name. */
type Spot = { x: number, y: number, point: string };
type Frame = { scale: number, x: number, y: number };
type View = { ctx: Ctx, scene: Scene, frame: Frame, k: number, ink: Record<string, string>, series: string[], light?: string,
  stress?: (value: number) => string };
/** What a picture is drawn with; `passed` is the time since the last frame on the page [s], 0 while it stands. */
type Paper = { ctx: Ctx, width: number, height: number, passed: number, ink: Record<string, string>, series: string[] };
type Knife = { kind: "topper", law: Float64Array, rate: number, drift: number, phase: number, angle: number, length: number, speed: number,
  diameter: number, offset: number, heads: number[][], span: number[], box: number[], seconds: number };
/** A section of a cam or an axis; `rate`, units of its entry in a radian of the master. */
type Section = { address: string, unit: string, rate: number, angle: number, dwells: boolean };
type Track = { name: string, phase: number, address?: string, sections: Section[], curves: { name: string, unit: string, values: Float64Array }[] };
type SectionEnd = { track: Track, row: number, k: number, key: string, angle: number };
type Disc = { name: string, x: number, row: number, half: number };
type Joint = { name: string, kind: string, ends: (number | null)[], from: number[], to: number[], turned: boolean, share?: Float64Array, angles?: Float64Array };
type Train = { kind: "train", discs: Disc[], parts: Joint[], frequencies: Float64Array, shapes: Float64Array,
  nodes: { at: string, share: number }[][], box: number[] };
type Sight = Paper & { view: Train, mode: number, swing: number, names: boolean, leans: boolean, X: (x: number) => number, Y: (row: number) => number, unit: number };
/** Texts with their translation, `{}` for what is put in; units; decimal sign. */
type Catalogue = { code: string, texts: Record<string, string>, units: Record<string, string>, decimal: string };
type Asked = { ask: string, [key: string]: any };
type Colours = Record<"ink" | "soft" | "grid" | "panel" | "paper" | "accent" | "bad", string> & { series: string[] };

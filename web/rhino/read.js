// A 3dm file as a framework, by rhino3dm (McNeel, MIT), which comes in thread-3dm.js together with this: lines, polylines and the edges
// of meshes; other curves as edges as long as their arc. Lengths in units of the file. Nodes are joined by the program that reads it.

const RHINO_UNITS = {Millimeters: 'mm', Centimeters: 'cm', Meters: 'm', Inches: 'in', Feet: 'ft'};
const ARC_PARTS = 1000; // chords in place of an arc

class RhinoFrame {
  constructor(rhino) {
    this.rhino = rhino;
    this.nodes = [];
    this.edges = [];
    this.lengths = [];
    this.left = 0; // objects that are neither curves nor meshes
  }

  line(from, to, length = null) {
    if (from.every((x, k) => x === to[k])) return;
    this.edges.push([this.nodes.length, this.nodes.length + 1]);
    this.nodes.push(from, to);
    this.lengths.push(length);
  }

  lines(points) {
    points.slice(1).forEach((to, i) => this.line(points[i], to));
  }

  // The length of the chords: an arc's but for a part in a million.
  arc(curve) {
    const [first, last] = curve.domain, at = (i) => curve.pointAt(first + ((last - first) * i) / ARC_PARTS).slice(0, 3);
    let length = 0;
    for (let i = 0; i < ARC_PARTS; i++) length += Math.hypot(...at(i + 1).map((x, k) => x - at(i)[k]));
    this.line(at(0), at(ARC_PARTS), length);
  }

  curve(curve) {
    const count = (n, at) => Array.from({length: n}, (_, i) => at(i).slice(0, 3));
    if (curve instanceof this.rhino.PolyCurve) for (let i = 0; i < curve.segmentCount; i++) this.curve(curve.segmentCurve(i));
    else if (curve instanceof this.rhino.PolylineCurve) this.lines(count(curve.pointCount, (i) => curve.point(i)));
    else if (curve instanceof this.rhino.LineCurve) this.line(curve.pointAtStart.slice(0, 3), curve.pointAtEnd.slice(0, 3));
    else if (curve instanceof this.rhino.NurbsCurve && curve.degree === 1)
      this.lines(count(curve.points().count, (i) => curve.points().get(i).slice(0, 3).map((x) => x / (curve.points().get(i)[3] || 1))));
    else this.arc(curve);
  }

  mesh(mesh) {
    const seen = new Set(), at = (i) => mesh.vertices().get(i).slice(0, 3);
    for (let f = 0; f < mesh.faces().count; f++) {
      const corners = mesh.faces().get(f).filter((v, i, all) => all.indexOf(v) === i);
      corners.forEach((v, i) => {
        const pair = [v, corners[(i + 1) % corners.length]].sort((a, b) => a - b);
        if (!seen.has(pair.join())) this.line(at(pair[0]), at(pair[1]));
        seen.add(pair.join());
      });
    }
  }

  add(geometry) {
    const {Curve, Mesh} = this.rhino.ObjectType;
    if (geometry.objectType === Curve) this.curve(geometry);
    else if (geometry.objectType === Mesh) this.mesh(geometry);
    else this.left++;
  }
}

// {text, notes}: a framework as JSON; throws an Error with one line.
globalThis.frameOf3dm = async (bytes) => {
  const rhino = await globalThis.rhino3dm({wasmBinary: await inflate(globalThis.RHINO3DM_WASM)});
  const file = rhino.File3dm.fromByteArray(bytes);
  if (!file) throw new Error('not a 3dm file that rhino3dm can read; save it anew from Rhino, or as DXF or OBJ');
  const frame = new RhinoFrame(rhino), objects = file.objects();
  for (let i = 0; i < objects.count; i++) frame.add(objects.get(i).geometry());
  const left = frame.left ? [`${frame.left} object${frame.left > 1 ? 's' : ''} left out: no curve, and no mesh`] : [];
  if (!frame.edges.length) throw new Error(['no lines, polylines or meshes are in it', ...left].join('; '));
  const unit = Object.keys(RHINO_UNITS).find((name) => rhino.UnitSystem[name] === file.settings().modelUnitSystem);
  const {nodes, edges, lengths} = frame;
  return {text: JSON.stringify({...(unit && {units: RHINO_UNITS[unit]}), nodes, edges, lengths}), notes: left};
};

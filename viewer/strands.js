// Where the cords run in space: every pass has a lane of its own, inside a solid piece side by side around the middle of its arm, of
// a tube on its outer side; turns are curves. Pure geometry.
import {Vector3} from 'three';

const LANES = (140 * Math.PI) / 180; // the fan of lanes on the outer side of a tube
const BORE = 0.5; // of the radius of an arm: how far from its middle several lanes lie

// Sizes of pieces and cords, all from the median edge.
export function sizesOf(plan, nodes) {
  const lengths = plan.edges.map(([a, b]) => nodes[a].distanceTo(nodes[b]));
  const sorted = [...lengths].sort((x, y) => x - y);
  const pitch = sorted[sorted.length >> 1] || 1;
  const radius = (plan.solid ? 0.14 : 0.095) * pitch;
  const room = plan.solid ? 2.4 * BORE * radius : 0.8 * radius * LANES;
  const cord = plan.kit ? plan.kit.cord / (2 * plan.kit.mm) : Math.min(0.03 * pitch, room / (2 * plan.most));
  return {pitch, radius, cord, lengths, gap: lengths.map((l) => Math.min(0.22 * pitch, 0.3 * l))};
}

// A unit vector at right angles to the axis, as near to a wish as can be.
export function across(axis, wish) {
  const side = wish.clone().addScaledVector(axis, -wish.dot(axis));
  if (side.lengthSq() > 1e-6) return side.normalize();
  const least = Math.abs(axis.x) < 0.6 ? new Vector3(1, 0, 0) : new Vector3(0, 1, 0);
  return least.addScaledVector(axis, -least.dot(axis)).normalize();
}

// Per edge: axis and outward side.
export function frames(plan, nodes) {
  const middle = nodes.reduce((sum, p) => sum.add(p), new Vector3()).divideScalar(nodes.length || 1);
  return plan.edges.map(([a, b]) => {
    const axis = nodes[b].clone().sub(nodes[a]).normalize();
    if (axis.lengthSq() === 0) axis.set(1, 0, 0);
    const wish = new Vector3(...plan.outward[a]).add(new Vector3(...plan.outward[b]));
    if (wish.lengthSq() < 1e-3) wish.addVectors(nodes[a], nodes[b]).multiplyScalar(0.5).sub(middle);
    return {axis, out: across(axis, wish)};
  });
}

// The straight part of every step: two points in its lane, and the direction of the pass.
export function lanes(plan, nodes, sizes, frame) {
  const total = new Int32Array(plan.edges.length);
  for (const step of plan.steps) total[step.edge]++;
  return plan.steps.map(({cord, k, edge, half, visit}) => {
    const {axis, out} = frame[edge], side = new Vector3().crossVectors(axis, out);
    const n = total[edge], part = n > 1 ? (visit - 0.5) / n - 0.5 : 0, angle = part * (plan.solid ? 2 * Math.PI : LANES);
    const off = side.clone().multiplyScalar(Math.sin(angle)).addScaledVector(out, Math.cos(angle));
    if (plan.kit) off.set(...plan.kit.lanes[cord][k]).divideScalar(plan.kit.mm); // in its bore
    else if (plan.solid) off.multiplyScalar(n > 1 ? BORE * Math.min(sizes.radius, 0.28 * sizes.lengths[edge]) : 0);
    else off.multiplyScalar(sizes.radius + 0.8 * sizes.cord);
    const [a, b] = plan.edges[edge], gap = sizes.gap[edge];
    const low = nodes[a].clone().addScaledVector(axis, gap).add(off);
    const high = nodes[b].clone().addScaledVector(axis, -gap).add(off);
    return half & 1 ? {from: high, to: low, along: axis.clone().negate()} : {from: low, to: high, along: axis.clone()};
  });
}

// Centre line of step i: the curve from where the step before arrived (or from the node where the cord starts), then the lane; a
// last one goes on to the node where the cord ends. segments: of the curve.
export function centreLine(plan, nodes, sizes, lane, i, segments) {
  const step = plan.steps[i], cord = plan.cords[step.cord], {from, to, along} = lane[i];
  const points = [], reach = (edge) => 0.75 * sizes.gap[edge];
  const lift = (node, near) => nodes[node].clone().add(near.clone().sub(nodes[node]).multiplyScalar(0.25));
  let start, pull;
  if (step.i > 0 && !step.begins) {
    const before = lane[i - 1];
    start = before.to;
    pull = start.clone().addScaledVector(before.along, reach(plan.steps[i - 1].edge));
  } else if (step.begins && step.left) { // from where the right needle began, the other way
    const other = lane[cord.first];
    start = other.from;
    pull = start.clone().addScaledVector(other.along, -reach(plan.steps[cord.first].edge));
  } else {
    start = lift(plan.tail(step.half), from);
    pull = start.clone().lerp(from, 0.3);
  }
  const push = from.clone().addScaledVector(along, -reach(step.edge));
  for (let s = 0; s <= segments; s++) {
    const t = s / segments, u = 1 - t;
    points.push(new Vector3().addScaledVector(start, u * u * u).addScaledVector(pull, 3 * u * u * t)
      .addScaledVector(push, 3 * u * t * t).addScaledVector(from, t * t * t));
  }
  points.push(to.clone());
  if (step.k === (step.left ? 0 : cord.half.length - 1)) points.push(lift(plan.head(step.half), to));
  return points;
}

// Tubes of many centre lines in one mesh: positions, normals, indices, and where each line's vertices and indices end. Rings are
// carried along without twist; the first and the last of all are closed by a ring without width.
export function tubes(lines, radius, sides) {
  const count = lines.reduce((sum, line) => sum + line.length, 2), quads = count - lines.length;
  const position = new Float32Array(3 * sides * count), normal = new Float32Array(3 * sides * count);
  const index = new Uint32Array(6 * sides * quads);
  const vertexEnd = new Uint32Array(lines.length), indexEnd = new Uint32Array(lines.length);
  let vertex = 0, at = 0;
  const tangent = new Vector3(), side = new Vector3(), up = new Vector3(), n = new Vector3();
  lines.forEach((line, l) => {
    const rings = line.map((_, p) => [p, radius]);
    if (l === 0) rings.unshift([0, 0]);
    if (l === lines.length - 1) rings.push([line.length - 1, 0]);
    rings.forEach(([p, wide], ring) => {
      const point = line[p];
      tangent.subVectors(line[Math.min(p + 1, line.length - 1)], line[Math.max(p - 1, 0)]).normalize();
      up.copy(across(tangent, ring ? up : new Vector3(0.31, 0.17, 0.93)));
      side.crossVectors(tangent, up);
      for (let s = 0; s < sides; s++) {
        const angle = (2 * Math.PI * s) / sides;
        n.copy(up).multiplyScalar(Math.cos(angle)).addScaledVector(side, Math.sin(angle));
        normal.set([n.x, n.y, n.z], 3 * (vertex + s));
        position.set([point.x + wide * n.x, point.y + wide * n.y, point.z + wide * n.z], 3 * (vertex + s));
        if (ring === 0) continue;
        const a = vertex + s - sides, b = vertex + ((s + 1) % sides) - sides;
        index.set([a, b, a + sides, b, b + sides, a + sides], at);
        at += 6;
      }
      vertex += sides;
    });
    vertexEnd[l] = vertex;
    indexEnd[l] = at;
  });
  return {position, normal, index, vertexEnd, indexEnd};
}

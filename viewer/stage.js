// The picture in space: pieces, cords, feet, the camera. Draws only when something changed.
import {
  AmbientLight, BackSide, BufferAttribute, BufferGeometry, CircleGeometry, Color, ConeGeometry, CylinderGeometry, DirectionalLight, Fog, Group, InstancedMesh,
  LatheGeometry, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, PerspectiveCamera, Quaternion, Raycaster, Scene,
  Sphere, SphereGeometry, Vector2, Vector3, WebGLRenderer,
} from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import {bytesOf, startOf} from './plan.js';
import {across, centreLine, frames, lanes, sizesOf, tubes} from './strands.js';

// A dark rim around a mesh, so that no colour of a cord fades into a piece or the page: its far side, wider by so much.
function lined(mesh, material) {
  mesh.add(new Mesh(mesh.geometry, material));
  mesh.children[0].frustumCulled = false;
  return mesh;
}

function rimMaterial(width) {
  const material = new MeshBasicMaterial({side: BackSide});
  material.onBeforeCompile = (shader) => {
    const wider = `vec3 transformed = position + ${width.toExponential()} * normal;`;
    shader.vertexShader = shader.vertexShader.replace('#include <begin_vertex>', wider);
  };
  return material;
}

// A flat list of coordinates as points.
const points = (list) => Array.from({length: list.length / 3}, (_, v) => new Vector3(...list.slice(3 * v, 3 * v + 3)));

// Coarser shapes for more pieces or passes, so that the picture moves fluently.
const detailOf = (count) => (count < 700 ? 0 : count < 6000 ? 1 : 2);

export class Stage {
  constructor(plan, canvas, onView) {
    this.plan = plan;
    this.canvas = canvas;
    this.onView = onView;
    this.nodes = plan.nodes.map((p) => new Vector3(...p));
    this.sizes = sizesOf(plan, this.nodes);
    this.frame = frames(plan, this.nodes);
    this.lane = plan.moves ? [] : lanes(plan, this.nodes, this.sizes, this.frame);
    this.reach = plan.moves ? this.reachOf(plan.moves) : this.nodes; // all places that the picture has room for
    this.renderer = new WebGLRenderer({canvas, antialias: true});
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.scene = new Scene();
    this.scene.fog = new Fog(0xffffff); // the far side of a shell is paler
    this.camera = new PerspectiveCamera(38, 1, 0.1, 100);
    this.camera.up.set(0, 0, 1);
    this.scene.add(this.camera, new AmbientLight(0xffffff, 1.9));
    const lamp = new DirectionalLight(0xffffff, 1.7);
    lamp.position.set(-0.5, 0.8, 1);
    this.camera.add(lamp);
    this.centre = this.nodes.reduce((sum, p) => sum.add(p), new Vector3()).divideScalar(this.nodes.length || 1);
    this.addPieces();
    this.addFeet();
    this.rim = rimMaterial(0.28 * this.sizes.cord);
    this.addCords();
    this.addNeedle();
    if (plan.moves?.poses) this.addGround();
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.request());
    this.resize();
    this.reset();
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    canvas.addEventListener('webglcontextrestored', () => this.request());
  }

  // All places of what moves.
  reachOf({frames, words, pose}) {
    const {mm} = this.plan.kit ?? {};
    return frames ? frames.flatMap(points) : words.flatMap((_, f) => this.nodes.map((_, v) => new Vector3(...pose(f, v)).divideScalar(mm)));
  }

  // What hands pick up: solid pieces are hubs with arms, through which one sees the cords; tubes are barrels.
  addPieces() {
    const {plan} = this;
    this.parts = []; // meshes of many like parts, and of each part its piece and where it is
    this.partsOf = plan.pieces.map(() => []);
    this.tips = plan.pieces.map(() => []); // ends of its arms, from its middle
    if (plan.kit) this.addKit();
    else if (plan.solid) this.addSolid();
    else this.addTubes();
    this.place = plan.pieces.map((_, i) => (plan.solid ? this.nodePlace(i) : this.edgePlace(i)));
  }

  nodePlace(v) {
    const middle = this.nodes[v], out = new Vector3(...this.plan.outward[v]);
    if (out.lengthSq() < 1e-3) out.subVectors(middle, this.centre);
    return {middle, out: out.lengthSq() > 1e-12 ? out.normalize() : out.set(0, 0, 1)};
  }

  edgePlace(e) {
    const [a, b] = this.plan.edges[e];
    return {middle: this.nodes[a].clone().lerp(this.nodes[b], 0.5), out: this.frame[e].out};
  }

  // matrix: of each part {piece, middle, turn, scale}.
  addParts(shape, material, matrix) {
    const mesh = new InstancedMesh(shape, material, matrix.length), at = new Matrix4();
    matrix.forEach(({piece, middle, turn, scale}, i) => {
      mesh.setMatrixAt(i, at.compose(middle, turn, scale));
      this.partsOf[piece].push([this.parts.length, i]);
    });
    mesh.setColorAt(0, new Color());
    this.parts.push({mesh, matrix});
    this.scene.add(mesh);
    return mesh;
  }

  // Only the nearest faces of translucent parts are blended, once: a first mesh of the same parts fills the depths alone.
  addTranslucent(shape, material, matrix) {
    const mesh = this.addParts(shape, material, matrix);
    const depth = new InstancedMesh(shape, new MeshBasicMaterial({colorWrite: false, transparent: true}), matrix.length);
    depth.instanceMatrix = mesh.instanceMatrix;
    [depth.renderOrder, mesh.renderOrder] = [1, 2];
    depth.frustumCulled = mesh.frustumCulled = false;
    this.scene.add(depth);
  }

  addSolid() {
    const {plan, sizes, nodes} = this, detail = detailOf(plan.edges.length), up = new Vector3(0, 1, 0), arms = [];
    const material = new MeshLambertMaterial({transparent: true, opacity: 0.5});
    const widest = new Float64Array(nodes.length);
    plan.edges.forEach((ends, e) => {
      const radius = Math.min(sizes.radius, 0.28 * sizes.lengths[e]), length = Math.max(0.5 * sizes.lengths[e] - 0.02 * sizes.pitch, 0.1 * radius);
      ends.forEach((v, side) => {
        const axis = this.frame[e].axis.clone().multiplyScalar(side ? -1 : 1);
        const middle = nodes[v].clone().addScaledVector(axis, 0.5 * length);
        this.tips[v].push(axis.clone().multiplyScalar(length));
        arms.push({piece: v, middle, turn: new Quaternion().setFromUnitVectors(up, axis), scale: new Vector3(radius, length, radius)});
        widest[v] = Math.max(widest[v], radius);
      });
    });
    const hubs = nodes.map((middle, piece) => {
      const radius = 1.08 * (widest[piece] || sizes.radius);
      return {piece, middle, turn: new Quaternion(), scale: new Vector3(radius, radius, radius)};
    });
    const sides = [16, 10, 6][detail];
    this.addTranslucent(new CylinderGeometry(1, 1, 1, sides), material, arms);
    this.addTranslucent(new SphereGeometry(1, sides, Math.max(sides >> 1, 4)), material, hubs);
    this.addHand();
  }

  // The pieces as they are made: a mesh for each kind, turned and put in its places; and what is seen through what.
  addKit() {
    const {plan} = this, {mm, meshes, pieces} = plan.kit, unit = 1 / mm;
    const material = new MeshLambertMaterial({transparent: true, opacity: plan.moves ? 0.62 : 0.4}); // what moves is told apart by its gaps
    pieces.forEach(([mesh, ...numbers], piece) => {
      const ends = plan.solid ? plan.edges.filter((edge) => edge.includes(piece)).map((edge) => [piece, edge[0] + edge[1] - piece]) : [plan.edges[piece]];
      for (const [a, b] of ends) this.tips[piece].push(this.nodes[b].clone().sub(this.nodes[a]).multiplyScalar(0.5));
      const [a, b, c, d, e, f, g, h, i, ...middle] = numbers, turn = new Quaternion();
      turn.setFromRotationMatrix(new Matrix4().set(a, b, c, 0, d, e, f, 0, g, h, i, 0, 0, 0, 0, 1));
      const place = {piece, middle: new Vector3(...middle).multiplyScalar(unit), turn, scale: new Vector3(unit, unit, unit)};
      (meshes[mesh].places ??= []).push(place);
    });
    meshes.forEach(({low, step, points, triangles, places}) => {
      const shape = new BufferGeometry(), whole = new Uint16Array(bytesOf(points));
      shape.setAttribute('position', new BufferAttribute(Float32Array.from(whole, (x, k) => low[k % 3] + step * x), 3));
      shape.setIndex(new BufferAttribute(new Uint32Array(bytesOf(triangles)), 1));
      shape.computeVertexNormals();
      this.addTranslucent(shape, material, places);
    });
    this.addHand();
  }

  addHand() {
    this.hand = new Group();
    this.handMaterial = new MeshLambertMaterial({transparent: true, opacity: 0.5, depthTest: false, fog: false});
    this.scene.add(this.hand);
  }

  // The solid piece in hand once more, seen through all that lies before it.
  hold(piece) {
    if (!this.hand) return;
    this.hand.clear();
    this.handMaterial.color.copy(this.theme.now);
    for (const [p, i] of piece < 0 ? [] : this.partsOf[piece]) {
      const mesh = new Mesh(this.parts[p].mesh.geometry, this.handMaterial);
      this.parts[p].mesh.getMatrixAt(i, mesh.matrix);
      mesh.matrixAutoUpdate = false;
      mesh.renderOrder = 2.5;
      this.hand.add(mesh);
    }
  }

  addTubes() {
    const {plan, sizes} = this;
    // a barrel of length and radius 1, closed by caps that are half round on a tube of usual length
    const cap = Math.min(0.3, (0.7 * sizes.radius) / (0.56 * sizes.pitch)), outline = [];
    const detail = detailOf(plan.edges.length), rings = [5, 2, 2][detail];
    for (let i = 0; i <= rings; i++) {
      const angle = (0.5 * Math.PI * i) / rings;
      outline.push(new Vector2(Math.sin(angle), -0.5 + cap * (1 - Math.cos(angle))));
    }
    const shape = new LatheGeometry([...outline, ...outline.map((p) => new Vector2(p.x, -p.y)).reverse()], [16, 8, 6][detail]);
    this.addParts(shape, new MeshLambertMaterial(), plan.edges.map((_, piece) => this.tubeAt(piece)));
    plan.edges.forEach(([a, b], piece) => {
      const middle = this.nodes[a].clone().lerp(this.nodes[b], 0.5);
      for (const end of [a, b]) this.tips[piece].push(this.nodes[end].clone().sub(middle));
    });
  }

  // Where a tube is between its nodes as they are now. Of a motion, bars nearly meet, and cord without a bead is thin.
  tubeAt(piece) {
    const {sizes, nodes, plan} = this, [a, b] = plan.edges[piece], bare = plan.moves?.cables.includes(piece);
    const axis = nodes[b].clone().sub(nodes[a]), whole = axis.length(), middle = nodes[a].clone().lerp(nodes[b], 0.5);
    const radius = Math.min(sizes.radius, 0.28 * sizes.lengths[piece]) * (bare ? 0.15 : plan.moves ? 0.5 : 1), length = whole - (bare ? 0 : plan.moves ? radius : 2 * sizes.gap[piece]);
    const turn = new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), whole > 0 ? axis.normalize() : this.frame[piece].axis);
    return {piece, middle, turn, scale: new Vector3(radius, Math.max(length, 0.4 * radius), radius)};
  }

  // The level ground, the shadows of all pieces flat on it, as if light came from the side, and a tube for every part of the cords.
  addGround() {
    const {plan, sizes} = this, {floor, cords} = plan.moves, z = floor / plan.kit.mm, {center, radius} = new Sphere().setFromPoints(this.reach);
    this.ground = new Mesh(new CircleGeometry(1.25 * radius + sizes.pitch, 64), new MeshBasicMaterial({polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 4}));
    this.ground.position.set(center.x, center.y, z);
    this.shadow = new MeshBasicMaterial();
    this.scene.add(this.ground);
    for (const {mesh} of this.parts) {
      const shade = new InstancedMesh(mesh.geometry, this.shadow, mesh.count);
      shade.instanceMatrix = mesh.instanceMatrix;
      shade.frustumCulled = shade.matrixAutoUpdate = false;
      shade.matrix.set(1, 0, 0.35, -0.35 * z, 0, 1, 0.2, -0.2 * z, 0, 0, 0, z, 0, 0, 0, 1);
      this.scene.add(shade);
    }
    this.spans = cords.flatMap((cord) => cord.slice(1).map((to, i) => [cord[i], to]).concat([null])); // the last point has a tension, unused
    this.strings = new InstancedMesh(new CylinderGeometry(1, 1, 1, 8), new MeshBasicMaterial(), this.spans.length);
    this.strings.frustumCulled = false;
    this.scene.add(this.strings);
    this.colours = plan.moves.colours.map((colour) => new Color(colour));
  }

  // Shows a frame of pieces that move with their cords.
  showPoses(number) {
    const {plan, nodes, sizes, strings} = this, {moves, kit} = plan, at = new Matrix4(), up = new Vector3(0, 1, 0);
    const turns = nodes.map((node, v) => {
      const [x, y, z, ...turn] = moves.pose(number, v);
      node.set(x, y, z).divideScalar(kit.mm);
      return new Quaternion(...turn).normalize();
    });
    for (const {mesh, matrix} of this.parts) {
      matrix.forEach(({piece, turn, scale}, i) => {
        mesh.setMatrixAt(i, at.compose(nodes[piece], turns[piece].clone().multiply(turn), scale));
        mesh.setColorAt(i, this.theme.held);
      });
      mesh.instanceMatrix.needsUpdate = mesh.instanceColor.needsUpdate = true;
      mesh.boundingSphere = null;
    }
    const place = ([piece, ...from]) => {
      const point = new Vector3(...from).divideScalar(kit.mm);
      return piece < 0 ? point : point.applyQuaternion(turns[piece]).add(nodes[piece]);
    };
    const turn = new Quaternion(), size = new Vector3(), radius = Math.max(sizes.cord, 0.012 * sizes.pitch);
    this.spans.forEach((span, i) => {
      if (!span) {
        strings.setMatrixAt(i, at.makeScale(0, 0, 0));
        return;
      }
      const [from, to] = span.map(place), axis = to.clone().sub(from), length = axis.length();
      turn.setFromUnitVectors(up, length > 0 ? axis.divideScalar(length) : up);
      strings.setMatrixAt(i, at.compose(from.lerp(to, 0.5), turn, size.set(radius, length + 0.5 * radius, radius)));
      strings.setColorAt(i, this.colours[moves.tension[number * this.spans.length + i]]);
    });
    strings.instanceMatrix.needsUpdate = strings.instanceColor.needsUpdate = true;
    for (const mesh of [this.current, this.arrow, this.ball]) mesh.visible = false;
    this.request();
  }

  // Shows a frame of a motion.
  showFrame(number) {
    if (this.plan.moves.poses) {
      this.showPoses(number);
      return;
    }
    const {plan, nodes} = this, at = new Matrix4();
    points(plan.moves.frames[number]).forEach((p, v) => nodes[v].copy(p));
    for (const part of this.parts) {
      part.matrix = plan.edges.map((_, piece) => this.tubeAt(piece));
      part.matrix.forEach(({piece, middle, turn, scale}, i) => {
        part.mesh.setMatrixAt(i, at.compose(middle, turn, scale));
        part.mesh.setColorAt(i, this.theme[plan.moves.cables.includes(piece) ? 'now' : 'held']);
      });
      part.mesh.instanceMatrix.needsUpdate = part.mesh.instanceColor.needsUpdate = true;
      part.mesh.boundingSphere = null;
      part.mesh.frustumCulled = false;
    }
    if (this.feet) this.uncover(-1);
    for (const mesh of [this.current, this.arrow, this.ball]) mesh.visible = false;
    this.request();
  }

  addFeet() {
    const {plan, sizes} = this;
    if (!plan.feet.length || (plan.kit && plan.solid)) return; // a kit's feet have their bases
    const pad = new CylinderGeometry(1.5 * sizes.radius, 2.1 * sizes.radius, 1.2 * sizes.radius, 20).rotateX(Math.PI / 2);
    this.feet = new InstancedMesh(pad, new MeshLambertMaterial(), plan.feet.length);
    this.uncover(-1);
    this.scene.add(this.feet);
  }

  // The pads under the feet, but for that of the piece in hand, which it would hide from below.
  uncover(now) {
    const at = new Matrix4();
    this.plan.feet.forEach((v, i) => {
      const p = this.nodes[v];
      at.makeTranslation(p.x, p.y, p.z - 1.6 * this.sizes.radius);
      if (this.plan.solid && v === now) at.makeScale(0, 0, 0);
      this.feet.setMatrixAt(i, at);
    });
    this.feet.instanceMatrix.needsUpdate = true;
  }

  addCords() {
    const {plan, sizes, lane} = this, detail = detailOf(plan.steps.length);
    const material = new MeshBasicMaterial({vertexColors: true}); // no shading: exactly the colours of the captions
    this.cords = plan.cords.map((cord) => {
      const lines = cord.half.map((_, k) => centreLine(plan, this.nodes, sizes, lane, cord.first + k, [10, 5, 3][detail]));
      const tube = tubes(lines, sizes.cord, [7, 4, 4][detail]), geometry = new BufferGeometry();
      geometry.setAttribute('position', new BufferAttribute(tube.position, 3));
      geometry.setAttribute('normal', new BufferAttribute(tube.normal, 3));
      geometry.setAttribute('color', new BufferAttribute(new Float32Array(tube.position.length), 3));
      geometry.setIndex(new BufferAttribute(tube.index, 1));
      const mesh = lined(new Mesh(geometry, material), this.rim);
      mesh.frustumCulled = false;
      this.scene.add(mesh);
      return {mesh, tube, painted: ''};
    });
  }

  // The pass under way: thicker, with an arrow; and a ball where the needle is.
  addNeedle() {
    this.needleMaterial = new MeshBasicMaterial({fog: false});
    this.current = new Mesh(new BufferGeometry(), this.needleMaterial);
    this.arrow = new Mesh(new ConeGeometry(3.4 * this.sizes.cord, 9 * this.sizes.cord, 18), this.needleMaterial);
    this.ball = new Mesh(new SphereGeometry(2.1 * this.sizes.cord, 18, 12), this.needleMaterial);
    if (this.plan.inside) Object.assign(this.needleMaterial, {transparent: true, depthTest: false}); // seen through all pieces
    for (const mesh of [this.current, this.arrow, this.ball]) {
      lined(mesh, this.rim).frustumCulled = false;
      if (this.plan.inside) mesh.renderOrder = 3;
      this.scene.add(mesh);
    }
  }

  // Colours of the page: bare, held, now, next, foot, rim, paper as CSS colours.
  setTheme(colours) {
    this.theme = Object.fromEntries(Object.entries(colours).map(([name, css]) => [name, new Color(css)]));
    if (this.plan.kit) this.theme.bare.lerp(this.theme.next, 0.4); // else empty pieces fade into the page
    this.renderer.setClearColor(this.theme.paper);
    this.scene.fog.color.copy(this.theme.paper);
    this.rim.color.copy(this.theme.rim);
    if (this.feet) this.feet.material.color.copy(this.theme.foot);
    if (this.ground) {
      this.ground.material.color.copy(this.theme.paper).lerp(this.theme.foot, 0.2);
      this.shadow.color.copy(this.ground.material.color).multiplyScalar(0.75);
    }
    this.request();
  }

  paint(c, colours) {
    const {plan} = this, {mesh, tube} = this.cords[c], key = colours.join();
    if (this.cords[c].painted === key) return;
    this.cords[c].painted = key;
    const attribute = mesh.geometry.getAttribute('color'), colour = new Color();
    let vertex = 0;
    tube.vertexEnd.forEach((end, i) => {
      colour.set(colours[plan.steps[plan.cords[c].first + i].k % colours.length]);
      for (; vertex < end; vertex++) attribute.setXYZ(vertex, colour.r, colour.g, colour.b);
    });
    attribute.needsUpdate = true;
  }

  // Shows the plan with so many steps done. colours(c): of a cord's passes; hidden: set of cords; current: colour of the pass.
  show(done, colours, hidden, current) {
    const {plan} = this, held = new Uint8Array(plan.pieces.length);
    for (let i = 0; i < done; i++) {
      const start = startOf(plan, plan.steps[i]);
      held[plan.steps[i].piece] = 1;
      if (start >= 0) held[start] = 1;
    }
    const now = done ? plan.steps[done - 1].piece : -1, next = done < plan.steps.length ? plan.steps[done].piece : -1;
    for (const {mesh, matrix} of this.parts) {
      matrix.forEach(({piece}, i) => {
        const look = piece === now ? 'now' : piece === next ? 'next' : held[piece] ? 'held' : 'bare';
        mesh.setColorAt(i, this.theme[look]);
      });
      mesh.instanceColor.needsUpdate = true;
    }
    this.swell(now);
    this.hold(now);
    if (this.feet) this.uncover(now);
    this.cords.forEach(({mesh, tube}, c) => {
      const passes = Math.min(Math.max(done - plan.cords[c].first, 0), plan.cords[c].half.length);
      mesh.visible = passes > 0 && !hidden.has(c);
      mesh.geometry.setDrawRange(0, passes ? tube.indexEnd[passes - 1] : 0);
      if (mesh.visible) this.paint(c, colours(c));
    });
    this.showNeedle(done, current, hidden);
    this.request();
    return {now, next};
  }

  // The piece in hand is a little thicker.
  swell(wanted) {
    const at = new Matrix4(), set = (piece, factor) => {
      for (const [p, i] of this.partsOf[piece]) {
        const {mesh, matrix} = this.parts[p], {middle, turn, scale} = matrix[i];
        mesh.setMatrixAt(i, at.compose(middle, turn, new Vector3(scale.x * factor, this.plan.kit ? scale.y * factor : scale.y, scale.z * factor)));
      }
    };
    if (this.swollen >= 0) set(this.swollen, 1);
    if (wanted >= 0) set(wanted, 1.12);
    this.swollen = wanted;
    for (const {mesh} of this.parts) mesh.instanceMatrix.needsUpdate = true;
  }

  showNeedle(done, colour, hidden) {
    const {plan, sizes} = this, visible = done > 0 && !hidden.has(plan.steps[done - 1].cord);
    for (const mesh of [this.current, this.arrow, this.ball]) mesh.visible = visible;
    if (!visible) return;
    const i = done - 1, {from, to, along} = this.lane[i], line = centreLine(plan, this.nodes, sizes, this.lane, i, 12);
    const tube = tubes([line], 1.7 * sizes.cord, 10), geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(tube.position, 3));
    geometry.setAttribute('normal', new BufferAttribute(tube.normal, 3));
    geometry.setIndex(new BufferAttribute(tube.index, 1));
    this.current.geometry.dispose();
    this.current.geometry = geometry;
    this.current.children[0].geometry = geometry;
    this.arrow.position.copy(from).lerp(to, 0.68);
    this.arrow.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), along);
    this.ball.position.copy(line[line.length - 1]);
    this.needleMaterial.color.set(colour);
  }

  // ---- the camera ----

  reset() {
    const sphere = new Sphere().setFromPoints(this.reach), size = new Vector3(), low = new Vector3(Infinity, Infinity, Infinity);
    const high = low.clone().negate();
    for (const p of this.reach) low.min(p), high.max(p);
    size.subVectors(high, low);
    const flat = size.z < 0.1 * Math.hypot(size.x, size.y), view = flat ? new Vector3(0, -0.35, 1) : new Vector3(0.45, -1, 0.75);
    this.middle = sphere.center;
    this.radius = sphere.radius;
    const {target, far} = this.showAll(view.normalize());
    this.camera.near = Math.min(0.01 * far, 0.2 * this.sizes.pitch);
    this.camera.far = 6 * far + 4 * sphere.radius;
    this.camera.updateProjectionMatrix();
    this.controls.minDistance = 0.8 * this.sizes.pitch;
    this.controls.maxDistance = 5 * far;
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(view, far);
    this.controls.update();
    this.request();
  }

  // Target and distance at which all nodes fill the picture, looking against the unit vector view.
  showAll(view) {
    const right = across(view, new Vector3(-view.y, view.x, 0)), up = new Vector3().crossVectors(view, right);
    const high = 0.9 * Math.tan((this.camera.fov * Math.PI) / 360), wide = high * this.camera.aspect;
    const room = this.ground ? 0.6 * this.sizes.pitch : 2 * this.sizes.radius; // pieces reach beyond their middles
    const arms = this.reach.map((node) => node.clone().sub(this.middle));
    const centre = (axis) => {
      const along = arms.map((arm) => arm.dot(axis));
      return (along.reduce((a, b) => Math.max(a, b)) + along.reduce((a, b) => Math.min(a, b))) / 2;
    };
    const shift = right.clone().multiplyScalar(centre(right)).addScaledVector(up, centre(up));
    const far = arms.reduce((most, arm) => {
      arm.sub(shift);
      const need = Math.max((Math.abs(arm.dot(right)) + room) / wide, (Math.abs(arm.dot(up)) + room) / high);
      return Math.max(most, need + arm.dot(view));
    }, this.sizes.pitch);
    return {target: this.middle.clone().add(shift), far};
  }

  turn(right, up) {
    const {camera, controls} = this, arm = camera.position.clone().sub(controls.target), z = new Vector3(0, 0, 1);
    arm.applyAxisAngle(z, right);
    const tilt = arm.angleTo(z), wanted = Math.min(Math.max(tilt - up, 0.02), Math.PI - 0.02);
    const axis = new Vector3().crossVectors(z, arm);
    if (axis.lengthSq() > 0) arm.applyAxisAngle(axis.normalize(), wanted - tilt);
    camera.position.copy(controls.target).add(arm);
    controls.update();
  }

  move(right, up) {
    const {camera, controls} = this, reach = 0.1 * camera.position.distanceTo(controls.target);
    const by = new Vector3(right * reach, up * reach, 0).applyQuaternion(camera.quaternion);
    camera.position.add(by);
    controls.target.add(by);
    controls.update();
  }

  zoom(factor) {
    const {camera, controls} = this, arm = camera.position.clone().sub(controls.target);
    const length = Math.min(Math.max(arm.length() * factor, controls.minDistance), controls.maxDistance);
    camera.position.copy(controls.target).add(arm.setLength(length));
    controls.update();
  }

  // From where a piece is so many pixels long in the picture, as a thumb is wide.
  near(piece, view) {
    const THUMB = 150, {camera, canvas} = this, right = across(view, new Vector3(-view.y, view.x, 0)), up = new Vector3().crossVectors(view, right);
    const span = (axis) => {
      const along = [0, ...this.tips[piece].map((tip) => tip.dot(axis))];
      return along.reduce((a, b) => Math.max(a, b)) - along.reduce((a, b) => Math.min(a, b));
    };
    const length = Math.max(span(right), span(up)) + 2 * this.sizes.radius, size = (canvas.clientHeight * length) / THUMB;
    return Math.max(size / (2 * Math.tan((camera.fov * Math.PI) / 360)), 2 * length);
  }

  // Looks at a piece from outside, near enough to see it well and some of its neighbours.
  face(piece, still) {
    const {camera, controls, sizes} = this, {middle, out} = this.place[piece], view = out.clone();
    if (Math.abs(view.z) > 0.97) view.y -= 0.3; // from straight above the picture would spin
    const far = Math.min(9 * sizes.pitch, 2.5 * this.radius + 3 * sizes.pitch, this.near(piece, view.normalize()));
    const goal = middle.clone().addScaledVector(view, Math.max(far, this.controls.minDistance));
    cancelAnimationFrame(this.flight);
    if (still) {
      camera.position.copy(goal);
      controls.target.copy(middle);
      controls.update();
      return;
    }
    const arm = camera.position.clone().sub(controls.target), target = controls.target.clone(), begun = performance.now();
    const goalArm = goal.sub(middle), length = arm.length();
    const fly = (time) => {
      const t = Math.min(1, (time - begun) / 350), s = t * t * (3 - 2 * t);
      controls.target.lerpVectors(target, middle, s);
      const way = arm.clone().normalize().lerp(goalArm.clone().normalize(), s);
      if (way.lengthSq() < 1e-4) way.copy(across(arm.clone().normalize(), new Vector3(0, 0, 1)));
      camera.position.copy(controls.target).addScaledVector(way.normalize(), length + (goalArm.length() - length) * s);
      controls.update();
      if (t < 1) this.flight = requestAnimationFrame(fly);
    };
    this.flight = requestAnimationFrame(fly);
  }

  // Where a point is in the picture, in CSS pixels; depth > 1: behind the viewer.
  project(point) {
    const p = point.clone().project(this.camera), {clientWidth, clientHeight} = this.canvas;
    return {x: ((p.x + 1) / 2) * clientWidth, y: ((1 - p.y) / 2) * clientHeight, depth: p.z};
  }

  // The piece under a point of the canvas (CSS pixels), or -1.
  pick(x, y) {
    const {clientWidth, clientHeight} = this.canvas, ray = new Raycaster();
    ray.setFromCamera(new Vector2((2 * x) / clientWidth - 1, 1 - (2 * y) / clientHeight), this.camera);
    const hit = ray.intersectObjects(this.parts.map(({mesh}) => mesh), false)[0];
    return hit ? this.parts.find(({mesh}) => mesh === hit.object).matrix[hit.instanceId].piece : -1;
  }

  resize() {
    const {clientWidth, clientHeight} = this.canvas.parentElement;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.request();
  }

  request() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      const far = this.camera.position.distanceTo(this.middle);
      this.scene.fog.near = far;
      this.scene.fog.far = far + 2.2 * this.radius;
      this.renderer.render(this.scene, this.camera);
      this.onView();
    });
  }
}

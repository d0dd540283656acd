// The framework as a picture that turns: arms from every piece to the middles of its edges, feet as squares, and the cords of a plan.

const CORD_COLOURS = ['#0072B2', '#D55E00', '#009E73', '#CC79A7', '#56B4E9', '#E69F00']; // as in the overview
const LONG_PRESS = 500; // ms

class Sketch {
  constructor(canvas, onPick) {
    this.canvas = canvas;
    this.onPick = onPick;
    this.turn = [-0.6, 0.95];
    this.zoom = 1;
    this.cords = []; // of each the nodes that it comes to
    this.picksByTap = false; // a finger picks without waiting
    new ResizeObserver(() => this.draw()).observe(canvas);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.draw());
    this.listen();
  }

  // cords: of each the nodes that it comes to, in their order.
  showCords(cords) {
    this.cords = cords;
    this.draw();
  }

  show(frame) {
    this.cords = [];
    const all = [0, 1, 2].map((k) => frame.nodes.map((p) => p[k]));
    this.frame = frame;
    this.middle = all.map((list) => (list.reduce((a, b) => Math.min(a, b)) + list.reduce((a, b) => Math.max(a, b))) / 2);
    this.size = Math.hypot(...all.map((list, k) => list.reduce((a, b) => Math.max(a, Math.abs(b - this.middle[k])), 0))) || 1;
    this.draw();
  }

  // Where a point is on the canvas, in CSS pixels, and how near it is.
  place(p) {
    const [x, y, z] = p.map((value, k) => (value - this.middle[k]) / this.size), [round, up] = this.turn;
    const across = x * Math.cos(round) - y * Math.sin(round), into = x * Math.sin(round) + y * Math.cos(round);
    const unit = 0.52 * this.zoom * Math.min(this.canvas.clientWidth, this.canvas.clientHeight) * 0.95;
    const high = z * Math.sin(up) + into * Math.cos(up);
    return [this.canvas.clientWidth / 2 + unit * across, this.canvas.clientHeight / 2 - unit * high, z * Math.cos(up) - into * Math.sin(up)];
  }

  draw() {
    const {canvas, frame} = this, scale = devicePixelRatio || 1;
    if (!frame || !canvas.clientWidth) return;
    canvas.width = canvas.clientWidth * scale;
    canvas.height = canvas.clientHeight * scale;
    const pen = canvas.getContext('2d'), style = getComputedStyle(document.documentElement);
    const colour = (name) => style.getPropertyValue(name).trim(), at = frame.nodes.map((p) => this.place(p)), feet = new Set(frame.feet || []);
    const lengths = frame.edges.map(([a, b]) => Math.hypot(at[a][0] - at[b][0], at[a][1] - at[b][1])).sort((a, b) => a - b);
    const wide = Math.min(Math.max(0.22 * (lengths[lengths.length >> 1] || 10), 1.5), 14);
    pen.scale(scale, scale);
    pen.lineCap = 'butt';
    const edges = frame.edges.map(([a, b]) => [a, b, at[a][2] + at[b][2]]).sort((p, q) => p[2] - q[2]);
    for (const [a, b] of edges)
      for (const [from, to] of [[at[a], at[b]], [at[b], at[a]]]) {
        const part = 0.47, end = [from[0] + part * (to[0] - from[0]), from[1] + part * (to[1] - from[1])];
        for (const [ink, width] of [[colour('--ink'), wide + 2], [colour('--piece'), wide]]) {
          pen.strokeStyle = ink;
          pen.lineWidth = width;
          pen.beginPath();
          pen.moveTo(from[0], from[1]);
          pen.lineTo(...end);
          pen.stroke();
        }
      }
    this.drawCords(pen, at);
    pen.fillStyle = colour('--foot');
    const half = Math.max(wide / 2 + 2, 5);
    for (const v of feet) pen.fillRect(at[v][0] - half, at[v][1] - half, 2 * half, 2 * half);
    this.drawNames(pen, [...feet].map((v) => at[v]), [...feet].map((v) => String(frame.names ? frame.names[v] : v)), half, colour('--soft'));
  }

  // The name of every foot beside, below or above it, where there is room between the other feet and the names before.
  drawNames(pen, at, names, half, halo) {
    const high = 15, taken = at.map(([x, y]) => [x - half, x + half, y]);
    pen.font = `600 ${high - 2}px system-ui, sans-serif`;
    pen.textBaseline = 'middle';
    pen.strokeStyle = halo;
    pen.lineWidth = 4;
    at.forEach(([x, y], i) => {
      const wide = pen.measureText(names[i]).width, aside = half + 3, over = half + high / 2 + 3;
      const isFree = ([left, level]) => left >= 0 && left + wide <= this.canvas.clientWidth && !taken.some(([from, to, other]) => left < to && left + wide > from && Math.abs(level - other) < high);
      const place = [[x + aside, y], [x - aside - wide, y], [x - wide / 2, y + over], [x - wide / 2, y - over]].find(isFree);
      if (!place) return;
      taken.push([place[0], place[0] + wide, place[1]]);
      pen.strokeText(names[i], ...place);
      pen.fillText(names[i], ...place);
    });
  }

  // Every pass in a lane of its own: the first in the middle of its edge, others left and right of it.
  drawCords(pen, at) {
    const lanes = new Map(), apart = 3.2;
    pen.lineWidth = 2.2;
    this.cords.forEach((nodes, i) => {
      pen.strokeStyle = CORD_COLOURS[i % CORD_COLOURS.length];
      pen.beginPath();
      for (let k = 1; k < nodes.length; k++) {
        const [a, b] = [Math.min(nodes[k - 1], nodes[k]), Math.max(nodes[k - 1], nodes[k])], key = `${a} ${b}`, lane = lanes.get(key) || 0;
        lanes.set(key, lane + 1);
        const [x, y] = [at[b][0] - at[a][0], at[b][1] - at[a][1]], far = Math.hypot(x, y) || 1;
        const aside = apart * Math.ceil(lane / 2) * (lane % 2 ? 1 : -1), [dx, dy] = [(-y / far) * aside, (x / far) * aside];
        pen.moveTo(at[a][0] + dx, at[a][1] + dy);
        pen.lineTo(at[b][0] + dx, at[b][1] + dy);
      }
      pen.stroke();
    });
  }

  pick(x, y) {
    let best = -1, far = 18;
    this.frame.nodes.forEach((p, v) => {
      const at = this.place(p), away = Math.hypot(at[0] - x, at[1] - y) - 1e-3 * at[2];
      if (away < far) [best, far] = [v, away];
    });
    return best;
  }

  listen() {
    const {canvas} = this;
    const fingers = new Map(); // where each is, by the number of its pointer
    const apart = () => {
      const [one, other = one] = fingers.values();
      return Math.hypot(one[0] - other[0], one[1] - other[1]);
    };
    let moved = 0, press = 0;
    const choose = (x, y) => {
      const v = this.frame ? this.pick(x, y) : -1;
      if (v >= 0) this.onPick(v);
    };
    canvas.addEventListener('pointerdown', (event) => {
      const {offsetX: x, offsetY: y} = event;
      fingers.set(event.pointerId, [event.clientX, event.clientY]);
      moved = fingers.size === 1 ? 0 : Infinity; // two fingers pick nothing
      canvas.setPointerCapture(event.pointerId);
      clearTimeout(press);
      if (event.pointerType === 'touch' && !this.picksByTap)
        press = setTimeout(() => {
          if (moved < 6) choose(x, y);
          moved = Infinity;
        }, LONG_PRESS);
    });
    canvas.addEventListener('pointermove', (event) => {
      const from = fingers.get(event.pointerId);
      if (!from) return;
      const before = apart(), [x, y] = [event.clientX - from[0], event.clientY - from[1]];
      moved += Math.abs(x) + Math.abs(y);
      fingers.set(event.pointerId, [event.clientX, event.clientY]);
      if (fingers.size === 1) this.rotate(0.008 * x, 0.008 * y);
      if (fingers.size === 2 && before) this.enlarge(apart() / before);
    });
    canvas.addEventListener('pointerup', (event) => {
      clearTimeout(press);
      if (fingers.has(event.pointerId) && moved < 6 && (event.pointerType !== 'touch' || this.picksByTap)) choose(event.offsetX, event.offsetY);
      fingers.delete(event.pointerId);
    });
    canvas.addEventListener('contextmenu', (event) => event.preventDefault()); // of a long press
    canvas.addEventListener('pointercancel', (event) => {
      clearTimeout(press); // the finger scrolls the page
      fingers.delete(event.pointerId);
    });
    canvas.addEventListener('wheel', (event) => {
      if (!event.ctrlKey && document.activeElement !== canvas) return; // it scrolls the page
      event.preventDefault();
      this.enlarge(Math.exp(-0.001 * event.deltaY));
    }, {passive: false});
    canvas.addEventListener('keydown', (event) => {
      const by = {ArrowLeft: [-0.15, 0], ArrowRight: [0.15, 0], ArrowUp: [0, -0.15], ArrowDown: [0, 0.15]}[event.key];
      const times = !event.ctrlKey && !event.metaKey && {'+': 1.25, '=': 1.25, '-': 0.8}[event.key]; // with Ctrl: the browser's own
      if (!by && !times) return;
      event.preventDefault();
      if (by) this.rotate(...by);
      else this.enlarge(times);
    });
  }

  enlarge(by) {
    this.zoom = Math.min(Math.max(this.zoom * by, 0.5), 8);
    this.draw();
  }

  rotate(round, up) {
    this.turn = [this.turn[0] + round, Math.min(Math.max(this.turn[1] + up, 0), Math.PI / 2)];
    this.draw();
  }
}

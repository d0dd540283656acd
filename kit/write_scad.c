/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the pieces of a kit as a programme for OpenSCAD, for those who want to change them: sizes
 * to choose at its top, modules that make an arm, a ball, a channel and a piece, then the data of
 * all kinds and places.
 *
 * Sizes in the data are parts of the width and of the bore at the top, lengths along arms and
 * channels are in mm. Curves of channels lose the points that they hardly need (D. Douglas and
 * T. Peucker, "Algorithms for the reduction of the number of points required to represent a
 * digitized line or its caricature", 1973), since OpenSCAD takes long over each.
 *
 * Example: `openscad -D 'show="X-7"' -D 'width=12' -o X-7.stl kit.scad`. */
#include "kit/files.h"

#include "graph/number.h"

#include <math.h>

/* mm by which a simpler curve may be off, as a part of its radius. */
static const double OFF = 0.06;

/* What the programme does with the data that follow it: the parts of pieces. */
static const char programme_of_parts[] =
    "// ---- from here on nothing needs to be changed ----\n"
    "\n"
    "// Width of an arm: its part of the width, but never less than its channels and walls.\n"
    "function arm_width(a) = max(a[3] * width, 2 * a[4] * bore + 2 * wall);\n"
    "function unit(v) = v / norm(v);\n"
    "\n"
    "// Stands children, which look along z, along a direction.\n"
    "module look(along, up) {\n"
    "  side = cross(up, along);\n"
    "  multmatrix([for (i = [0:2]) [side[i], up[i], along[i], 0]]) children();\n"
    "}\n"
    "\n"
    "// Everything beyond a plane, as far as a piece may reach.\n"
    "module beyond(normal, distance) {\n"
    "  rotate([0, acos(normal[2]), atan2(normal[1], normal[0])])\n"
    "    translate([-far, -far, distance]) cube(2 * far);\n"
    "}\n"
    "\n"
    "// The outline of an arm.\n"
    "module outline(w) {\n"
    "  if (profile == \"round\") circle(d = w);\n"
    "  else offset(w / 8)\n"
    "    if (profile == \"square\") square(0.75 * w, center = true);\n"
    "    else circle(r = 0.375 * w / cos(30), $fn = 6);\n"
    "}\n"
    "\n"
    "// A key on a face, with play if it is hollow.\n"
    "module key(play) {\n"
    "  r = key_radius + play;\n"
    "  h = min(key_height + play, r * key_slope);\n"
    "  translate([0, 0, -0.01]) cylinder(r1 = r, r2 = r - h / key_slope, h = h + 0.01);\n"
    "}\n"
    "\n"
    "// An arm: along, up, length, part of the width, reach of channels, key, tip, mitres.\n"
    "module arm(a) {\n"
    "  w = arm_width(a);\n"
    "  mitres = a[7];\n"
    "  long = len(mitres) > 0 ? a[2] + a[6] : a[2] - gap / 2;\n"
    "  difference() {\n"
    "    look(a[0], a[1]) {\n"
    "      linear_extrude(height = rounded ? long - w / 2 : long, scale = 1 / taper)\n"
    "        outline(w * taper);\n"
    "      if (rounded) translate([0, 0, long - w / 2]) sphere(d = w);\n"
    "      if (a[5] > 0) translate([0, 0, long]) key(0);\n"
    "    }\n"
    "    if (a[5] < 0) look(a[0], a[1]) translate([0, 0, long]) mirror([0, 0, 1]) key(key_play);\n"
    "    for (m = mitres) beyond(m[0], m[1] - gap / 2);\n"
    "  }\n"
    "}\n"
    "\n"
    "// The ball in the middle of a piece.\n"
    "module ball(part) {\n"
    "  sphere(r = part * width);\n"
    "}\n"
    "\n"
    "// The disc with a round rim that a foot stands on: how far below the node, radius.\n"
    "module foot(f) {\n"
    "  h = f[0] * width;\n"
    "  rim = 0.4 * h;\n"
    "  r = f[1] * width - rim;\n"
    "  translate([0, 0, -h]) rotate_extrude() intersection() {\n"
    "    square(r + rim);\n"
    "    union() { square([r, rim]); translate([r, 0]) circle(rim); }\n"
    "  }\n"
    "}\n"
    "\n"
    "// The bar that a cord is made fast to: its three points and its radius follow in a foot.\n"
    "module hook(f) {\n"
    "  for (i = [2, 3]) hull() for (p = [f[i], f[i + 1]])\n"
    "    translate(p * width) sphere(r = f[5] * width);\n"
    "}\n"
    "\n"
    "// Fills the corner between two arms, flat.\n"
    "module web(a, b) {\n"
    "  angle = acos(max(-1, min(a[0] * b[0], 1)));\n"
    "  w = min(arm_width(a), arm_width(b)) * taper;\n"
    "  at = w / 2 / tan(angle / 2) + 0.1 * w;\n"
    "  if (angle < 150 && at < min(a[2], b[2]) - w / 2)\n"
    "    hull() for (c = [a, b]) translate(at * c[0]) sphere(d = 0.98 * w, $fn = 16);\n"
    "}\n"
    "\n";

/* The same, of channels and whole pieces. */
static const char programme_of_pieces[] =
    "// A channel: part of the bore, points. It is a tube of rings, a bit longer at both ends.\n"
    "function tangents(p) = [for (i = [0:len(p) - 1])\n"
    "  unit((i > 0 ? unit(p[i] - p[i - 1]) : [0, 0, 0]) +\n"
    "       (i + 1 < len(p) ? unit(p[i + 1] - p[i]) : [0, 0, 0]))];\n"
    "function across(t) = abs(t[0]) < 0.6 ? [1, 0, 0] : [0, 1, 0];\n"
    "function sides(t, i, u) = i == len(t) ? [] :\n"
    "  let (v = unit(u - (u * t[i]) * t[i])) concat([v], sides(t, i + 1, v));\n"
    "module channel(c) {\n"
    "  r = c[0] * bore / 2;\n"
    "  t = tangents(c[1]);\n"
    "  last = len(t) - 1;\n"
    "  p = [for (i = [0:last]) c[1][i] + (i == 0 ? -r : i == last ? r : 0) * t[i]];\n"
    "  u = sides(t, 0, across(t[0]));\n"
    "  n = max(8, floor($fn / 2));\n"
    "  polyhedron(\n"
    "    [for (i = [0:last], k = [0:n - 1])\n"
    "      p[i] + r * (cos(360 * k / n) * u[i] + sin(360 * k / n) * cross(t[i], u[i]))],\n"
    "    concat([[for (k = [0:n - 1]) k]],\n"
    "      [for (i = [0:last - 1], k = [0:n - 1]) let (a = i * n + k, b = i * n + (k + 1) % n)\n"
    "        each [[a, a + n, b], [b, a + n, b + n]]],\n"
    "      [[for (k = [0:n - 1]) last * n + n - 1 - k]]));\n"
    "}\n"
    "\n"
    "// A kind by its name: name, arms, channels, pockets, part of the ball, foot.\n"
    "module piece(name) {\n"
    "  k = kinds[search([name], kinds)[0]];\n"
    "  arms = k[1];\n"
    "  difference() {\n"
    "    union() {\n"
    "      for (a = arms) arm(a);\n"
    "      if (k[4] > 0) ball(k[4]);\n"
    "      if (len(k[5]) > 0) foot(k[5]);\n"
    "      if (len(k[5]) > 2) hook(k[5]);\n"
    "      if (fillet && k[4] > 0)\n"
    "        for (i = [0:1:len(arms) - 2], j = [i + 1:len(arms) - 1]) web(arms[i], arms[j]);\n"
    "    }\n"
    "    for (c = k[2]) channel(c);\n"
    "    for (p = k[3]) hull() for (end = [0, 1]) translate(p[end]) sphere(r = p[2]);\n"
    "    if (len(k[5]) > 0) beyond([0, 0, -1], k[5][0] * width);\n"
    "  }\n"
    "}\n"
    "\n"
    "// All pieces where they belong.\n"
    "module assembled() {\n"
    "  for (p = places) multmatrix(p[2]) piece(p[1]);\n"
    "}\n"
    "\n"
    "if (show == \"assembled\") assembled();\n"
    "else piece(show);\n"
    "\n";

/* ---- data ---- */

/* Appends a number, rounded to a unit of 1 / scale. */
static void put_number(thr_text *out, double value, double scale)
{
  thr_text_double(out, nearbyint(value * scale) / scale);
}

/* Appends a vector. */
static void put_vector(thr_text *out, const double *v, int n, double scale)
{
  for (int k = 0; k < n; k++) {
    thr_text_append(out, k ? ", " : "[");
    put_number(out, v[k], scale);
  }
  thr_text_byte(out, ']');
}

/* Returns how far the channels of an arm reach from its axis. */
static double reach_of(const thr_kit_piece *piece, int arm)
{
  double reach = 0;
  for (int i = 0; i < piece->n_channels; i++) {
    const thr_kit_channel *channel = &piece->channel[i];
    for (int end = 0; end < 2; end++) {
      if ((end ? channel->out : channel->in) != arm) continue;
      const double *mouth = channel->point[end ? channel->n - 1 : 0];
      double up = thr_dot(mouth, piece->arm[arm].up), side = thr_dot(mouth, piece->arm[arm].side);
      reach = fmax(reach, hypot(up, side) + channel->radius);
    }
  }
  return reach;
}

/* Returns how far a point is from the line between two others. */
static double off_line(const double p[3], const double a[3], const double b[3])
{
  double d[3], e[3], normal[3];
  for (int k = 0; k < 3; k++) {
    d[k] = b[k] - a[k];
    e[k] = p[k] - a[k];
  }
  double length = thr_normalize(d);
  if (!(length > 0)) return sqrt(thr_dot(e, e));
  thr_cross(d, e, normal);
  return sqrt(thr_dot(normal, normal));
}

/* Appends the points after `from` up to `to`, without those that the curve hardly needs. */
static void put_curve(const thr_kit_channel *channel, int from, int to, thr_text *out)
{
  int farthest = -1;
  double most = OFF * channel->radius;
  for (int i = from + 1; i < to; i++) {
    double off = off_line(channel->point[i], channel->point[from], channel->point[to]);
    if (off <= most) continue;
    most = off;
    farthest = i;
  }
  if (farthest < 0) {
    thr_text_append(out, ", ");
    put_vector(out, channel->point[to], 3, 1e4);
    return;
  }
  put_curve(channel, from, farthest, out);
  put_curve(channel, farthest, to, out);
}

/* What the sizes at the top of the programme are. */
typedef struct {
  double width, bore, wall;
} top_sizes;

static top_sizes find_sizes(const thr_kit *kit)
{
  top_sizes top = {.width = kit->options.width, .wall = kit->options.wall};
  for (int p = 0; p < kit->n_pieces; p++) {
    const thr_kit_piece *piece = &kit->piece[p];
    for (int i = 0; i < piece->n_channels; i++)
      top.bore = fmax(top.bore, 2 * piece->channel[i].radius);
    for (int i = 0; i < piece->n_arms; i++)
      top.wall = fmin(top.wall, 0.5 * piece->arm[i].width - reach_of(piece, i));
  }
  /* Rounded down, so that walls make no arm wider than it is. */
  top.wall = fmax(floor(top.wall * 1e3) / 1e3, 0);
  return top;
}

/* Appends an arm. */
static void put_arm(const thr_kit *kit, const top_sizes *top, const thr_kit_piece *piece, int i,
                    thr_text *out)
{
  const thr_kit_arm *arm = &piece->arm[i];
  double gap = 0.5 * kit->options.gap;
  thr_text_append(out, "    [");
  put_vector(out, arm->along, 3, 1e8);
  thr_text_append(out, ", ");
  put_vector(out, arm->up, 3, 1e8);
  thr_text_append(out, ", ");
  put_number(out, arm->length + (arm->n_mitres ? 0 : gap), 1e4);
  thr_text_append(out, ", ");
  put_number(out, arm->width / top->width, 1e6);
  thr_text_append(out, ", ");
  put_number(out, reach_of(piece, i) / top->bore, 1e6);
  thr_text_printf(out, ", %d, ", piece->key == THR_KIT_NO_KEY ? 0 : arm->key_out ? 1 : -1);
  put_number(out, arm->tip, 1e4);
  thr_text_append(out, ", [");
  for (int k = 0; k < arm->n_mitres; k++) {
    thr_text_append(out, k ? ", [" : "[");
    put_vector(out, arm->mitre[k], 3, 1e8);
    thr_text_append(out, ", ");
    put_number(out, arm->mitre[k][3] + gap, 1e4);
    thr_text_append(out, "]");
  }
  thr_text_append(out, "]],\n");
}

/* Appends a kind. */
static void put_kind(const thr_kit *kit, const top_sizes *top, const thr_kit_piece *piece,
                     thr_text *out)
{
  thr_text_append(out, "  [");
  thr_text_json_string(out, kit->kind_name[piece->kind]);
  thr_text_append(out, ", [\n");
  for (int i = 0; i < piece->n_arms; i++)
    put_arm(kit, top, piece, i, out);
  thr_text_append(out, "  ], [\n");
  for (int i = 0; i < piece->n_channels; i++) {
    const thr_kit_channel *channel = &piece->channel[i];
    thr_text_append(out, "    [");
    put_number(out, 2 * channel->radius / top->bore, 1e6);
    thr_text_append(out, ", [");
    put_vector(out, channel->point[0], 3, 1e4);
    put_curve(channel, 0, channel->n - 1, out);
    thr_text_append(out, "]],\n");
  }
  thr_text_append(out, "  ], [");
  for (int i = 0; i < piece->n_pockets; i++) {
    thr_text_append(out, i ? ", [" : "[");
    put_vector(out, piece->pocket[i], 3, 1e4);
    thr_text_append(out, ", ");
    put_vector(out, piece->pocket[i] + 3, 3, 1e4);
    thr_text_append(out, ", ");
    put_number(out, piece->pocket[i][6], 1e4);
    thr_text_append(out, "]");
  }
  thr_text_append(out, "], ");
  put_number(out, piece->tube ? 0 : piece->node_radius / top->width, 1e6);
  thr_text_append(out, ", ");
  thr_text_append(out, "[");
  if (piece->foot) {
    put_number(out, piece->base / top->width, 1e6);
    thr_text_append(out, ", ");
    put_number(out, piece->pad / top->width, 1e6);
  }
  for (int i = 0; i < 3 && piece->hook_radius > 0; i++) {
    const double *at = piece->hook[i];
    const double point[3] = {at[0] / top->width, at[1] / top->width, at[2] / top->width};
    thr_text_append(out, ", ");
    put_vector(out, point, 3, 1e6);
  }
  if (piece->hook_radius > 0) {
    thr_text_append(out, ", ");
    put_number(out, piece->hook_radius / top->width, 1e6);
  }
  thr_text_append(out, "]],\n");
}

/* Appends where a piece belongs: a matrix of four columns. */
static void put_place(const thr_kit *kit, int p, thr_text *out)
{
  const thr_kit_piece *piece = &kit->piece[p];
  thr_text_append(out, "  [");
  thr_text_json_string(out, kit->name[p]);
  thr_text_append(out, ", ");
  thr_text_json_string(out, kit->kind_name[piece->kind]);
  for (int i = 0; i < 3; i++) {
    const double *turn = &piece->place[3 * i];
    const double row[4] = {turn[0], turn[1], turn[2], piece->centre[i]};
    thr_text_append(out, i ? ", " : ", [");
    put_vector(out, row, 4, 1e8);
  }
  thr_text_append(out, "]],\n");
}

/* Appends a size that may be changed, and what it is. */
static void put_size(thr_text *out, const char *name, double value, const char *what)
{
  thr_text_printf(out, "%s = ", name);
  put_number(out, value, 1e4);
  thr_text_printf(out, "; // %s\n", what);
}

void thr_kit_scad(const thr_kit *kit, thr_text *out)
{
  const thr_kit_piece *first = &kit->piece[0];
  const thr_kit_options *options = &kit->options;
  const top_sizes top = find_sizes(kit);
  double far = 1;
  for (int p = 0; p < kit->n_pieces; p++)
    for (int i = 0; i < kit->piece[p].n_arms; i++)
      far = fmax(far, 4 * (kit->piece[p].arm[i].length + top.width));

  thr_text_append(out, "// The pieces of a plan, made by thread. Lengths are in mm.\n\nshow = ");
  thr_text_json_string(out, kit->kind_name[first->kind]);
  thr_text_append(out, "; // a kind, or \"assembled\"\n");
  put_size(out, "width", top.width, "of arms and tubes; narrower ones keep their part of it");
  put_size(out, "bore", top.bore, "of the widest channel; narrower ones keep their part of it");
  put_size(out, "wall", top.wall, "at least, beside a channel: arms are made wider for it");
  thr_text_printf(out, "fillet = %s; // are corners between arms filled?\n",
                  options->fillet > 0 ? "true" : "false");
  put_size(out, "gap", options->gap, "between the faces of neighbours");
  put_size(out, "taper", options->taper,
           "width of arms at the node, as a part of that at the face");
  thr_text_printf(out, "profile = \"%s\"; // of arms: round, square or hex\n",
                  thr_kit_profile_name((int)options->profile));
  thr_text_append(out, "$fn = 32; // sides of circles: more are smoother and take longer\n\n");

  thr_text_printf(out, "rounded = %s; // tubes end in half balls\n",
                  first->rounded ? "true" : "false");
  put_size(out, "key_radius", first->key_radius, "of keys: radius at the face");
  put_size(out, "key_height", first->key_height, "how far they stand out");
  put_size(out, "key_slope", first->key_slope, "mm along the axis for each mm across");
  put_size(out, "key_play", first->key_play, "that the hollow ones have");
  put_size(out, "far", far, "farther than any piece reaches");
  thr_text_append(out, "\n");
  thr_text_append(out, programme_of_parts);
  thr_text_append(out, programme_of_pieces);

  thr_text_append(out, "kinds = [\n");
  for (int p = 0; p < kit->n_pieces; p++)
    if (kit->piece[p].like == p) put_kind(kit, &top, &kit->piece[p], out);
  thr_text_append(out, "];\n\n// Piece, kind, and where it belongs.\nplaces = [\n");
  for (int p = 0; p < kit->n_pieces; p++)
    put_place(kit, p, out);
  thr_text_append(out, "];\n");
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keeps what is known of cord and beads: friction, sizes, weights. One table of fields drives the
 * command line, the config file and plan.json, so that a quantity is named, bounded and explained
 * once; presets have values with their sources. Where a value is 0 = "work it out", it follows from
 * the framework (thr_physics_resolve).
 *
 * Example: with edges of 20 mm in the median, the cord gets 20 / 20 = 1 mm, the bore 2 mm, and a
 * bead's arm max(0.35 x 20, 1.5 x 2) = 7 mm. */
#include "graph/plan/physics.h"
#include "graph/arrays.h"
#include "graph/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The fields, in the order in which they are written. */
enum {
  MU,
  MU_LOW,
  MU_HIGH,
  MU_BEAD,
  MU_GROUND,
  CORD_DIAMETER,
  BORE,
  BEAD_DIAMETER,
  DENSITY,
  BEAD_MASS,
  SEATING,
  GRAVITY,
  WOBBLE,
  MU_POWER,
  MU_TENSION,
  STIFFNESS,
  BEAD_STRENGTH
};

/* A field's key and its place in thr_physics. */
#define FIELD(name) #name, offsetof(thr_physics, name)
/* Key, place, least and largest value, whether 0 is refused, whether 0 stays 0 (optional), unit,
 * help. */
const thr_physics_field thr_physics_fields[] = {
    [MU] = {FIELD(mu), 0, 2, false, false, "", "friction coefficient, cord on bead"},
    [MU_LOW] = {FIELD(mu_low), 0, 2, false, false, "",
                "lower end of the band of mu (0: half of mu)"},
    [MU_HIGH] = {FIELD(mu_high), 0, 3, false, false, "",
                 "upper end of the band of mu (0: one and a half mu)"},
    [MU_BEAD] = {FIELD(mu_bead), 0, 2, false, false, "", "friction coefficient, bead on bead"},
    [MU_GROUND] = {FIELD(mu_ground), 0, 2, false, false, "",
                   "friction coefficient, foot on ground"},
    [CORD_DIAMETER] = {FIELD(cord_diameter), 0, 1e9, false, false, "mm",
                       "thickness of the cord (0: 1/20 of the median edge within 1 to 3 mm, "
                       "thinner as edges under "
                       "9 mm take it, at most 1/4 of the shortest, rounded down to one that is "
                       "sold)"},
    [BORE] = {FIELD(bore), 0, 1e9, false, false, "mm",
              "inner diameter of the channels (0: twice the cord)"},
    [BEAD_DIAMETER] = {FIELD(bead_diameter), 0, 1e9, false, false, "mm",
                       "width of a bead's arm (0: 0.35 of the median edge, at least 1.5 bores)"},
    [DENSITY] = {FIELD(density), 0, 25, false, false, "g/cm3", "density of the beads' material"},
    [BEAD_MASS] = {FIELD(bead_mass), 0, 1e9, false, false, "g",
                   "mass of every bead (0: density x volume)"},
    [SEATING] = {FIELD(seating), 0, 1e9, true, false, "N",
                 "tension that must reach the slackest point of every cord"},
    [GRAVITY] = {FIELD(gravity), 0, 1000, false, false, "m/s2", "gravity"},
    [WOBBLE] = {FIELD(wobble), 0, 10, false, true, "rad/m",
                "turning on straight runs, in every metre of cord (0: none)"},
    [MU_POWER] = {FIELD(mu_power), 0, 1, false, true, "",
                  "friction grows with load^X, X below 1: mu falls with tension (0: it does not)"},
    [MU_TENSION] = {FIELD(mu_tension), 0, 1e9, false, true, "N",
                    "with --mu-power: the tension at which mu holds (0: the seating tension)"},
    [STIFFNESS] = {FIELD(stiffness), 0, 1e12, false, true, "N",
                   "stiffness EA of the cord (0: not known)"},
    [BEAD_STRENGTH] = {FIELD(bead_strength), 0, 1e6, false, true, "MPa",
                       "pressure that a bead's face bears (0: not known)"},
};
const int thr_physics_n_fields = (int)(sizeof thr_physics_fields / sizeof *thr_physics_fields);

/* What all presets have in common: 1 N of seating tension, and standard gravity in m/s2. */
#define COMMON .seating = 1, .gravity = 9.80665
const thr_physics_preset thr_physics_presets[] = {
    {"pla-cotton",
     "Printed PLA beads, cotton cord. Density 1.24 g/cm3: usual in makers' data sheets. mu: "
     "estimate, no "
     "measurement of cotton on PLA found; the band is wide (polyester yarn on its own package: "
     "0.23 to 0.48, "
     "Textile Research Journal 70, 2000). mu_bead, mu_ground: estimates.",
     {.preset = "pla-cotton",
      .mu = 0.25,
      .mu_low = 0.15,
      .mu_high = 0.45,
      .mu_bead = 0.3,
      .mu_ground = 0.3,
      .density = 1.24,
      COMMON}},
    {"pla-braid",
     "Printed PLA beads, braided polyethylene (fishing line). mu: 0.16 and 0.23, from what a "
     "12-strand UHMWPE rope keeps over "
     "one "
     "and two metal carabiners of 10 mm (60 % over 180 degrees, 48 % over both: tests of the "
     "Hownot2 workshop); none found on "
     "PLA, "
     "the band is wider. Density 1.24 g/cm3: usual in makers' data sheets. mu_bead, mu_ground: "
     "estimates.",
     {.preset = "pla-braid",
      .mu = 0.18,
      .mu_low = 0.1,
      .mu_high = 0.3,
      .mu_bead = 0.3,
      .mu_ground = 0.3,
      .density = 1.24,
      COMMON}},
    {"pla-monofilament",
     "Printed PLA beads, nylon monofilament. mu: estimate, no measurement on PLA found; thread "
     "friction depends on speed, angle, "
     "load "
     "and humidity (Zunic-Lojen and Gersak, Int. J. of Clothing Science and Technology 15, 2003), "
     "nylon takes up water: the band "
     "is "
     "wide. Density as above. mu_bead, mu_ground: estimates.",
     {.preset = "pla-monofilament",
      .mu = 0.25,
      .mu_low = 0.12,
      .mu_high = 0.4,
      .mu_bead = 0.3,
      .mu_ground = 0.3,
      .density = 1.24,
      COMMON}},
    {"pla-waxed",
     "Printed PLA beads, waxed polyester cord. mu: estimate; polyester yarn on its own package "
     "0.23 to 0.48 (Textile Research "
     "Journal "
     "70, 2000), wax lowers it (Zunic-Lojen and Gersak 2003), by how much on PLA is not known. "
     "Density as above. mu_bead, "
     "mu_ground: "
     "estimates.",
     {.preset = "pla-waxed",
      .mu = 0.2,
      .mu_low = 0.1,
      .mu_high = 0.35,
      .mu_bead = 0.3,
      .mu_ground = 0.3,
      .density = 1.24,
      COMMON}},
    {"pla-elastic",
     "Printed PLA beads, elastic cord with a woven sheath. mu: estimate, as of polyester yarn "
     "(0.23 to 0.48, Textile Research "
     "Journal "
     "70, 2000); the sheath opens as it is stretched: the band is wide. Density as above. mu_bead, "
     "mu_ground: estimates.",
     {.preset = "pla-elastic",
      .mu = 0.3,
      .mu_low = 0.15,
      .mu_high = 0.5,
      .mu_bead = 0.3,
      .mu_ground = 0.3,
      .density = 1.24,
      COMMON}},
    {"eps-nylon",
     "Expanded polystyrene blocks, nylon cord. Density 0.02 g/cm3: blocks of 0.015 to 0.035 are "
     "usual (Khan and "
     "Meguid, Int. J. of Geosynthetics and Ground Engineering 4, 2018). mu_bead 0.5: moulded or "
     "wire-cut EPS on "
     "EPS (technical note \"Friction\" of the EPS geofoam industry, undated). mu: estimate, no "
     "measurement found, "
     "the band is wide. mu_ground: estimate.",
     {.preset = "eps-nylon",
      .mu = 0.3,
      .mu_low = 0.15,
      .mu_high = 0.5,
      .mu_bead = 0.5,
      .mu_ground = 0.5,
      .density = 0.02,
      COMMON}},
    {"wood-paracord",
     "Pine beads, paracord 550. mu 0.28 to 0.31: one hobby measurement on a pine roller by the "
     "capstan formula "
     "(\"Measurement of the coefficient of friction for the capstan equation\", forum of the "
     "International Guild "
     "of Knot Tyers, 2021); the band is wider, an estimate for other woods. Diameter 4 mm: 5/32 "
     "inch, common for "
     "type III. mu_bead 0.24: Scots pine, end grain on end grain, static (0.12 along the grain: "
     "Aira and others, "
     "Materiales de Construccion 64, 2014). mu_ground, density: estimates.",
     {.preset = "wood-paracord",
      .mu = 0.3,
      .mu_low = 0.2,
      .mu_high = 0.4,
      .mu_bead = 0.24,
      .mu_ground = 0.3,
      .cord_diameter = 4,
      .density = 0.5,
      COMMON}},
};
const int thr_physics_n_presets = (int)(sizeof thr_physics_presets / sizeof *thr_physics_presets);

thr_physics thr_physics_default(void)
{
  return (thr_physics){.mu = 0.2, .mu_bead = 0.25, .mu_ground = 0.25, .density = 1.24, COMMON};
}

/* ---- by name ---- */

/* Returns whether a given key is the field's, with dashes or underscores. */
static bool same_key(const char *key, const char *given)
{
  for (; *key && *given; key++, given++)
    if (*key != *given && !(*key == '_' && *given == '-')) return false;
  return *key == *given;
}

const thr_physics_field *thr_physics_find(const char *key)
{
  for (int i = 0; i < thr_physics_n_fields; i++)
    if (same_key(thr_physics_fields[i].key, key)) return &thr_physics_fields[i];
  return NULL;
}

double thr_physics_get(const thr_physics *physics, const thr_physics_field *field)
{
  double value;
  memcpy(&value, (const char *)physics + field->offset, sizeof value);
  return value;
}

/* Returns the preset with this name, or NULL. */
static const thr_physics_preset *find_preset(const char *name)
{
  for (int i = 0; i < thr_physics_n_presets; i++)
    if (strcmp(thr_physics_presets[i].name, name) == 0) return &thr_physics_presets[i];
  return NULL;
}

/* Drops the band of mu that came with a preset, because that band is about the preset's cord and
 * bead, not about a mu that somebody measured. A band that was set stays. */
static void drop_preset_band(thr_physics *physics)
{
  const thr_physics_preset *from = find_preset(physics->preset);
  if (!from || physics->mu_low != from->physics.mu_low || physics->mu_high != from->physics.mu_high)
    return;
  physics->mu_low = physics->mu_high = 0;
}

/* Writes "expected 0 to 2", or "expected more than 0 N, up to 1e+09 N". */
static void describe_range(const thr_physics_field *field, char *text, size_t n)
{
  const char *space = *field->unit ? " " : "";
  if (field->positive)
    snprintf(text, n, "expected more than %g%s%s, up to %g%s%s", field->low, space, field->unit,
             field->high, space, field->unit);
  else
    snprintf(text, n, "expected %g to %g%s%s", field->low, field->high, space, field->unit);
}

/* Checks the range of a field, and sets the field. */
thr_status thr_physics_set(thr_physics *physics, const thr_physics_field *field, double value,
                           thr_err *err)
{
  /* NaN is out of range, too. */
  if (!(value >= field->low && value <= field->high) || (field->positive && !(value > 0))) {
    char range[96];
    describe_range(field, range, sizeof range);
    return thr_fail(err, THR_EINPUT, "%s: %g is out of range; %s", field->key, value, range);
  }

  if (field == &thr_physics_fields[MU] && value != physics->mu) drop_preset_band(physics);
  memcpy((char *)physics + field->offset, &value, sizeof value);
  return THR_OK;
}

/* Replaces all values by those of a preset. */
thr_status thr_physics_set_preset(thr_physics *physics, const char *name, thr_err *err)
{
  const thr_physics_preset *preset = find_preset(name);

  /* A preset replaces all fields. */
  if (preset) {
    *physics = preset->physics;
    return THR_OK;
  }

  /* The message lists the presets. */
  char known[160] = "";
  for (int i = 0; i < thr_physics_n_presets; i++) {
    size_t n = strlen(known);
    snprintf(known + n, sizeof known - n, "%s%s", i ? ", " : "", thr_physics_presets[i].name);
  }

  return thr_fail(err, THR_EINPUT, "preset: there is none called %.60s; expected one of %s", name,
                  known);
}

/* ---- JSON ---- */

/* Checks that an object has only fields, a preset and a note. */
static thr_status only_fields(const thr_json *object, thr_err *err)
{
  void *iter = NULL;
  const char *key;
  const thr_json *value;

  while (thr_json_next(object, &iter, &key, &value)) {
    bool text = strcmp(key, "preset") == 0 || strcmp(key, "note") == 0;
    const thr_physics_field *field = thr_physics_find(key);

    /* The command line's spelling is close enough for a hint. */
    if (!text && field && strcmp(field->key, key) != 0)
      return thr_fail(err, THR_EINPUT, "%.60s: no such quantity; did you mean %s?", key,
                      field->key);

    /* Anything else may be a misspelt field, which must not be passed over. */
    if (!text && !field)
      return thr_fail(
          err, THR_EINPUT,
          "%.60s: no such quantity; `thread eval --help` lists them (here with _ for -)", key);

    if (text && !thr_json_string(value)) return thr_fail(err, THR_EINPUT, "%s: not text", key);
  }

  return THR_OK;
}

/* Takes the values of an object: the preset first, then the fields in their order, so that mu drops
 * the preset's band before the band is set. */
static thr_status set_from_json(thr_physics *physics, const thr_json *object, thr_err *err)
{
  /* Nothing but an object can have fields. */
  if (thr_json_typeof(object) != THR_JSON_OBJECT)
    return thr_fail(err, THR_EINPUT, "not an object; expected {\"mu\": 0.2, ..}");

  thr_status st = only_fields(object, err);
  const char *preset = thr_json_string(thr_json_get(object, "preset"));
  if (!st && preset) st = thr_physics_set_preset(physics, preset, err);

  /* Fields that are missing keep their value. */
  for (int i = 0; i < thr_physics_n_fields && !st; i++) {
    const thr_physics_field *field = &thr_physics_fields[i];
    const thr_json *member = thr_json_get(object, field->key);
    double value;
    char range[96];
    if (!member) continue;
    describe_range(field, range, sizeof range);
    st = thr_json_number(member, &value)
             ? thr_physics_set(physics, field, value + 0.0, err) /* -0.0 is 0 */
             : thr_fail(err, THR_EINPUT, "%s: not a finite number; %s", field->key, range);
  }

  return st;
}

thr_status thr_physics_from_json(thr_physics *physics, const thr_json *object, const char *place,
                                 thr_err *err)
{
  /* On failure nothing has changed. */
  thr_physics read = *physics;
  thr_err found = {0};
  thr_status st = set_from_json(&read, object, &found);
  if (st) return thr_fail(err, st, "%s: %s", place, found.text);
  *physics = read;

  return THR_OK;
}

thr_status thr_physics_read(thr_physics *physics, const char *path, thr_err *err)
{
  thr_text text = {0};
  thr_json *doc = NULL;
  const char *name = strcmp(path, "-") == 0 ? "stdin" : path;
  thr_status st = thr_text_read(&text, path, err);

  /* Reading and parsing name the file in their messages. */
  if (!st) st = thr_json_parse(&doc, text.data, text.length, name, err);
  if (!st) st = thr_physics_from_json(physics, doc, name, err);
  thr_json_destroy(doc);
  thr_text_destroy(&text);

  return st;
}

/* Writes all fields in the order of the table. */
void thr_physics_write(const thr_physics *physics, thr_writer *writer, const char *key)
{
  thr_write_object(writer, key);
  if (*physics->preset) thr_write_string(writer, "preset", physics->preset);

  /* Fields that are optional are left out if they are not known. */
  for (int i = 0; i < thr_physics_n_fields; i++)
    if (!thr_physics_fields[i].optional || thr_physics_get(physics, &thr_physics_fields[i]) != 0)
      thr_write_number(writer, thr_physics_fields[i].key,
                       thr_physics_get(physics, &thr_physics_fields[i]));

  thr_write_close(writer);
}

/* ---- against a framework ---- */

/* An arm's usual width as a part of the median edge, and its least width in bores. */
static const double ARM_EDGES = 0.35, ARM_BORES = 1.5;
/* The least length of an edge, in cords. */
static const double EDGE_CORDS = 4;

thr_status thr_measure_edges(const thr_frame *frame, thr_edge_sizes *out, thr_err *err)
{
  double *length = thr_calloc((size_t)frame->n_edges, sizeof *length);
  double mm;

  if (!length) return thr_nomem(err);
  *out = (thr_edge_sizes){.shortest = INFINITY};
  out->in_mm = thr_units_in_mm(frame->units, &mm, NULL) == THR_OK;
  if (!out->in_mm) mm = 1;

  /* Distances of the nodes, whatever lengths the framework gives. */
  for (int e = 0; e < frame->n_edges; e++) {
    const double *a = frame->xyz[frame->edge[e][0]], *b = frame->xyz[frame->edge[e][1]];
    length[e] = mm * hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
    if (length[e] < out->shortest) out->shortest = length[e], out->shortest_edge = e;
  }

  /* Sorted only now that the shortest has been found, with its number. */
  thr_sort_doubles(length, (size_t)frame->n_edges);
  out->median = length[frame->n_edges / 2];
  free(length);

  /* Shorter or longer edges are a mistake in the units. */
  if (out->shortest >= 1e-6 && out->median <= 1e8) return THR_OK;

  return thr_fail(
      err, THR_EINPUT,
      "edges from %g mm, half of them over %g mm, are no beads' size; set the units with --units",
      out->shortest, out->median);
}

/* Rounds to nine decimals, so that half of 0.2 and one and a half times 0.2 are written as 0.1 and
 * 0.3. */
static double rounded(double mu)
{
  return nearbyint(mu * 1e9) / 1e9;
}

/* Returns the thickest cord that is sold and is no thicker than a limit > 0, both in mm: 1, 1.2,
 * 1.5, 2, 2.5 or 3 mm, and below 1 mm a tenth, a hundredth, .. of a row of round numbers, as fine
 * lines are sold: 0.8, 0.6, 0.5, 0.4, 0.3, 0.25, 0.2, 0.15, 0.12, 0.1, 0.08, .. */
static double round_to_sold(double limit)
{
  static const double sold[] = {80, 60, 50, 40, 30, 25, 20, 15, 12, 10};
  const int n = (int)(sizeof sold / sizeof *sold);

  /* Where a limit is a size itself, the rounding of coordinates must not make it the next one. */
  for (double per = 10;; per *= 10)
    for (int i = 0; i < n; i++)
      if (sold[i] / per <= limit * (1 + 1e-9)) return sold[i] / per;
}

double thr_usual_cord(const thr_edge_sizes *sizes)
{
  const double fits = ARM_EDGES * sizes->median / (ARM_BORES * THR_BORE_CORDS);
  const double cord = sizes->median / 20;

  /* In mm it is one that hands thread and pull, however large the beads are. */
  return sizes->in_mm
             ? round_to_sold(fmax(fmin(THR_CORD_THINNEST, fits), fmin(cord, THR_CORD_THICKEST)))
             : cord;
}

/* Fills in what is 0 = "work it out". */
static void fill_in(thr_physics *physics, const thr_edge_sizes *sizes)
{
  /* The band of mu, and the tension at which mu holds. */
  if (physics->mu_low == 0) physics->mu_low = fmin(physics->mu, rounded(physics->mu / 2));
  if (physics->mu_high == 0) physics->mu_high = fmax(physics->mu, rounded(1.5 * physics->mu));
  if (physics->mu_power > 0 && physics->mu_tension == 0) physics->mu_tension = physics->seating;

  /* From the inside outwards: cord, bore, bead. */
  if (physics->cord_diameter == 0) {
    const double most = sizes->shortest / EDGE_CORDS;
    physics->cord_diameter = fmin(thr_usual_cord(sizes), sizes->in_mm ? round_to_sold(most) : most);
  }
  if (physics->bore == 0) physics->bore = THR_BORE_CORDS * physics->cord_diameter;
  if (physics->bead_diameter == 0)
    physics->bead_diameter = fmax(ARM_EDGES * sizes->median, ARM_BORES * physics->bore);
}

/* Checks that cord, bore, bead and shortest edge fit into each other. */
static thr_status check_sizes(const thr_physics *physics, const thr_frame *frame,
                              const thr_edge_sizes *sizes, thr_err *err)
{
  if (!(physics->bore > physics->cord_diameter))
    return thr_fail(
        err, THR_EINPUT,
        "bore: a cord of %g mm does not fit into %g mm; raise --bore or lower --cord-diameter",
        physics->cord_diameter, physics->bore);

  /* Around the bore there must be a wall. */
  if (!(physics->bead_diameter > physics->bore))
    return thr_fail(
        err, THR_EINPUT,
        "bead_diameter: %g mm leaves no wall round a bore of %g mm; raise it or lower --bore",
        physics->bead_diameter, physics->bore);

  /* Beads of a shorter edge would have no length. */
  if (!(sizes->shortest > physics->bore)) {
    const int *end = frame->edge[sizes->shortest_edge];
    return thr_fail(err, THR_EINPUT,
                    "edge %d (nodes %.40s and %.40s) is %g mm long, shorter than the bore of %g "
                    "mm; set the framework's --units, "
                    "or lower --bore or --cord-diameter",
                    sizes->shortest_edge, frame->name[end[0]], frame->name[end[1]], sizes->shortest,
                    physics->bore);
  }

  return THR_OK;
}

/* Checks the range of every field, and that beads have some mass. */
static thr_status check_values(const thr_physics *physics, thr_err *err)
{
  thr_physics copy = *physics;

  /* thr_physics_set knows the ranges. */
  for (int i = 0; i < thr_physics_n_fields; i++) {
    thr_status st = thr_physics_set(&copy, &thr_physics_fields[i],
                                    thr_physics_get(physics, &thr_physics_fields[i]), err);
    if (st) return st;
  }

  /* Without mass nothing would fall. */
  if (physics->density == 0 && physics->bead_mass == 0)
    return thr_fail(err, THR_EINPUT, "density: beads without mass; set --density or --bead-mass");

  return THR_OK;
}

/* Checks the ranges, measures the edges in mm, fills in what is to be worked out, and checks that
 * the sizes fit. */
thr_status thr_physics_resolve(const thr_physics *physics, const thr_frame *frame, thr_physics *out,
                               thr_err *err)
{
  thr_physics resolved = *physics;
  thr_edge_sizes sizes;
  double mm;
  *out = (thr_physics){0};

  /* Sizes in mm need a unit that is known; without any, a unit counts as a mm. */
  thr_status st = check_values(physics, err);
  bool sized = physics->cord_diameter > 0 || physics->bore > 0 || physics->bead_diameter > 0;
  if (!st && sized) st = thr_units_in_mm(frame->units, &mm, err);
  if (!st) st = thr_measure_edges(frame, &sizes, err);
  if (st) return st;

  /* Fill in, and check that all fits. */
  fill_in(&resolved, &sizes);
  if ((st = check_sizes(&resolved, frame, &sizes, err))) return st;
  if (!(resolved.mu_low <= resolved.mu && resolved.mu <= resolved.mu_high))
    return thr_fail(err, THR_EINPUT,
                    "mu_low: the band %g to %g does not hold mu = %g; set --mu-low and --mu-high",
                    resolved.mu_low, resolved.mu_high, resolved.mu);
  *out = resolved;

  return THR_OK;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes kit.csv, what each printed piece measures and how it stands on the bed, and tubes.csv, the
 * cut list of tubes for a workshop that has a saw and no printer.
 *
 * A mitre is a plane that cuts a tube's end. Only those that leave a part of the end are listed:
 * others lie wholly outside the tube. Its cut angle is that between the plane and a square cut, as
 * on a mitre saw; its turn is by how much the tube is turned about its axis from the first mitre of
 * its first end, clockwise as seen from that end along the tube.
 *
 * Example, tubes.csv: "1-5,2a,2,41.231,55.579,14.431,4.13,1,2,59.51 59.51,0.00 107.92,..", a tube
 * whose first end meets two others at 61 degrees each.
 */
#include "kit/files.h"

#include "diagram/overview/overview_parts.h"
#include "diagram/tables/tables.h"
#include "graph/number.h"

#include <math.h>
#include <string.h>

/* Appends a field with a number of at most so many decimals; an empty one if it is not finite. */
static void put_number(thr_text *out, double value, int decimals)
{
  double scale = pow(10, decimals);
  if (isfinite(value)) thr_text_double(out, nearbyint(value * scale) / scale);
  thr_text_byte(out, ',');
}

static void put_int(thr_text *out, int value)
{
  thr_text_printf(out, "%d,", value);
}

/* Ends a row: a line feed in place of the last comma. */
static void end_row(thr_text *out)
{
  if (!out->failed) out->data[out->length - 1] = '\n';
}

void thr_kit_kinds(const thr_kit *kit, thr_text *out)
{
  const bool named = kit->options.names == THR_KIT_OF_PIECES;
  thr_text_printf(out, "%d kind%s", kit->n_shapes, kit->n_shapes == 1 ? "" : "s");
  if (kit->n_kinds > kit->n_shapes)
    thr_text_printf(out, " (%d with their %s%s)", kit->n_kinds,
                    kit->piece[0].tube ? "ends" : "channels", named ? " and names" : "");
}

/* ---- kit.csv ---- */

/* Appends what lies on the bed: "base", "face to B6", else the direction that looks down, as its
 * angle round the framework's vertical and its height above the level, in degrees. */
static void put_down(const thr_kit_plates *plates, const thr_guide *guide, int p, thr_text *out)
{
  const thr_kit *kit = plates->kit;
  const thr_kit_piece *piece = &kit->piece[p];
  const thr_kit_stand *stand = &plates->stand[piece->like];
  thr_text words = {0};
  double down[3];
  for (int k = 0; k < 3; k++)
    down[k] = thr_dot(&piece->place[3 * k], stand->down);

  /* The arm that is where that of the mesh comes to. */
  int arm = -1;
  for (int i = 0; i < piece->n_arms && stand->arm >= 0; i++) {
    double along[3];
    for (int k = 0; k < 3; k++)
      along[k] = thr_dot(&piece->place[3 * k], kit->piece[piece->like].arm[stand->arm].along);
    if (arm < 0 || thr_dot(along, piece->arm[i].along) > thr_dot(along, piece->arm[arm].along))
      arm = i;
  }
  if (stand->base)
    thr_text_append(&words, "base");
  else if (arm >= 0)
    thr_text_printf(&words, "face to %s",
                    guide->label[thr_head(&kit->plan->frame, piece->arm[arm].half)]);
  else
    thr_text_printf(&words, "%.0f %.0f", thr_degrees(atan2(down[1], down[0])) + 0.0,
                    thr_degrees(asin(fmax(-1, fmin(down[2], 1)))) + 0.0);
  if (words.failed) out->failed = true;
  thr_table_text(out, words.failed ? "" : words.data);
  thr_text_destroy(&words);
}

/* Appends the row of a piece. */
static void put_piece(const thr_kit_plates *plates, const thr_guide *guide, int p, thr_text *out)
{
  const thr_kit *kit = plates->kit;
  const thr_kit_piece *piece = &kit->piece[p];
  const thr_mesh_report *report = &kit->report[piece->like];
  const thr_kit_stand *stand = &plates->stand[piece->like];
  thr_table_text(out, kit->name[p]);
  thr_table_text(out, kit->kind_name[piece->kind]);
  put_int(out, kit->piece[piece->like].count);
  put_int(out, piece->n_arms);
  put_number(out, report->volume, 1);
  put_number(out, report->volume * kit->options.density / 1000, 3);

  /* Its size as it stands; what its channels leave, and how they bend. */
  double bend = INFINITY;
  for (int i = 0; i < piece->n_channels; i++)
    bend = fmin(bend, piece->channel[i].bend);
  for (int k = 0; k < 3; k++)
    put_number(out, stand->size[k], 2);
  put_number(out, piece->thinnest, 2);
  put_number(out, bend, 2);
  put_int(out, piece->cuts);
  put_int(out, piece->crossings);

  put_number(out, stand->overhang, 1);
  put_down(plates, guide, p, out);
  put_int(out, plates->plate[p] + 1);
  end_row(out);
}

thr_status thr_kit_table(const thr_kit_plates *plates, const thr_layout *layout, thr_text *out,
                         thr_err *err)
{
  const thr_kit *kit = plates->kit;
  thr_guide guide = {0};
  thr_status st = thr_guide_make(&guide, &kit->plan->frame, layout, err);
  thr_text text = {0};
  thr_text_append(&text,
                  "piece,kind,count,arms,volume_mm3,mass_g,x_mm,y_mm,z_mm,wall_mm,bend_mm,cuts,"
                  "crossings,overhang_mm2,down,plate\n");
  for (int p = 0; p < kit->n_pieces && !st; p++)
    put_piece(plates, &guide, p, &text);

  if (!st && text.failed) st = thr_nomem(err);
  if (!st) thr_text_append_bytes(out, text.data, text.length);
  thr_text_destroy(&text);
  thr_guide_destroy(&guide);
  return st;
}

/* ---- tubes.csv ---- */

/* How a tube is measured round its axis. */
typedef struct {
  double along[3];            /* the axis, from the first end */
  double zero[3], quarter[3]; /* directions of 0 and 90 degrees */
  double first;               /* degrees: of the first mitre, from which all others are measured */
  bool begun;
} axes;

/* Returns whether a mitre cuts a part of the tube's outline off that no other mitre cuts off. One
 * that an earlier one repeats does not. */
static bool cuts(const thr_kit_arm *arm, const axes *round, int number)
{
  enum { STEPS = 360 };
  double radius = 0.5 * arm->width;
  for (int step = 0; step < STEPS; step++) {
    double angle = 2 * THR_PI * step / STEPS, first = INFINITY, own = INFINITY;
    for (int i = 0; i < arm->n_mitres; i++) {
      const double *plane = arm->mitre[i];
      double off = radius * (cos(angle) * thr_dot(plane, round->zero) +
                             sin(angle) * thr_dot(plane, round->quarter));
      double at = (plane[3] - off) / thr_dot(plane, arm->along);
      if (i == number)
        own = at;
      else if (thr_distance(plane, arm->mitre[number]) > 1e-6)
        first = fmin(first, at);
      else if (i < number)
        return false;
    }
    if (own < first - 1e-4 * radius) return true;
  }
  return false;
}

/* Fills found with the mitres that cut an end, in the order of their turns in degrees. */
static int find_mitres(const thr_kit_arm *arm, const axes *round, thr_ranked *found)
{
  int n = 0;
  for (int i = 0; i < arm->n_mitres && n < THR_KIT_MOST_ARMS; i++) {
    if (!cuts(arm, round, i)) continue;
    const double *plane = arm->mitre[i];
    double angle = atan2(thr_dot(plane, round->quarter), thr_dot(plane, round->zero));
    double turn = fmod(thr_degrees(angle) - round->first + 720, 360);
    found[n++] = (thr_ranked){.key = turn > 359.995 ? 0 : turn, .index = i};
  }
  thr_sort_ranked(found, (size_t)n);
  return n;
}

/* Appends the mitres of a tube's end: how many, cut angles and turns. The first one of a tube is
 * that behind the widest angle without one, so that tubes of a kind have equal rows. */
static void put_end(const thr_kit_arm *arm, axes *round, bool rounded, thr_text *out)
{
  thr_ranked found[THR_KIT_MOST_ARMS];
  int n = rounded ? 0 : find_mitres(arm, round, found);
  if (n && !round->begun) {
    double widest = 0;
    for (int i = 0; i < n; i++) {
      double free_angle = found[i].key - (i ? found[i - 1].key : found[n - 1].key - 360);
      if (free_angle < widest + 1e-6) continue;
      widest = free_angle;
      round->first = found[i].key;
    }
    round->begun = true;
    n = find_mitres(arm, round, found);
  }

  thr_text angles = {0}, turns = {0};
  for (int i = 0; i < n; i++) {
    double cut = thr_angle_between(arm->mitre[found[i].index], arm->along);
    thr_text_printf(&angles, "%s%.2f", i ? " " : "", thr_degrees(cut));
    thr_text_printf(&turns, "%s%.2f", i ? " " : "", found[i].key);
  }
  put_int(out, n);
  thr_table_text(out, n && !angles.failed ? angles.data : "");
  thr_table_text(out, n && !turns.failed ? turns.data : "");
  if (angles.failed || turns.failed) out->failed = true;
  thr_text_destroy(&angles);
  thr_text_destroy(&turns);
}

/* Returns how long a tube is from point to point: what its mesh measures along the axis. */
static double long_points(const thr_mesh *mesh, const double along[3])
{
  double low = INFINITY, high = -INFINITY;
  for (int i = 0; i < mesh->n_points; i++) {
    double at = thr_dot(mesh->point[i], along);
    low = fmin(low, at);
    high = fmax(high, at);
  }
  return high - low;
}

/* Appends the row of a tube. Its first end is that at the edge's first node, by its second arm. */
static void put_tube(const thr_kit *kit, int p, thr_text *out)
{
  const thr_kit_piece *piece = &kit->piece[p], *like = &kit->piece[piece->like];
  axes round = {0};
  memcpy(round.along, piece->arm[0].along, sizeof round.along);
  memcpy(round.zero, piece->arm[0].up, sizeof round.zero);
  thr_cross(round.along, round.zero, round.quarter);

  thr_table_text(out, kit->name[p]);
  thr_table_text(out, kit->kind_name[piece->kind]);
  put_int(out, like->count);
  put_number(out, kit->edges.edge[p].length, 3);
  put_number(out, long_points(&kit->mesh[piece->like], like->arm[0].along), 3);
  put_number(out, piece->arm[0].width, 3);
  put_number(out, kit->edges.edge[p].bore, 3);
  put_int(out, piece->n_channels);
  for (int end = 1; end >= 0; end--)
    put_end(&piece->arm[end], &round, piece->rounded, out);
  end_row(out);
}

thr_status thr_kit_tubes_table(const thr_kit *kit, thr_text *out, thr_err *err)
{
  if (!kit->piece[0].tube)
    return thr_fail(err, THR_EINPUT, "tubes.csv: the plan's pieces are nodes, not tubes");
  thr_text text = {0};
  thr_text_append(&text,
                  "tube,kind,count,axis_mm,long_mm,outer_mm,inner_mm,channels,mitres_1,cuts_1,"
                  "turns_1,mitres_2,cuts_2,turns_2\n");
  for (int p = 0; p < kit->n_pieces; p++)
    put_tube(kit, p, &text);
  thr_status st = text.failed ? thr_nomem(err) : THR_OK;
  if (!st) thr_text_append_bytes(out, text.data, text.length);
  thr_text_destroy(&text);
  return st;
}

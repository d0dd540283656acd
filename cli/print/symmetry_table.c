/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints the table of symmetry groups, and how the cords of a symmetric plan are copies of each
 * other.
 *
 * A row is a subgroup of the framework's automorphisms (or, with --geometric, of its isometries) up
 * to conjugacy, with the best threading that the subgroup maps onto itself. Its cords fall into
 * orbits: one cord of each orbit is a unique path to be learned, the others are its copies. So a
 * threading of 12 cords in 3 orbits of 4 is "3 x 4".
 *
 * Example of a line about copies: "A: unique; B, C, D: copies of A by C4, C2, C4^3".
 *
 * What the solver proves of a row no checker verifies; JSON says so. */
#include "cli/print/print.h"
#include "graph/number.h"
#include "symmetry/group/group.h"
#include "symmetry/lift/lift.h"

#include <math.h>
#include <stdio.h>

/* ---- words ---- */

/* Appends how many elements of each kind a group has: "3 rotations, 4 mirrors"; of the trivial
 * group "identity". */
static void put_kinds(thr_text *text, const thr_symmetry_row *row)
{
  static const char *const word[][2] = {
      [THR_ISO_ROTATION] = {"rotation", "rotations"},
      [THR_ISO_MIRROR] = {"mirror", "mirrors"},
      [THR_ISO_INVERSION] = {"inversion", "inversions"},
      [THR_ISO_ROTOREFLECTION] = {"rotoreflection", "rotoreflections"},
      [THR_ISO_NONE] = {"of the graph only", "of the graph only"}};
  const char *comma = "";

  /* The identity is named only where there is nothing else. */
  if (row->order == 1) thr_text_append(text, "identity");

  for (int k = THR_ISO_IDENTITY + 1; k <= THR_ISO_NONE; k++) {
    if (row->kinds[k] == 0) continue;
    thr_text_printf(text, "%s%d %s", comma, row->kinds[k],
                    cli_plural(row->kinds[k], word[k][0], word[k][1]));
    comma = ", ";
  }
}

/* Appends the name of a point group (Schoenflies), "C4v", or what else to call a group that is no
 * group of isometries. */
static void put_name(thr_text *text, const thr_symmetry_row *row)
{
  if (*row->name)
    thr_text_append(text, row->name);
  else
    thr_text_printf(text, "order %d of the graph", row->order);
}

/* Formats unique paths and the copies of each, itself among them: "2 x 4", or "3 x 4-8" if some
 * have more than others. */
static void format_copies(const thr_symmetry_row *row, char out[40])
{
  int paths = row->record.unique_paths;
  if (row->least_copies == row->most_copies)
    snprintf(out, 40, "%d x %d", paths, row->most_copies);
  else
    snprintf(out, 40, "%d x %d-%d", paths, row->least_copies, row->most_copies);
}

/* Returns the first aim, in the order that was asked for, that may not be as low as can be: its
 * value is above its bound. "nothing" if the search has proved all. */
static const char *find_unproved_aim(const thr_request *options, const thr_symmetry_row *row)
{
  static const char *const no[] = {[THR_AIM_OVERLAP] = "overlap",
                                   [THR_AIM_STEPS] = "steps",
                                   [THR_AIM_PATHS] = "paths",
                                   [THR_AIM_TURNING] = "turning"};
  thr_aim order[THR_N_AIMS];

  if (row->why.code == THR_OK) return "nothing";
  thr_aims_order(options, order);

  /* A value counts as its bound within a millionth. If no other aim is open, the last one is. */
  for (int k = 0; k < THR_N_AIMS - 1; k++) {
    thr_aim aim = order[k];
    if (row->value[aim] > row->bound[aim] + 1e-6 * fmax(1, fabs(row->value[aim]))) return no[aim];
  }

  return no[order[THR_N_AIMS - 1]];
}

/* ---- text ---- */

void symmetry_put_head(thr_text *text, const thr_frame *frame, const thr_request *options,
                       const thr_symmetries *symmetries)
{
  bool shape = options->symmetry.geometric >= 0;
  double kept = shape ? symmetries->keep_lengths[0] : symmetries->mantissa;
  int exponent = shape ? (int)symmetries->keep_lengths[1] : symmetries->exponent;
  const char *ways = exponent == 0 && kept == 1 ? "way" : "ways";

  /* The group: isometries within a tolerance among the automorphisms that keep edge lengths, or all
   * automorphisms. */
  if (shape)
    thr_text_printf(text, "%.0f %s of the shape within %g, of ", symmetries->mantissa,
                    symmetries->mantissa == 1 ? "motion" : "motions", options->symmetry.geometric);
  thr_order_put(text, kept, exponent);
  thr_text_printf(text, " %s to map the framework onto itself%s", ways,
                  shape ? " with edges as long" : "");
  if (cli_verbose) thr_text_printf(text, " (automorphisms by nauty %s)", thr_nauty_version());

  /* Nodes and edges by orbits, and whether all subgroups are listed. */
  thr_text_printf(text, "; %d %s among %d nodes, %d among %d edges; %d %s of groups%s\n",
                  symmetries->node_orbits, cli_plural(symmetries->node_orbits, "kind", "kinds"),
                  frame->n_nodes, symmetries->edge_orbits, frame->n_edges, symmetries->n,
                  cli_plural(symmetries->n, "kind", "kinds"),
                  symmetries->listed ? "" : ", not all:");
  if (!symmetries->listed) thr_text_printf(text, "%s\n", symmetries->note);

  /* What the overlap of a threading is measured from: the passes that every edge needs. */
  double base = 0;
  for (int e = 0; e < frame->n_edges; e++)
    base += thr_plan_cover(frame, options, e) * frame->length[e];

  thr_text_printf(
      text, "ends: %s; %d %s per edge%s; the shortest plan with %s has %.1f %% overlap%s\n\n",
      thr_ends_name(options->ends), options->cover, cli_plural(options->cover, "pass", "passes"),
      options->joint == THR_JOINT_TUBE ? "; joints: tube" : "",
      thr_keep_asked(options) ? "cords as asked for" : "one cord in each component",
      100 * (symmetries->shortest - base) / base,
      symmetries->shortest_optimal ? "" : " (not proved)");
}

/* Returns whether the table says how far symmetries are from motions of the shape: to those who
 * ask. */
static bool shows_residual(const thr_request *options)
{
  return cli_verbose || options->symmetry.geometric >= 0;
}

/* Appends row i of the table. */
static void put_row(thr_text *text, const thr_request *options, const thr_symmetries *symmetries,
                    int i)
{
  const thr_symmetry_row *row = &symmetries->row[i];
  const thr_metrics *metrics = &row->metrics;
  char copies[40], force[24];

  thr_text_printf(text, "%c %4d\v4 %6d\v0  %-6s\v0 ", i == symmetries->chosen ? '*' : ' ', i + 1,
                  row->order, *row->name ? row->name : "graph");

  /* A threading, or why there is none. */
  if (row->n_cords > 0) {
    format_copies(row, copies);
    thr_text_printf(
        text, "%7.1f %%\v3 %14s\v0 %8.6g\v5 %5d\v0 %6d\v6 %8.0f deg\v2 %8.0f deg\v0 %12s\v1 %11s",
        100 * metrics->overlap / metrics->base_length, copies, row->record.steps, row->instructions,
        row->n_cords, thr_degrees(metrics->turning), thr_degrees(metrics->max_turning),
        thr_plain_newtons(thr_symmetry_row_pull(options, row), force),
        find_unproved_aim(options, row));
  } else {
    /* Not in time, or a failure; a row without a threading has none, or was not asked for. */
    bool open = row->why.code == THR_ELIMIT || row->why.code == THR_ESOLVER;
    thr_text_printf(text, "  %-95.95s\v3\v0\v5\v0\v6\v2\v0\v1",
                    open            ? row->why.text
                    : row->why.code ? "no threading"
                                    : "not asked for");
  }

  /* How far the elements are from isometries, and of which kinds they are. */
  if (shows_residual(options)) thr_text_printf(text, "\v9 %8.3f", row->residual);
  thr_text_append(text, PRINT_CELL "8  ");
  put_kinds(text, row);
  thr_text_append(text, "\n");
}

/* Appends why the chosen group was chosen. */
static void put_reason(thr_text *text, const thr_request *options, const thr_symmetries *symmetries)
{
  double percent = 100 * thr_symmetry_slack;
  const thr_symmetry_row *row = &symmetries->row[symmetries->chosen];

  /* Rows are counted from 1. */
  thr_text_printf(text, "* group %d, ", symmetries->chosen + 1);
  put_name(text, row);

  /* Asked for, the fewest steps within the slack on the length, or the least cord. */
  if (*options->symmetry.group)
    thr_text_printf(text, ": asked for as --group %s", options->symmetry.group);
  else if (symmetries->within)
    thr_text_printf(
        text, ": the fewest learned steps (%g) with at most %g %% more cord than the shortest plan",
        row->record.steps, percent);
  else
    thr_text_printf(text, ": the least cord; none has at most %g %% more than the shortest plan",
                    percent);
  thr_text_append(text, "\n");
}

/* Returns whether row i is in the table: not if another row is better whatever threading it may
 * have, and with --group only rows that were asked for. */
static bool is_shown(const thr_request *options, const thr_symmetries *symmetries, int i)
{
  const thr_symmetry_row *row = &symmetries->row[i];
  return !row->behind && (!*options->symmetry.group || row->n_cords > 0 || row->why.code);
}

/* Chooses rows first .. last - 1 of those that are shown: at most `most`, with the chosen one in
 * the middle if that is possible. */
static void choose_window(const thr_request *options, const thr_symmetries *symmetries, int most,
                          int *first, int *last)
{
  int n = 0, at = 0;

  /* n: rows that are shown; at: the place of the chosen one among them. */
  for (int i = 0; i < symmetries->n; i++) {
    if (i == symmetries->chosen) at = n;
    n += is_shown(options, symmetries, i);
  }

  *first = n <= most || at < most / 2 ? 0 : at - most / 2 > n - most ? n - most : at - most / 2;
  *last = n < *first + most ? n : *first + most;
}

/* Appends, for each threading that is not proved best, what the search says of the proof. */
static void put_whys(thr_text *text, const thr_request *options, const thr_symmetries *symmetries)
{
  for (int i = 0; i < symmetries->n; i++) {
    const thr_symmetry_row *row = &symmetries->row[i];
    if (is_shown(options, symmetries, i) && row->n_cords > 0 && row->why.code)
      thr_text_printf(text, "  group %d: %s\n", i + 1, row->why.text);
  }
}

void symmetry_put_table(thr_text *text, const thr_request *options,
                        const thr_symmetries *symmetries, int most)
{
  int first, last, behind = 0, at = 0;

  choose_window(options, symmetries, *options->symmetry.group ? symmetries->n : most, &first,
                &last);

  /* "read": instructions; "may be less": the first aim that is not proved. */
  thr_text_printf(text,
                  "%6s\v4 %6s\v0  %-6s\v0 %9s\v3 %14s\v0 %8s\v5 %5s\v0 %6s\v6 %12s\v2 %12s\v0 "
                  "%12s\v1 %11s",
                  "number", "order", "group", "overlap", "paths x copies", "steps", "read", "cords",
                  "turning", "largest", "pull, N", "may be less");
  if (shows_residual(options)) thr_text_printf(text, "\v9 %8s", "residual");
  thr_text_append(text, PRINT_CELL "8  elements\n");
  if (first > 0) thr_text_printf(text, "    ..  %d larger\n", first);

  /* Rows by descending order of their groups; those outside of the window are counted. */
  for (int i = 0; i < symmetries->n; i++) {
    behind += symmetries->row[i].behind > 0;
    if (!is_shown(options, symmetries, i)) continue;
    if (at >= first && at < last) put_row(text, options, symmetries, i);
    at++;
  }

  if (last < at) thr_text_printf(text, "    ..  %d smaller\n", at - last);
  if (cli_verbose) put_whys(text, options, symmetries);
  if (symmetries->chosen >= 0) put_reason(text, options, symmetries);

  /* Rows that cannot be better than another one. */
  if (behind > 0)
    thr_text_printf(text, "  %d other %s cannot be better; `thread symmetries` shows %s\n", behind,
                    cli_plural(behind, "group", "groups"), cli_plural(behind, "it", "them"));
}

/* ---- copies ---- */

/* Appends what the permutation number `image` of the plan's record is as an isometry: "C4^3". */
static void put_isometry(thr_text *text, const thr_plan *plan, int image)
{
  thr_isometry iso;
  thr_isometry_of(&plan->frame, &plan->symmetry.image[(size_t)image * (size_t)plan->frame.n_nodes],
                  thr_symmetry_near, &iso);
  thr_text_append(text, iso.name);
}

/* Appends the line of a unique path: its copies, and the elements that map it onto each of them. At
 * most 24 are named. */
static void put_copies_of(thr_text *text, const thr_plan *plan, int path)
{
  enum { MOST = 24 };
  const thr_symmetry_record *record = &plan->symmetry;
  int n = 0;

  thr_text_printf(text, "         %s: unique", plan->cord[path].id);

  /* The copies by name. */
  for (int i = 0; i < plan->n_cords; i++)
    if (i != path && record->unique[i] == path && n++ < MOST)
      thr_text_printf(text, n == 1 ? "; %s" : ", %s", plan->cord[i].id);

  if (n > MOST) thr_text_printf(text, " and %d more", n - MOST);
  if (n > 0)
    thr_text_printf(text, ": %s of %s by ", cli_plural(n, "copy", "copies"), plan->cord[path].id);

  /* The elements, in the same order. */
  n = 0;
  for (int i = 0; i < plan->n_cords; i++)
    if (i != path && record->unique[i] == path && n++ < MOST) {
      if (n > 1) thr_text_append(text, ", ");
      put_isometry(text, plan, record->element[i]);
    }
  thr_text_append(text, n > MOST ? ", ..\n" : "\n");
}

/* Appends how many instructions there are to be read: "to read: 16 instructions; beads straight on
 * are one, 7 paths are others moved along". */
static void put_reading(thr_text *text, const thr_plan *plan)
{
  const thr_reading reading = thr_reading_of(plan);

  /* A run of beads straight on is one instruction. */
  thr_text_printf(text, "         to read: %d %s; beads straight on are one", reading.instructions,
                  cli_plural(reading.instructions, "instruction", "instructions"));

  /* Paths that need fewer words than passes: they repeat themselves, are images of their own
   * beginning, or are other paths moved along. */
  if (reading.repeated > 0)
    thr_text_printf(text, ", %d %s the same again further on", reading.repeated,
                    cli_plural(reading.repeated, "path does", "paths do"));

  /* The rest of such a path is the beginning, turned or mirrored. */
  if (reading.mapped > 0)
    thr_text_printf(text, ", %d %s turned or mirrored", reading.mapped,
                    cli_plural(reading.mapped, "path goes on as its beginning",
                               "paths go on as their beginning"));

  /* Such a path is not read at all. */
  if (reading.moved > 0)
    thr_text_printf(text, ", %d %s moved along", reading.moved,
                    cli_plural(reading.moved, "path is another", "paths are others"));

  thr_text_append(text, "\n");
}

void symmetry_put_paths(thr_text *text, const thr_plan *plan)
{
  enum { MOST = 12 };
  const thr_symmetry_record *record = &plan->symmetry;
  int n = 0;

  thr_text_printf(text, "\npaths    %d unique, %g learned %s of %d passes", record->unique_paths,
                  record->steps, record->steps == 1 ? "step" : "steps", plan->metrics.passes);
  thr_text_printf(text, "; group %s%s of order %d\n", *record->name ? record->name : "of the graph",
                  *record->name ? "" : ",", record->order);

  /* A cord is a unique path if it is its own representative. */
  for (int i = 0; i < plan->n_cords; i++)
    if (record->unique[i] == i && n++ < MOST) put_copies_of(text, plan, i);
  if (n > MOST) thr_text_printf(text, "         .. and %d more unique paths\n", n - MOST);
  put_reading(text, plan);
}

/* ---- JSON ---- */

/* Writes the name of a group, or null if it has none. */
static void put_name_json(thr_writer *writer, const char *name)
{
  if (*name)
    thr_write_string(writer, "name", name);
  else
    thr_write_null(writer, "name");
}

void symmetry_put_json(thr_writer *writer, const thr_plan *plan)
{
  const thr_symmetry_record *record = &plan->symmetry;

  thr_write_object(writer, "group");
  thr_write_int(writer, "order", record->order);
  put_name_json(writer, record->name);
  thr_write_close(writer);

  /* What is to be learned and read. */
  thr_write_int(writer, "unique_paths", record->unique_paths);
  thr_write_number(writer, "steps", record->steps);
  const thr_reading reading = thr_reading_of(plan);
  thr_write_int(writer, "instructions", reading.instructions);
  thr_write_int(writer, "repeated_paths", reading.repeated);
  thr_write_int(writer, "mapped_paths", reading.mapped);
  thr_write_int(writer, "moved_paths", reading.moved);

  /* Each cord with its unique path, and the element that maps that onto it. */
  thr_write_array(writer, "copies");
  for (int i = 0; i < plan->n_cords; i++) {
    thr_text by = {0};
    put_isometry(&by, plan, record->element[i]);

    thr_write_object(writer, NULL);
    thr_write_string(writer, "cord", plan->cord[i].id);
    thr_write_string(writer, "of", plan->cord[record->unique[i]].id);
    thr_write_words(writer, "by", &by);
    thr_write_close(writer);
  }
  thr_write_close(writer);
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the tables steps.csv, cords.csv, beads.csv and channels.csv (docs/outputs.md).
 *
 * Every put_ function appends one field and a comma; put_unit replaces the comma behind a row's
 * last field by a line feed. A table is made in a text of its own, which goes to the caller's text
 * only if everything went well.
 *
 * Quoting follows RFC 4180. Text that a spreadsheet would take for a formula gets an apostrophe
 * before it, since names come from files that strangers may have written.
 *
 * Example, cords.csv: a row "A,no,A1,D7,86,1771,300,32.8,41.2,0,2145,5310,A,,mm". */
#include "diagram/tables/tables.h"

#include "diagram/overview/overview_parts.h"
#include "graph/number.h"
#include "graph/plan/plan_measures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What all tables are made from. Plan and frame are borrowed. */
typedef struct {
  const thr_plan *plan;
  const thr_frame *frame;
  thr_guide guide;       /* names of nodes, and of turns */
  thr_supplies supplies; /* lengths to cut, bores to make */
  thr_pieces pieces;     /* what is threaded: solid pieces at nodes, or tubes on edges */
  thr_copy *copy;        /* [n_cords] which cord repeats which; owned */
  thr_text *out;         /* the table's text, not yet the caller's */
} table_writer;

/* ---- fields ---- */

/* Returns whether a spreadsheet would take a text for a formula: it begins with =, +, - or @ and is
 * not just a number with a sign. */
static bool is_formula(const char *text)
{
  char *end;

  text += strspn(text, " ");
  if (!*text || !strchr("=+-@", *text)) return false;

  /* Only digits, signs, points and exponents up to the end make a number; "-inf" and "-0x1" do
   * not. */
  double value = strtod(text, &end);
  return text[strspn(text, "+-.0123456789eE")] || !isfinite(value) || *end;
}

void thr_table_text(thr_text *out, const char *text)
{
  thr_text word = {0};
  thr_text_append_clean(&word, text);
  const char *letter = word.data && !word.failed ? word.data : "";

  /* Quotes inside are doubled. */
  bool quoted = letter[strcspn(letter, ",\"")] != '\0';
  thr_text_append(out, quoted ? "\"" : "");

  if (is_formula(letter)) thr_text_append(out, "'");

  /* Byte by byte, so that UTF-8 passes through unchanged. */
  for (; *letter; letter++) {
    if (*letter == '"') thr_text_append(out, "\"");
    thr_text_append_bytes(out, letter, 1);
  }

  thr_text_append(out, quoted ? "\"," : ",");

  if (word.failed) out->failed = true;
  thr_text_destroy(&word);
}

/* Appends a field of text, such as a name from the framework's file. */
static void put_text(table_writer *table, const char *text)
{
  thr_table_text(table->out, text);
}

/* Appends a field of text that was made for it, and releases the text. */
static void put_words(table_writer *table, thr_text *words)
{
  if (words->failed) table->out->failed = true;

  put_text(table, words->data && !words->failed ? words->data : "");
  thr_text_destroy(words);
}

/* Appends a field with a whole number. */
static void put_int(table_writer *table, int i)
{
  thr_text_printf(table->out, "%d,", i);
}

/* Appends a field with a number of nine digits: exact enough to add up, without what rounding
 * leaves behind. */
static void put_number(table_writer *table, double value)
{
  thr_text_printf(table->out, "%.9g,", value);
}

/* Appends an angle, given in rad, in degrees with at most two decimals. */
static void put_angle(table_writer *table, double angle)
{
  put_number(table, nearbyint(angle * (180 / THR_PI) * 100) / 100);
}

/* Appends "yes" or "no". */
static void put_yes(table_writer *table, bool yes)
{
  put_text(table, yes ? "yes" : "no");
}

/* Appends the framework's unit, the last field of most rows, and ends the row. */
static void put_unit(table_writer *table)
{
  put_text(table, table->frame->units);
  if (!table->out->failed) table->out->data[table->out->length - 1] = '\n';
}

/* ---- what they share ---- */

/* Makes everything that tables are made from; `out` receives the rows. */
static thr_status table_make(table_writer *table, const thr_plan *plan, double tolerance,
                             const thr_layout *layout, thr_text *out, thr_err *err)
{
  *table = (table_writer){.plan = plan, .frame = &plan->frame, .out = out};
  thr_status st = thr_supplies_make(&table->supplies, plan, err);

  if (st) return st;

  /* Every table names the path that a cord repeats, or the kind of a piece. */
  table->copy = thr_calloc((size_t)plan->n_cords, sizeof *table->copy);
  if (!table->copy) return thr_nomem(err);
  st = thr_copies_find(plan, table->copy, err);
  if (!st) st = thr_pieces_make(&table->pieces, plan, tolerance, err);
  return st ? st : thr_guide_make(&table->guide, table->frame, layout, err);
}

/* Follows the needles through all cords: *part[*n_parts] and *visit[*n_visits], freed by the
 * caller. */
static thr_status follow(const table_writer *table, int needles, thr_part **part, int *n_parts,
                         thr_visit **visit, int *n_visits, thr_err *err)
{
  *part = thr_calloc(2 * (size_t)table->plan->n_cords, sizeof **part);
  if (!*part) return thr_nomem(err);
  *n_parts = thr_pieces_parts(table->plan, table->copy, needles, *part);
  return thr_pieces_follow(&table->pieces, *part, *n_parts, visit, n_visits, err);
}

/* Appends the table to out if all went well, and releases everything; returns the first failure. */
static thr_status table_close(table_writer *table, thr_status st, thr_text *out, thr_err *err)
{
  if (!st && !table->out->failed) thr_text_append_bytes(out, table->out->data, table->out->length);
  if (!st && (table->out->failed || out->failed)) st = thr_nomem(err);

  /* Nothing of the table is left but its text. */
  thr_text_destroy(table->out);
  thr_guide_destroy(&table->guide);
  thr_supplies_destroy(&table->supplies);
  thr_pieces_destroy(&table->pieces);
  free(table->copy);

  return st;
}

/* Returns the name of a node's place in the overview. */
static const char *place(const table_writer *table, int v)
{
  return table->guide.label[v];
}

/* Appends the name of a piece: the node's place, or "A1-A2" of a tube. */
static void put_name(table_writer *table, int piece)
{
  thr_text name = {0};
  thr_pieces_name(&table->pieces, (const char(*)[THR_LABEL])table->guide.label, piece, &name);

  put_words(table, &name);
}

/* Appends the kind of a piece, such as "X-10". */
static void put_kind(table_writer *table, int piece)
{
  char name[24];
  thr_pieces_kind_name(&table->pieces, table->pieces.kind[piece], name);
  put_text(table, name);
}

/* Appends what the arm of half-edge `half`, which leaves a piece, faces: the neighbouring piece;
 * with tubes the place at that end. An empty field if half is -1. */
static void put_arm(table_writer *table, int half)
{
  put_text(table, half < 0 ? ""
                           : place(table, table->pieces.solid ? thr_head(table->frame, half)
                                                              : thr_tail(table->frame, half)));
}

/* ---- steps.csv ---- */

/* Returns how a turn is called in steps.csv. */
static const char *way_name(thr_way way)
{
  static const char *const name[] = {"straight on",    "left", "right",
                                     "over the curve", "turn", "back"};
  return name[way];
}

/* Returns which step of the unique path pass k of cord c repeats, counted from 1. A copy begins at
 * pass `start` of its path and follows that path forwards or backwards, round the end of a closed
 * path. */
static int path_step(const table_writer *table, int c, int k)
{
  const thr_copy *how = &table->copy[c];
  int n = table->plan->cord[c].n_passes;

  if (how->of == c) return k + 1;
  return (how->backward ? how->start - k + n : how->start + k) % n + 1;
}

/* Returns the arm by which a visit comes in, as a half-edge that leaves the piece; -1 if there is
 * none. */
static int arm_in(const thr_visit *visit, bool solid)
{
  return visit->in < 0 ? -1 : solid ? visit->in ^ 1 : visit->in;
}

/* Returns the arm by which a visit goes out, in the same way. */
static int arm_out(const thr_visit *visit, bool solid)
{
  return visit->out < 0 ? -1 : solid ? visit->out : visit->out ^ 1;
}

/* A needle on its way through its part of a cord. */
typedef struct {
  bool left;     /* does it go back from the fold to the cord's start? */
  bool alone;    /* is it the cord's only needle? */
  double used;   /* length of the passes so far, in units */
  double length; /* of the whole part, in units */
} needle;

/* Returns the half-edge by which the needle came through the tube before the one of a visit, or -1
 * if there is none. left: the needle goes against the plan's direction. */
static int tube_before(const thr_cord *cord, const thr_visit *visit, bool left)
{
  /* The tube before is pass number + 1 of the plan, against its direction. */
  if (left) return visit->number < cord->n_passes ? cord->half[visit->number] ^ 1 : -1;

  /* Passes are numbered from 1, the array from 0. */
  return visit->number > 1 ? cord->half[visit->number - 2] : -1;
}

/* Appends how the cord turns and by how many degrees: inside a solid piece, or from the tube before
 * into this one; "start" or "end" where there is nothing to turn from or to. */
static void put_turn(table_writer *table, const thr_visit *visit, bool left)
{
  /* With tubes the turn is at the joint between two of them. */
  int in =
      table->pieces.solid ? visit->in : tube_before(&table->plan->cord[visit->cord], visit, left);
  int out = table->pieces.solid ? visit->out : visit->in;

  if (in >= 0 && out >= 0) {
    put_text(table, way_name(thr_guide_way(&table->guide, in, out)));
    put_angle(table, thr_turn_angle(table->frame, in, out));
  } else
    thr_text_printf(table->out, "%s,,", in < 0 ? "start" : "end");
}

/* Appends the row of a visit to steps.csv and moves the needle on. */
static void put_step(table_writer *table, const thr_visit *visit, needle *now)
{
  const thr_cord *cord = &table->plan->cord[visit->cord];
  bool solid = table->pieces.solid;

  /* A visit that starts a cord has no pass behind it. */
  double pass = visit->number ? table->frame->length[visit->in >> 1] : 0;
  now->used += pass;

  /* Which piece, and whether it is picked up or passed. */
  put_text(table, cord->id);
  put_int(table, visit->number);
  put_name(table, visit->piece);
  put_kind(table, visit->piece);
  put_text(table, visit->nth == 1 ? "pick up" : visit->back ? "back through" : "through");
  put_int(table, visit->nth);

  /* By which arms, and how the cord turns between them. */
  put_arm(table, arm_in(visit, solid));
  put_arm(table, arm_out(visit, solid));
  put_turn(table, visit, now->left);

  /* Cord of this pass, used so far and left; exactly 0 at the end rather than what rounding
   * leaves. */
  put_number(table, pass);
  put_number(table, now->used);
  put_number(table,
             visit->number == (now->left ? 1 : cord->n_passes) ? 0 : now->length - now->used);

  /* Which step of which unique path this one repeats. */
  put_text(table, table->plan->cord[table->copy[visit->cord].of].id);
  put_int(table, visit->number ? path_step(table, visit->cord, visit->number - 1) : 0);

  /* Numbers of edge and nodes, for programs; empty where the cord starts. */
  if (visit->number)
    put_int(table, visit->in >> 1);
  else
    put_text(table, "");

  if (visit->number)
    put_int(table, thr_tail(table->frame, visit->in));
  else
    put_text(table, "");

  put_int(table,
          visit->number ? thr_head(table->frame, visit->in) : thr_tail(table->frame, visit->out));
  put_text(table, now->alone ? "" : now->left ? "left" : "right");

  put_unit(table);
}

/* Appends the rows of one needle's part of a cord. Returns how many rows. */
static int put_part(table_writer *table, const thr_part *part, const thr_visit *visit)
{
  const thr_cord *cord = &table->plan->cord[part->cord];
  const int n = part->end - part->first + (part->begins && table->pieces.solid);

  needle now = {.left = part->backward, .alone = part->end - part->first == cord->n_passes};

  /* The part's length says how much cord is left at every row. */
  for (int k = part->first; k < part->end; k++)
    now.length += table->frame->length[cord->half[k] >> 1];

  /* With solid joints a part that begins a cord has a visit for the start. */
  for (int i = 0; i < n; i++)
    put_step(table, &visit[i], &now);
  return n;
}

thr_status thr_table_steps(const thr_plan *plan, double tolerance, int needles,
                           const thr_layout *layout, thr_text *out, thr_err *err)
{
  table_writer table;
  thr_text text = {0};
  thr_status st = table_make(&table, plan, tolerance, layout, &text, err);

  thr_part *part = NULL;
  thr_visit *visit = NULL;
  int n = 0, parts = 0;

  /* Visits come in the order of threading, part by part. */
  if (!st) st = follow(&table, needles, &part, &parts, &visit, &n, err);

  /* A failed table is thrown away, so the heading may always be written. */
  thr_text_append(&text, "cord,step,piece,kind,how,visit,in,out,turn,degrees,length,used,left,path,"
                         "path_step,edge,from_node,to_node,"
                         "needle,unit\n");

  /* put_part says how many visits each part has. */
  for (int k = 0, i = 0; k < parts && !st; k++)
    i += put_part(&table, &part[k], visit + i);

  free(part);
  free(visit);
  return table_close(&table, st, out, err);
}

/* ---- cords.csv ---- */

/* Appends the row of cord c to cords.csv. */
static void put_cord(table_writer *table, int c, const char *const *motion)
{
  const thr_cord *cord = &table->plan->cord[c];
  thr_cut_length cut = thr_supplies_cut(&table->supplies, c);
  char words[192];

  /* Where the cord goes. */
  put_text(table, cord->id);
  put_yes(table, cord->closed);
  put_text(table, place(table, thr_cord_start(table->frame, cord)));
  put_text(table, place(table, thr_cord_end(table->frame, cord)));
  put_int(table, cord->n_passes);

  /* How much of it to cut; allowances need a cord's size in mm. */
  put_number(table, cut.length);
  if (table->supplies.mm > 0) {
    put_number(table, cut.tails);
    put_number(table, cut.knots);
    put_number(table, cut.turns);
    put_number(table, cut.joins);
    put_number(table, cut.cut);
  } else
    thr_text_append(table->out, ",,,,,");

  /* How much it turns, and which path it repeats by which motion. */
  put_angle(table,
            thr_cord_turning(table->frame, cord, table->plan->options.ends == THR_ENDS_CLOSED));
  put_text(table, table->plan->cord[table->copy[c].of].id);
  thr_copies_words(table->plan, table->copy, c, table->copy[c].of == c ? NULL : motion, words);

  put_text(table, words[0] ? words + strlen(", ") : words);
  put_unit(table);
}

thr_status thr_table_cords(const thr_plan *plan, const char *const *motion, int needles,
                           double working_mm, const thr_layout *layout, thr_text *out, thr_err *err)
{
  table_writer table;
  thr_text text = {0};
  thr_part *part = NULL;
  thr_visit *visit = NULL;
  int parts = 0, visits = 0;

  /* Without sizes the columns of allowances stay empty. */
  thr_status st = table_make(&table, plan, 0, layout, &text, err);
  if (!st) st = thr_supplies_find_sizes(&table.supplies, err);
  if (!st) st = follow(&table, needles, &part, &parts, &visit, &visits, err);
  if (!st)
    st = thr_supplies_join(&table.supplies, table.pieces.solid, part, parts, visit, visits,
                           working_mm, err);

  thr_text_append(&text, "cord,closed,start,end,passes,length,tails,knots,turns,joins,cut,turning_"
                         "degrees,path,repeated,unit\n");
  for (int c = 0; c < plan->n_cords && !st; c++)
    put_cord(&table, c, motion);

  free(part);
  free(visit);

  return table_close(&table, st, out, err);
}

/* ---- beads.csv ---- */

/* Appends the width of a bore in cord diameters, and in mm where sizes are known. */
static void put_bore(table_writer *table, double cords)
{
  put_number(table, cords);

  if (table->supplies.mm > 0)
    put_number(table, thr_supplies_bore_mm(&table->supplies, cords));
  else
    thr_text_append(table->out, ",");
}

/* Appends two fields: what the arms of a piece face, and how many cords are in each, in the order
 * of thr_guide_around; of a tube its two places and the cords in it. */
static void put_arms(table_writer *table, int piece, const int *around)
{
  thr_text faces = {0}, cords = {0};

  /* A tube has two ends and the same cords at both. */
  if (!table->pieces.solid) {
    thr_text_printf(&faces, "%s %s", place(table, table->frame->edge[piece][0]),
                    place(table, table->frame->edge[piece][1]));
    thr_text_printf(&cords, "%d", table->supplies.passes[piece]);
  } else

    /* Both lists have the same order, so that the n-th number belongs to the n-th name. */
    for (int i = table->frame->first[piece]; i < table->frame->first[piece + 1]; i++) {
      const char *blank = i > table->frame->first[piece] ? " " : "";
      thr_text_printf(&faces, "%s%s", blank, place(table, thr_head(table->frame, around[i])));
      thr_text_printf(&cords, "%s%d", blank, table->supplies.passes[around[i] >> 1]);
    }

  put_words(table, &faces);
  put_words(table, &cords);
}

/* Returns the length of a piece's arms together, in units: an arm of a solid piece is half an
 * edge. */
static double length_of(const table_writer *table, int piece)
{
  double length = 0;
  if (!table->pieces.solid) return table->frame->length[piece];

  for (int i = table->frame->first[piece]; i < table->frame->first[piece + 1]; i++)
    length += table->frame->length[table->frame->half[i] >> 1] / 2;
  return length;
}

/* Returns whether a piece stands on the ground: a tube does if one of its ends does. */
static bool is_foot(const table_writer *table, int piece)
{
  const bool *foot = table->frame->foot;
  return table->pieces.solid
             ? foot[piece]
             : foot[table->frame->edge[piece][0]] || foot[table->frame->edge[piece][1]];
}

/* Appends the row of a piece to beads.csv. visits[n_nodes]: how often cords come to each node. */
static void put_piece(table_writer *table, int piece, const int *around, const int *visits)
{
  bool solid = table->pieces.solid;

  /* Which piece, and its shape. */
  put_name(table, piece);
  put_kind(table, piece);
  put_int(table, piece);
  put_int(table, thr_pieces_arms(&table->pieces, piece));

  /* Its neighbours, and its size. */
  put_arms(table, piece, around);
  put_number(table, length_of(table, piece));

  /* How often cords come to the piece, and how wide a bore they need. */
  put_int(table, solid ? visits[piece] : table->supplies.passes[piece]);
  put_bore(table, solid ? thr_supplies_node_bore(&table->supplies, piece)
                        : thr_supplies_bore(&table->supplies, piece));

  put_yes(table, is_foot(table, piece));
  put_unit(table);
}

thr_status thr_table_beads(const thr_plan *plan, double tolerance, const thr_layout *layout,
                           thr_text *out, thr_err *err)
{
  table_writer table;
  thr_text text = {0};

  /* Bores in mm need sizes. */
  thr_status st = table_make(&table, plan, tolerance, layout, &text, err);
  if (!st) st = thr_supplies_find_sizes(&table.supplies, err);

  /* Visits of all nodes, and the half-edges around each in clockwise order. */
  int *visits = st ? NULL : thr_calloc((size_t)plan->frame.n_nodes, sizeof *visits);
  int *around = st ? NULL : thr_calloc(2 * (size_t)plan->frame.n_edges, sizeof *around);
  if (!st && (!visits || !around)) st = thr_nomem(err);

  if (!st) st = thr_guide_around(&table.guide, around, err);
  if (!st) thr_supplies_visits(plan, visits);

  thr_text_append(
      &text, "piece,kind,number,arms,faces,cords,length,visits,bore_cords,bore_mm,foot,unit\n");

  for (int i = 0; i < table.pieces.n && !st; i++)
    put_piece(&table, i, around, visits);

  free(visits);
  free(around);
  return table_close(&table, st, out, err);
}

/* ---- channels.csv ---- */

/* Appends the row of a channel to channels.csv: which cord goes from which arm to which, how many
 * cords share these arms, how many channels cross this one. */
static void put_channel(table_writer *table, const thr_channel *channel, int piece)
{
  const int *passes = table->supplies.passes;
  put_name(table, piece);
  put_kind(table, piece);

  /* Whose channel, and between which arms. */
  put_text(table, table->plan->cord[channel->cord].id);
  put_int(table, channel->pass + 1);
  put_arm(table, channel->in);
  put_arm(table, channel->out);

  /* A cord that starts or ends here has an arm on one side only. */
  put_int(table, channel->in < 0 ? 0 : passes[channel->in >> 1]);
  put_int(table, channel->out < 0 ? 0 : passes[channel->out >> 1]);

  put_int(table, channel->crosses);
  put_angle(table, channel->in < 0 || channel->out < 0 || !table->pieces.solid
                       ? 0
                       : thr_turn_angle(table->frame, channel->in ^ 1, channel->out));

  /* There is no unit in this table: the row ends here. */
  if (!table->out->failed) table->out->data[table->out->length - 1] = '\n';
}

/* Appends a row for each pass through a tube: a tube has one channel, from end to end. */
static void put_tube_channels(table_writer *table)
{
  for (int c = 0; c < table->plan->n_cords; c++)
    for (int k = 0; k < table->plan->cord[c].n_passes; k++) {
      int h = table->plan->cord[c].half[k];
      put_channel(table, &(thr_channel){.cord = c, .pass = k, .in = h, .out = h ^ 1}, h >> 1);
    }
}

thr_status thr_table_channels(const thr_plan *plan, double tolerance, const thr_layout *layout,
                              thr_text *out, thr_err *err)
{
  table_writer table;
  thr_text text = {0};
  thr_channels channels = {0};

  /* Crossings are known with solid joints only. */
  thr_status st = table_make(&table, plan, tolerance, layout, &text, err);
  if (!st) st = thr_channels_make(&channels, plan, err);

  thr_text_append(&text, "piece,kind,cord,step,in,out,cords_in,cords_out,crosses,degrees\n");

  /* With solid joints node by node; with tubes cord by cord. */
  for (int v = 0; v < plan->frame.n_nodes && !st && table.pieces.solid; v++)
    for (int i = channels.first[v]; i < channels.first[v + 1]; i++)
      put_channel(&table, &channels.channel[i], v);

  if (!st && !table.pieces.solid) put_tube_channels(&table);

  thr_channels_destroy(&channels);
  return table_close(&table, st, out, err);
}

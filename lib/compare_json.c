/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes a comparison of plans as JSON, for `thread compare --json` and libthread.
 *
 * Example: {"plans": [{"plan": "a.json", "cords": 4, "largest_pull": 6.4, ..}, ..], "rankings":
 * [..], "agree": true, "take": "a.json", "why": "3.5 N a cord instead of 6.4 N"}. */
#include "graph/framework/frame.h"
#include "graph/plan/physics.h"
#include "graph/plan/request.h"
#include "lib/comparison.h"

thr_status thr_compare_framework(const thr_compare_entry *entry, const thr_compare_entry *first,
                                 thr_err *err)
{
  /* The hash of the entry's framework as if it had the first one's feet. */
  thr_frame frame = entry->plan.frame;
  const bool as_many = frame.n_nodes == first->plan.frame.n_nodes;
  if (as_many) frame.foot = first->plan.frame.foot;
  frame.hash = 0;
  if (as_many && thr_frame_hash(&frame) == thr_frame_hash(&first->plan.frame)) return THR_OK;
  return thr_fail(
      err, THR_EINPUT,
      "%s is for another framework than %s: pulls can be compared on one framework only",
      entry->path, first->path);
}

bool thr_compare_same_physics(const thr_compare_entry *one, const thr_compare_entry *other)
{
  const thr_physics *a = &one->eval[THR_CAPSTAN].record.physics,
                    *b = &other->eval[THR_CAPSTAN].record.physics;
  for (int i = 0; i < thr_physics_n_fields; i++)
    if (thr_physics_get(a, &thr_physics_fields[i]) != thr_physics_get(b, &thr_physics_fields[i]))
      return false;
  return true;
}

/* Writes an object for plan i: what it is, its values, its band of pulls, and the rows in which it
 * is the best. */
static void put_plan_json(thr_writer *writer, int method, const thr_compare_entry *entries, int n,
                          int i)
{
  thr_write_line(writer, 1);
  thr_write_object(writer, NULL);
  thr_write_string(writer, "plan", entries[i].path);
  thr_write_hash(writer, "framework", thr_frame_hash(&entries[i].plan.frame));
  thr_write_string(writer, "objective",
                   thr_objective_name(thr_aims_objective(&entries[i].plan.options)));
  thr_write_string(writer, "ends", thr_ends_name(entries[i].plan.options.ends));
  thr_physics_write(&entries[i].eval[THR_CAPSTAN].record.physics, writer, "physics");

  /* Members that are NAN are written as null. */
  for (int k = 0; k < THR_COMPARE_ROWS; k++)
    if (thr_compare_wants(method, thr_compare_rows[k].method))
      thr_write_number(writer, thr_compare_rows[k].key, entries[i].value[k]);
  thr_write_bool(writer, "frontier", thr_compare_on_frontier(entries, n, i));
  thr_write_number(writer, "pull_low", entries[i].eval[THR_CAPSTAN].band[0]);
  thr_write_number(writer, "pull_high", entries[i].eval[THR_CAPSTAN].band[1]);

  if (entries[i].rise.jams > 0) {
    thr_write_array(writer, "rise_jams_between");
    for (int side = 0; side < 2; side++)
      thr_write_string(writer, NULL, entries[i].rise.jam[side]);
    thr_write_close(writer);
  }

  thr_write_array(writer, "best");
  for (int k = 0; k < THR_COMPARE_ROWS; k++)
    if (thr_compare_is_best(entries, n, k, i))
      thr_write_string(writer, NULL, thr_compare_rows[k].key);
  thr_write_close(writer);
  thr_write_close(writer);
}

void thr_compare_put_json(thr_writer *writer, int method, const thr_compare_entry *entries, int n,
                          const thr_ranking *rankings, int count, const char *const *name)
{
  thr_write_array(writer, "plans");
  for (int i = 0; i < n; i++)
    put_plan_json(writer, method, entries, n, i);

  thr_write_line(writer, 0);
  thr_write_close(writer);
  thr_write_line(writer, 0);

  thr_write_array(writer, "rankings");
  for (int k = 0; k < count; k++) {
    thr_write_line(writer, 1);
    thr_ranking_put_json(&rankings[k], name, writer);
  }

  thr_write_line(writer, 0);
  thr_write_close(writer);
  thr_write_line(writer, 0);

  /* Ties do not contradict each other. */
  thr_write_bool(writer, "agree", thr_compare_agree(rankings, count));
  if (n < 2) return;

  thr_text why = {0};
  thr_compare_put_why(entries, n, method, &why);
  thr_write_string(writer, "take", name[thr_compare_take(entries, n, method, -1)]);
  thr_write_string(writer, "why", why.failed ? "" : why.data);
  writer->out->failed |= why.failed;
  thr_text_destroy(&why);
}
